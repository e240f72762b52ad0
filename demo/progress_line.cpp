#include "progress_line.h"

#include <unistd.h>

#include <cmath>
#include <cstdio>

#include "speak.h"

namespace spanray::demo {

ProgressLine::ProgressLine(std::string what)
    : what_(std::move(what)), terminal_(::isatty(STDERR_FILENO) == 1), start_(Clock::now()), shown_(start_) {}

bool ProgressLine::due(const std::string& part, Clock::time_point now) {
  if (part != part_) part_ = part, start_ = now;
  if (now - shown_ < std::chrono::milliseconds(terminal_ ? 200 : 10000)) return false;
  shown_ = now;
  return true;
}

void ProgressLine::put(const std::string& text) const {
  const std::string line = what_ + (part_.empty() ? "" : ", " + part_) + ": " + text;
  if (terminal_) std::fprintf(stderr, "\r%-60s", line.c_str());
  else message(line);
}

void ProgressLine::show(const std::string& part, double fraction) {
  const Clock::time_point now = Clock::now();
  if (!(fraction > 0) || !due(part, now)) return;
  const double passed = std::chrono::duration<double>(now - start_).count();
  const long left = static_cast<long>(std::ceil(passed * (1 - fraction) / fraction));
  put(std::to_string(static_cast<int>(100 * fraction)) + " %, " + std::to_string(left) + " s left");
}

void ProgressLine::say(const std::string& part, const std::string& how_far) {
  if (due(part, Clock::now())) put(how_far);
}

void ProgressLine::clear() {
  if (terminal_) std::fprintf(stderr, "\r%60s\r", "");
}

}  // namespace spanray::demo
