// Numbers of twice the precision of double, as unevaluated sums: for differences that cancel almost wholly. Plain IEEE
// arithmetic, so the same bits on every machine, with or without a fused multiply-add.
#pragma once

namespace spanray {
namespace double_double {

using Number = double;
inline double number(double x) { return x; }
#define SPANRAY_DOUBLE_DOUBLE inline
#include "math/double_double.inl"

}  // namespace double_double

using double_double::difference_of_products, double_double::DoubleDouble, double_double::two_product, double_double::two_sum;

}  // namespace spanray
