// Intervals of colors, a channel at a time.
#pragma once
#include <algorithm>
#include <limits>

#include "math/vec.h"

namespace spanray::reference {

inline glm::dvec3 least(const glm::dvec3& a, const glm::dvec3& b) {
  return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}
inline glm::dvec3 most(const glm::dvec3& a, const glm::dvec3& b) {
  return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}

// low <= high in every channel; all values that this file makes ranges of are 0 or more. A new one holds nothing.
struct ColorRange {
  glm::dvec3 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};

  static ColorRange of(const glm::dvec3& v) { return {v, v}; }
  void add(const glm::dvec3& v) { low = least(low, v), high = most(high, v); }
  void add(const ColorRange& r) { low = least(low, r.low), high = most(high, r.high); }
  bool empty() const { return !(low.x <= high.x && low.y <= high.y && low.z <= high.z); }
};
inline ColorRange operator+(const ColorRange& a, const ColorRange& b) { return {a.low + b.low, a.high + b.high}; }
inline ColorRange operator*(const ColorRange& a, const ColorRange& b) { return {a.low * b.low, a.high * b.high}; }
inline ColorRange operator*(const ColorRange& a, double scale) { return {a.low * scale, a.high * scale}; }

inline constexpr double kAnything = 1e30;  // more than any radiance; products of a few are still finite

struct Range {
  double low = 0, high = 0;
};
// Porter and Duff 1984: c over `back`; the result is linear in alpha, so its extremes are at those of alpha.
inline ColorRange over(const ColorRange& c, const Range& alpha, const ColorRange& back) {
  ColorRange sum = c * alpha.low + back * (1 - alpha.low);
  const ColorRange other = c * alpha.high + back * (1 - alpha.high);
  return {least(sum.low, other.low), most(sum.high, other.high)};
}

// A function's range over a small region, from its values at the middle, at the region's corners, and at the middle with errors
// of reading (nudges): to first order the two deviations add. `more`: times so much, for what is not of first order.
class Spread {
 public:
  void middle(const glm::dvec3& v) { at_ = v, corners_.add(v), nudges_.add(v); }
  void corner(const glm::dvec3& v) { corners_.add(v); }
  void nudge(const glm::dvec3& v) { nudges_.add(v); }
  ColorRange range(double more = 1.25) const {
    const glm::dvec3 low = at_ - (at_ - corners_.low + at_ - nudges_.low) * more,
                     high = at_ + (corners_.high - at_ + nudges_.high - at_) * more;
    return {most(low, glm::dvec3(0)), high};
  }

 private:
  glm::dvec3 at_{0};
  ColorRange corners_, nudges_;
};

}  // namespace spanray::reference
