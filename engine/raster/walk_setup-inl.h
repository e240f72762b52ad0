// Edges and depth planes of kLanes triangles, set up for the walker of columns. Included once per target.
#if defined(SPANRAY_WALK_SETUP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_WALK_SETUP_INL_H_
#undef SPANRAY_WALK_SETUP_INL_H_
#else
#define SPANRAY_WALK_SETUP_INL_H_
#endif

#include "raster/coverage-inl.h"
#include "raster/setup-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {

// What the walker reads of kLanes triangles, one entry each.
struct alignas(64) WalkSetups {
  static constexpr int kRoom = 16;
  struct Line { double x[kRoom], y[kRoom], slope[kRoom]; };  // EdgeLines, from the tile's upper left corner
  Line whole, upper, lower;
  double depth0[kRoom], depth_dx[kRoom], depth_dy[kRoom];
  int32_t x0[kRoom], x1[kRoom], y0[kRoom], y1[kRoom];
  int32_t turn[kRoom];  // the first row of the lower edge
  float depth_min[kRoom], depth_max[kRoom];
  uint32_t primitive[kRoom];
};

HWY_INLINE void store_line(const EdgeLines& from, WalkSetups::Line& line) {
  from.x.store(line.x), from.y.store(line.y), from.slope.store(line.slope);
}

HWY_INLINE void order_by_row(I32& xa, I32& ya, I32& xb, I32& yb) {
  const Mask swap = ya > yb;
  const I32 x = select(swap, xb, xa), y = select(swap, yb, ya);
  xb = select(swap, xa, xb), yb = select(swap, ya, yb);
  xa = x, ya = y;
}

HWY_INLINE void setup_walk(CornerLanes c, const BoxLanes& box, const DepthLanes& depth, WalkSetups& out) {
  order_by_row(c.x[0], c.y[0], c.x[1], c.y[1]);
  order_by_row(c.x[1], c.y[1], c.x[2], c.y[2]);
  order_by_row(c.x[0], c.y[0], c.x[1], c.y[1]);
  store_line(edge_lines(c.x[0], c.y[0], c.x[2], c.y[2]), out.whole);
  store_line(edge_lines(c.x[0], c.y[0], c.x[1], c.y[1]), out.upper);
  store_line(edge_lines(c.x[1], c.y[1], c.x[2], c.y[2]), out.lower);
  first_centers(c.y[1]).store(out.turn);
  box.x0.store(out.x0), box.x1.store(out.x1), box.y0.store(out.y0), box.y1.store(out.y1);
  depth.depth0.store(out.depth0), depth.dx.store(out.depth_dx), depth.dy.store(out.depth_dy);
  depth.min.store(out.depth_min), depth.max.store(out.depth_max);
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_WALK_SETUP_INL_H_
