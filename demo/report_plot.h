// Scatter plots as inline SVG.
#pragma once
#include <string>
#include <vector>

#include "pareto.h"

namespace spanray::demo {

struct PlotPoint {
  Cost cost;
  std::string id, name;   // data-id of the circle, tooltip
  bool on_front = false;
};

// Text that stands for itself in HTML and SVG, attributes included.
std::string escape_html(const std::string& text);

// Error against time, both axes logarithmic; the front as steps, points on it numbered in order of time. An error of 0 stands in a row of its own below the scale. truth_error: what the ground truth errs itself, a dashed line. points: not empty, times > 0.
std::string scatter_plot(const std::vector<PlotPoint>& points, const std::string& error_name, double truth_error);

}  // namespace spanray::demo
