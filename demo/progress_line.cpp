#include "progress_line.h"

#include <unistd.h>

#include <cmath>
#include <cstdio>

#include "speak.h"

namespace spanray::demo {

ProgressLine::ProgressLine(std::string what)
    : what_(std::move(what)), terminal_(::isatty(STDERR_FILENO) == 1), start_(Clock::now()), shown_(start_) {}

void ProgressLine::show(const std::string& part, double fraction) {
  const Clock::time_point now = Clock::now();
  if (part != part_) part_ = part, start_ = now;
  if (now - shown_ < std::chrono::milliseconds(terminal_ ? 200 : 10000) || !(fraction > 0)) return;
  shown_ = now;
  const double passed = std::chrono::duration<double>(now - start_).count();
  const std::string text = what_ + (part.empty() ? "" : ", " + part) + ": " + std::to_string(static_cast<int>(100 * fraction)) + " %, " +
                           std::to_string(static_cast<long>(std::ceil(passed * (1 - fraction) / fraction))) + " s left";
  if (terminal_) std::fprintf(stderr, "\r%-60s", text.c_str());
  else message(text);
}

void ProgressLine::clear() {
  if (terminal_) std::fprintf(stderr, "\r%60s\r", "");
}

}  // namespace spanray::demo
