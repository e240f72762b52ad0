// Sweeps: an error as a function of scale, distance, angle or shape, ours beside what other renderers do, with the contract's
// bound. They show why the contract says what it says; the rows of hard_case.h say whether it is kept.
#pragma once
#include <string>
#include <vector>

#include "hard_case.h"

namespace spanray::hard {

struct Curve {
  std::string name;
  bool ours = false;
  std::vector<double> y;  // one for each x; NaN: there is none; 0 is a value
};

struct Sweep {
  std::string title, what;  // a headline; a paragraph that says what was done and what it shows
  std::string x_name, y_name;
  std::vector<double> x;        // ascending, positive
  std::vector<Curve> curves;
  std::string bound_name;       // empty: none
  std::vector<double> bound;    // one for each x
};

struct SweepCase {
  const char* id;
  Sweep (*measure)(const Effort&);
};

// In the order of the report; together about fifteen seconds on one core, three with Effort::quick.
const std::vector<SweepCase>& sweep_cases();

Sweep sweep_leaks_by_scale(const Effort& effort);
Sweep sweep_leaks_by_distance(const Effort& effort);
Sweep sweep_self_hits_by_scale(const Effort& effort);
Sweep sweep_blockers_by_scale(const Effort& effort);
Sweep sweep_self_hits_by_distance(const Effort& effort);
Sweep sweep_self_hits_by_angle(const Effort& effort);
Sweep sweep_depth_steps(const Effort& effort);
Sweep sweep_uv_by_w_ratio(const Effort& effort);
Sweep sweep_uv_by_sliver(const Effort& effort);

// 10^from, 10^(from + step), ... 10^to.
std::vector<double> decades(double from, double to, double step = 1);

}  // namespace spanray::hard
