// Edge functions of tiny triangles, one a lane, each walking the box of its own. Included once per target.
#if defined(SPANRAY_TINY_EDGES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_TINY_EDGES_INL_H_
#undef SPANRAY_TINY_EDGES_INL_H_
#else
#define SPANRAY_TINY_EDGES_INL_H_
#endif

#include "raster/setup-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {

constexpr int32_t kTinyExtent = 1 << 14;  // corners less than so many units apart: edge functions fit 32 bits
HWY_INLINE Mask has_tiny_extent(const CornerLanes& c) {
  return max_(greatest(c.x) - least(c.x), greatest(c.y) - least(c.y)) < i32(kTinyExtent);
}

// Contract: exact. Corners are less than 2^14 units apart and pixels lie in the box, so |e| < 2 * 2^14 * (2^14 + 2^8) + 1 < 2^30; a step
//           past the box wraps at worst, and is not looked at. Inside is e > 0, or e = 0 on a left or top edge, for the winding
//           of positive area; lanes of the other one have two corners exchanged.
class TinyEdges {
 public:
  I32 x, y;  // the current pixel: the first of the box, then row by row

  HWY_INLINE TinyEdges(const CornerLanes& c, const BoxLanes& box) : x(box.x0), y(box.y0), box_(box) {
    const Mask turned = (c.x[1] - c.x[0]) * (c.y[2] - c.y[0]) < (c.x[2] - c.x[0]) * (c.y[1] - c.y[0]);
    const I32 x1 = select(turned, c.x[2], c.x[1]), y1 = select(turned, c.y[2], c.y[1]);
    const I32 x2 = select(turned, c.x[1], c.x[2]), y2 = select(turned, c.y[1], c.y[2]);
    edge_[0] = make(c.x[0], c.y[0], x1, y1), edge_[1] = make(x1, y1, x2, y2), edge_[2] = make(x2, y2, c.x[0], c.y[0]);
  }
  HWY_INLINE Mask inside() const { return (edge_[0].value | edge_[1].value | edge_[2].value) > i32(-1); }
  HWY_INLINE void step() {
    x = x + i32(1);
    const Mask wrap = x == box_.x1;
    x = select(wrap, box_.x0, x);
    y = y + select(wrap, i32(1), I32::zero());
    for (Edge& e : edge_) e.value = e.value + select(wrap, e.wrap, e.right);
  }

 private:
  struct Edge { I32 value, right, wrap; };  // at the current pixel, inside if >= 0; what a step to the right or to the next row adds

  HWY_INLINE Edge make(I32 xa, I32 ya, I32 xb, I32 yb) const {
    const I32 dx = xb - xa, dy = yb - ya, zero = I32::zero(), half = i32(kSubpixels / 2);
    const I32 px = shift_left<kSubpixelBits>(box_.x0) + half, py = shift_left<kSubpixelBits>(box_.y0) + half;
    const Mask owns = (dy < zero) | ((dy == zero) & (dx > zero));
    const I32 right = zero - shift_left<kSubpixelBits>(dy);
    return {dx * (py - ya) - dy * (px - xa) - select(owns, zero, i32(1)), right,
            shift_left<kSubpixelBits>(dx) - (box_.x1 - box_.x0 - i32(1)) * right};
  }
  BoxLanes box_;
  Edge edge_[3];
};

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_TINY_EDGES_INL_H_
