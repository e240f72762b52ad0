// Maps of numbers as pictures.
#pragma once
#include <vector>

#include "spanray/image.h"

namespace spanray {

// values: row-major, width * height. 0 is black, `most` (> 0) a pale yellow, purple and orange between (the color map "magma" of
// matplotlib by Smith and van der Walt, in eight linear parts); beyond that no change. Below the picture stands a legend: the colors from
// 0 to most, with numbers at the quarters. At least 160 pixels wide; what that adds is black.
Image false_color(const std::vector<float>& values, int width, int height, double most);
// Height of the legend, in pixels.
inline constexpr int kLegendHeight = 24;

}  // namespace spanray
