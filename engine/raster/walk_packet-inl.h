// Walker for tiny triangles: kLanes of them at once, each lane walks the box of its own. Included once per target.
#if defined(SPANRAY_WALK_PACKET_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_WALK_PACKET_INL_H_
#undef SPANRAY_WALK_PACKET_INL_H_
#else
#define SPANRAY_WALK_PACKET_INL_H_
#endif

#include "raster/setup-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {

constexpr int kPacketPixels = 16;      // the box of a tiny triangle has at most so many
constexpr int32_t kPacketExtent = 1 << 14;  // and its corners are less than so many units apart: edge functions fit 32 bits

// Fragments of one packet.
struct PacketFragments {
  alignas(64) int32_t offset[16 * kPacketPixels + 16];  // into the tile
  alignas(64) float depth[16 * kPacketPixels + 16];
  alignas(64) int32_t primitive[16 * kPacketPixels + 16];
  int count = 0;
};

// One edge function, e(x, y) >= 0 inside, top-left rule included.
struct EdgeLanes { I32 value, right, wrap; };  // at the current pixel; what a step to the right adds, and one to the next row

// Contract: exact. Corners are less than 2^14 units apart and pixels lie in the box, so |e| < 2 * 2^14 * (2^14 + 2^8) + 1 < 2^30; a
//           step past the box wraps at worst, and is not looked at. Inside is e > 0, or e = 0 on a left or top edge.
HWY_INLINE EdgeLanes edge_lanes(I32 xa, I32 ya, I32 xb, I32 yb, const BoxLanes& box) {
  const I32 dx = xb - xa, dy = yb - ya, zero = I32::zero(), half = i32(kSubpixels / 2);
  const I32 px = shift_left<kSubpixelBits>(box.x0) + half, py = shift_left<kSubpixelBits>(box.y0) + half;
  const Mask owns = (dy < zero) | ((dy == zero) & (dx > zero));
  const I32 right = zero - shift_left<kSubpixelBits>(dy);
  return {dx * (py - ya) - dy * (px - xa) - select(owns, zero, i32(1)), right,
          shift_left<kSubpixelBits>(dx) - (box.x1 - box.x0 - i32(1)) * right};
}

// Lanes in `live` have at most kPacketPixels pixels in their boxes; the others are not drawn.
HWY_INLINE void walk_packet(const TileFrame& tile, const CornerLanes& c, const BoxLanes& box, const DepthLanes& depth, I32 primitive,
                            Mask live, PacketFragments& out) {
  const I32 one = i32(1), zero = I32::zero();
  const Mask turned = (c.x[1] - c.x[0]) * (c.y[2] - c.y[0]) < (c.x[2] - c.x[0]) * (c.y[1] - c.y[0]);
  const I32 x1 = select(turned, c.x[2], c.x[1]), y1 = select(turned, c.y[2], c.y[1]);
  const I32 x2 = select(turned, c.x[1], c.x[2]), y2 = select(turned, c.y[1], c.y[2]);
  EdgeLanes edge[3] = {edge_lanes(c.x[0], c.y[0], x1, y1, box), edge_lanes(x1, y1, x2, y2, box), edge_lanes(x2, y2, c.x[0], c.y[0], box)};
  const F64 center_x = f64(tile.x + 0.5), center_y = f64(tile.y + 0.5);
  I32 x = box.x0, y = box.y0;
  I32 left = select(live, (box.x1 - box.x0) * (box.y1 - box.y0), zero);  // pixels to look at
  while (any(left > zero)) {
    const Mask inside = ((edge[0].value | edge[1].value | edge[2].value) > i32(-1)) & (left > zero);
    if (any(inside)) {
      const F32 z = depth_at(depth, to_f64(x) + center_x, to_f64(y) + center_y);
      compress_store(z, inside, out.depth + out.count);
      compress_store(primitive, inside, out.primitive + out.count);
      out.count += compress_store(shift_left<6>(y) + x, inside, out.offset + out.count);
    }
    x = x + one;
    const Mask wrap = x == box.x1;
    x = select(wrap, box.x0, x);
    y = y + select(wrap, one, zero);
    for (EdgeLanes& e : edge) e.value = e.value + select(wrap, e.wrap, e.right);
    left = left - one;
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_WALK_PACKET_INL_H_
