#include <cmath>

#include "sweep.h"

namespace spanray::hard {

const std::vector<SweepCase>& sweep_cases() {
  static const std::vector<SweepCase> list = {
      {"leaks-by-scale", sweep_leaks_by_scale},           {"leaks-by-distance", sweep_leaks_by_distance},
      {"self-hits-by-scale", sweep_self_hits_by_scale},   {"blockers-by-scale", sweep_blockers_by_scale},
      {"self-hits-by-distance", sweep_self_hits_by_distance}, {"self-hits-by-angle", sweep_self_hits_by_angle},
      {"depth-steps", sweep_depth_steps},                 {"uv-by-w-ratio", sweep_uv_by_w_ratio},
      {"uv-by-sliver", sweep_uv_by_sliver},
  };
  return list;
}

std::vector<double> decades(double from, double to, double step) {
  std::vector<double> x;
  for (int i = 0; from + i * step <= to + 1e-9; ++i) x.push_back(std::pow(10.0, from + i * step));
  return x;
}

}  // namespace spanray::hard
