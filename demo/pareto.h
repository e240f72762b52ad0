// Which of several ways to make a picture are worth their time.
#pragma once
#include <vector>

namespace spanray::demo {

struct Cost {
  double ms = 0, error = 0;
};

// For each point, the index of a point that costs no more and errs no more, and is better in one of the two: the fastest of
// those, of equally fast ones the one with the least error. -1: there is none, the point is on the Pareto front. Equal points
// do not dominate each other.
std::vector<int> dominated_by(const std::vector<Cost>& points);

// Index of the point with the least error that costs at most ms; of equal ones the fastest. -1 if there is none.
int best_within_time(const std::vector<Cost>& points, double ms);
// Index of the fastest point that errs at most `error`; of equal ones that with the least error. -1 if there is none.
int fastest_within_error(const std::vector<Cost>& points, double error);

}  // namespace spanray::demo
