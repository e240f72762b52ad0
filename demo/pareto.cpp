#include "pareto.h"

#include <cstddef>

namespace spanray::demo {
namespace {

bool faster(const Cost& a, const Cost& b) { return a.ms != b.ms ? a.ms < b.ms : a.error < b.error; }
bool better(const Cost& a, const Cost& b) { return a.error != b.error ? a.error < b.error : a.ms < b.ms; }
bool dominates(const Cost& a, const Cost& b) { return a.ms <= b.ms && a.error <= b.error && (a.ms < b.ms || a.error < b.error); }

// The first of all points that are eligible, by `before`.
template <class Eligible> int first(const std::vector<Cost>& points, bool (*before)(const Cost&, const Cost&), const Eligible& eligible) {
  int best = -1;
  for (size_t i = 0; i < points.size(); ++i)
    if (eligible(points[i]) && (best < 0 || before(points[i], points[static_cast<size_t>(best)]))) best = static_cast<int>(i);
  return best;
}

}  // namespace

std::vector<int> dominated_by(const std::vector<Cost>& points) {
  std::vector<int> by;
  for (const Cost& point : points) by.push_back(first(points, faster, [&](const Cost& other) { return dominates(other, point); }));
  return by;
}

int best_within_time(const std::vector<Cost>& points, double ms) {
  return first(points, better, [&](const Cost& p) { return p.ms <= ms; });
}

int fastest_within_error(const std::vector<Cost>& points, double error) {
  return first(points, faster, [&](const Cost& p) { return p.error <= error; });
}

}  // namespace spanray::demo
