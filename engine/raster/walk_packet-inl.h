// Walker for tiny triangles: kLanes of them at once, each lane walks the box of its own. Included once per target.
#if defined(SPANRAY_WALK_PACKET_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_WALK_PACKET_INL_H_
#undef SPANRAY_WALK_PACKET_INL_H_
#else
#define SPANRAY_WALK_PACKET_INL_H_
#endif

#include "raster/tiny_edges-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {

constexpr int kPacketPixels = 24;  // the box of a tiny triangle has at most so many

// Fragments of one packet.
struct PacketFragments {
  alignas(64) int32_t offset[16 * kPacketPixels + 16];  // into the tile
  alignas(64) float depth[16 * kPacketPixels + 16];
  alignas(64) int32_t primitive[16 * kPacketPixels + 16];
  int count = 0, steps = 0;  // steps: vectors of pixels that were looked at
};

// Lanes in `live` have at most kPacketPixels pixels in their boxes; the others are not drawn.
HWY_INLINE void walk_packet(const TileFrame& tile, const CornerLanes& c, const BoxLanes& box, const DepthLanes& depth, I32 primitive,
                            Mask live, PacketFragments& out) {
  const I32 one = i32(1), zero = I32::zero();
  TinyEdges edges(c, box);
  const F64 center_x = f64(tile.x + 0.5), center_y = f64(tile.y + 0.5);
  I32 left = select(live, (box.x1 - box.x0) * (box.y1 - box.y0), zero);  // pixels to look at
  while (any(left > zero)) {
    const Mask inside = edges.inside() & (left > zero);
    if (any(inside)) {
      const F32 z = depth_at(depth, to_f64(edges.x) + center_x, to_f64(edges.y) + center_y);
      compress_store(z, inside, out.depth + out.count);
      compress_store(primitive, inside, out.primitive + out.count);
      out.count += compress_store(shift_left<6>(edges.y) + edges.x, inside, out.offset + out.count);
    }
    edges.step();
    left = left - one;
    ++out.steps;
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_WALK_PACKET_INL_H_
