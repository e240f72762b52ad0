// Error curves as inline SVG.
#pragma once
#include <string>

#include "sweep.h"

namespace spanray::demo {

// Both axes logarithmic; values of 0 stand on a line of their own below. Curves in the order of the sweep, ours strong, the bound dashed. The
// legend stands beneath, as HTML.
std::string sweep_plot(const hard::Sweep& sweep);

}  // namespace spanray::demo
