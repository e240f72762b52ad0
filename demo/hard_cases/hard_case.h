// The hard cases of rendering, each measured when it is asked for and never stored: `spanray report --hard-cases` prints them, and
// tests/hard_cases_test.cpp asserts them, one test a row.
#pragma once
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "support/test_frame.h"

namespace spanray::hard {

enum class Verdict { kPass, kFail, kNotMeasured };

// How much to measure: the counts of the table, or fewer for a first look and for the test suite.
struct Effort {
  bool quick = false;
  int count(int full, int few) const { return quick ? few : full; }
  // The full count on the widest instruction set of this machine, a tenth of it on the others.
  int count(Isa isa, int full, int few) const { return count(full, few) / (isa == supported_isas().back() ? 1 : 10); }
};

struct Finding {
  Verdict verdict = Verdict::kNotMeasured;
  double measured = 0, bound = 0;  // in `unit`; only where something was measured
  std::string unit;                // what is counted, or what an error is an error of
  uint64_t checked = 0;            // of how many
  std::string text;                // the measurement in words, or why there is none
};

// Counts what was checked and what was wrong, and remembers the first that was.
class Tally {
 public:
  void check(bool right) { ++checked_, wrong_ += !right; }
  template <class Say>
  void check(bool right, const Say& say) {
    if (!right && wrong_ == 0) first_ = say();
    check(right);
  }
  void add(uint64_t wrong, uint64_t checked) { wrong_ += wrong, checked_ += checked; }
  void add(const Tally& other) {
    if (wrong_ == 0) first_ = other.first_;
    add(other.wrong_, other.checked_);
  }
  uint64_t wrong() const { return wrong_; }
  uint64_t checked() const { return checked_; }
  const std::string& first() const { return first_; }

 private:
  uint64_t wrong_ = 0, checked_ = 0;
  std::string first_;
};

// The largest error; NaN is the worst.
class Worst {
 public:
  void add(double error) {
    ++checked_;
    if (!std::isnan(worst_) && !(error <= worst_)) worst_ = error;
  }
  double value() const { return worst_; }
  uint64_t checked() const { return checked_; }

 private:
  double worst_ = 0;
  uint64_t checked_ = 0;
};

// "0 wrong of 1,000,000 pixels". Fails if one is wrong, and if fewer than `least` were checked: then it shows nothing. note: what else is
// worth saying.
Finding none_wrong(const Tally& tally, const std::string& what, uint64_t least, const std::string& note = "");
// "at most 0.0012 texels of 10,400 pixels". Fails past the bound, and if fewer than `least` were checked.
Finding within(const Worst& worst, double bound, const std::string& unit, const std::string& what, uint64_t least,
               const std::string& note = "");
Finding not_measured(const std::string& why);
// 1234567 -> "1,234,567".
std::string grouped(uint64_t n);
// Three significant digits.
std::string short_text(double v);

struct HardCase {
  const char *id, *law, *bound;  // e.g. "R1", "a quad with its corners on pixel centers covers each pixel once", "0 wrong"
  Finding (*measure)(const Effort&);
};

// In the order of the table.
const std::vector<HardCase>& hard_cases();

}  // namespace spanray::hard
