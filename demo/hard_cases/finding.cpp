#include <cstdio>

#include "hard_case.h"

namespace spanray::hard {
namespace {

std::string too_few(uint64_t checked, uint64_t least) {
  return checked >= least ? "" : "; too few to show anything, " + grouped(least) + " were expected";
}
std::string tail(const std::string& note) { return note.empty() ? "" : "; " + note; }

}  // namespace

std::string grouped(uint64_t n) {
  std::string text = std::to_string(n);
  for (size_t at = text.size(); at > 3;) text.insert(at -= 3, ",");
  return text;
}

std::string short_text(double v) {
  char text[40];
  std::snprintf(text, sizeof text, "%.3g", v);
  return text;
}

Finding none_wrong(const Tally& tally, const std::string& what, uint64_t least, const std::string& note) {
  Finding f;
  f.verdict = tally.wrong() == 0 && tally.checked() >= least ? Verdict::kPass : Verdict::kFail;
  f.measured = static_cast<double>(tally.wrong()), f.unit = what, f.checked = tally.checked();
  f.text = grouped(tally.wrong()) + " wrong of " + grouped(tally.checked()) + " " + what;
  if (!tally.first().empty()) f.text += ", first: " + tally.first();
  f.text += too_few(tally.checked(), least) + tail(note);
  return f;
}

Finding within(const Worst& worst, double bound, const std::string& unit, const std::string& what, uint64_t least,
               const std::string& note) {
  Finding f;
  f.verdict = worst.value() <= bound && worst.checked() >= least ? Verdict::kPass : Verdict::kFail;
  f.measured = worst.value(), f.bound = bound, f.unit = unit, f.checked = worst.checked();
  f.text = "at most " + short_text(worst.value()) + " " + unit + " in " + grouped(worst.checked()) + " " + what +
           too_few(worst.checked(), least) + tail(note);
  return f;
}

Finding not_measured(const std::string& why) {
  Finding f;
  f.text = why;
  return f;
}

}  // namespace spanray::hard
