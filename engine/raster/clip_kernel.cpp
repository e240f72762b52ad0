// The front end in lanes: culls kLanes triangles at a time, and sets up kLanes of those that are left.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "frame/frame.h"
#include "raster/clip_kernel.h"
#include "raster/clusters.h"
#include "raster/fixed_point.h"
#include "simd/dispatch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/clip_kernel.cpp"
#include "hwy/foreach_target.h"
#include "simd/lanes-inl.h"
#include "raster/depth_plane-inl.h"
#include "raster/tiny_edges-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {

class RangeClipper {
 public:
  RangeClipper(const Frame& frame, const ScreenVertices& vertices, BinChunk& chunk, FrameCounts& counts)
      : frame_(frame), scene_(*frame.scene), vertices_(vertices), chunk_(chunk), counts_(counts) {}

  void run(uint32_t begin, uint32_t end, const uint8_t* fate) {
    for (uint32_t first = begin, last; first < end; first = last) {
      const uint8_t what = fate == nullptr ? uint8_t{kClusterKept} : fate[first / kClusterTriangles];
      for (last = first; last < end && (fate == nullptr || fate[last / kClusterTriangles] == what);) last += kClusterTriangles;
      last = std::min(last, end);
      if (what == kClusterKept) {
        keep(first, last);
        continue;
      }
      counts_.triangles_in += last - first;
      (what == kClusterOutside    ? counts_.triangles_outside
       : what == kClusterBackFace ? counts_.triangles_back_face
                                  : counts_.triangles_hidden) += last - first;
    }
    if (count_ > 0) set_up(count_);
  }

 private:
  void keep(uint32_t begin, uint32_t end) {
    for (uint32_t first = begin; first < end; first += kLanes) {
      cull(first, static_cast<int>(std::min<uint32_t>(kLanes, end - first)));
      if (count_ >= kLanes) set_up(kLanes);
    }
  }

  // What survives, packed. Room for what is left of one vector, and one more.
  struct Queue {
    alignas(64) int32_t primitive[32], vertex[3][32], x[3][32], y[3][32], tile_box[32];
  };

  HWY_INLINE I32 outcode(I32 vertex) const {
    const auto pairs = reinterpret_cast<const int32_t*>(vertices_.outcode.data());
    return shift_right_by(gather(pairs, shift_right<1>(vertex)), shift_left<4>(vertex & i32(1))) & i32(0xffff);
  }

  void cull(uint32_t first, int n) {
    const Mask valid = first_lanes(n);
    const I32 primitive = min_(lane_iota(static_cast<int32_t>(first)), i32(static_cast<int32_t>(first) + n - 1)), zero = I32::zero();
    const I32 word = primitive * i32(kTriangleStride);
    const uint32_t* const triangle = scene_.triangles.data()->vertex;
    I32 vertex[3], all = i32(-1), some = zero;
    for (int i = 0; i < 3; ++i) {
      vertex[i] = gather(triangle + i, word);
      const I32 code = outcode(vertex[i]);
      all = all & code, some = some | code;
    }
    const Mask known = and_not((some & i32(int32_t{kOutInvalid})) != zero, valid);
    const Mask meets = known & (all == zero);
    if (any(meets & ((some & i32(int32_t{kOutClipMask})) != zero))) {
      clip_all(first, n);
      return;
    }
    counts_.triangles_in += static_cast<uint64_t>(n);
    counts_.triangles_invalid += static_cast<uint64_t>(n - count(known));
    counts_.triangles_outside += static_cast<uint64_t>(count(known) - count(meets));
    if (!any(meets)) return;
    const Mask front = frame_.settings.culling == Culling::kBack ? meets & faces_eye(vertex, word) : meets;
    counts_.triangles_back_face += static_cast<uint64_t>(count(meets) - count(front));
    if (any(front)) keep_covering(primitive, vertex, front);
  }

  // Some need clipping, which is rare. In order of primitives.
  void clip_all(uint32_t first, int n) {
    if (count_ > 0) set_up(count_);
    for (uint32_t i = 0; i < static_cast<uint32_t>(n); ++i) clip_triangle(frame_, vertices_, first + i, chunk_, counts_);
  }

  Mask faces_eye(const I32 vertex[3], I32 word) const {
    const Dvec3Lanes v[3] = {position_of(scene_, vertex[0]), position_of(scene_, vertex[1]), position_of(scene_, vertex[2])};
    const F64 side = unturned_facing(v, frame_.primary.eye), zero = f64(0.0);
    const Mask flipped = gather(&scene_.triangles.data()->bits, word) < I32::zero();  // kTriangleFlipped is the sign
    return (flipped & (side < zero)) | and_not(flipped, side > zero);
  }

  // Queues the triangles that may cover a sample of the picture; tiny ones only if they do.
  void keep_covering(I32 primitive, const I32 vertex[3], Mask front) {
    CornerLanes c;
    for (int i = 0; i < 3; ++i) c.x[i] = gather(vertices_.x_24_8.data(), vertex[i]), c.y[i] = gather(vertices_.y_24_8.data(), vertex[i]);
    const SamplePlaces& s = frame_.places;
    const I32 zero = I32::zero(), one = i32(1);
    const BoxLanes box{max_(first_centers(least(c.x) - i32(s.right)), zero), min_(first_centers(greatest(c.x) - i32(s.left)), i32(frame_.grid.width)),
                       max_(first_centers(least(c.y) - i32(s.bottom)), zero), min_(first_centers(greatest(c.y) - i32(s.top)), i32(frame_.grid.height))};
    const I32 w = box.x1 - box.x0, h = box.y1 - box.y0;
    Mask covers = front & (w > zero) & (h > zero);
    if (s.count == 1) covers = covers & !misses_all(c, box, covers & (w * h < i32(kLookedAt + 1)));
    const F64 left = to_f64(c.x[1] - c.x[0]) * to_f64(c.y[2] - c.y[0]), right = to_f64(c.x[2] - c.x[0]) * to_f64(c.y[1] - c.y[0]);
    covers = and_not(left == right, covers);  // products below 2^50: exact
    counts_.triangles_empty += static_cast<uint64_t>(count(front) - count(covers));
    if (!any(covers)) return;
    const I32 tile_box = shift_right<kTileBits>(box.x0) | shift_left<8>(shift_right<kTileBits>(box.x1 - one)) |
                         shift_left<16>(shift_right<kTileBits>(box.y0)) | shift_left<24>(shift_right<kTileBits>(box.y1 - one));
    for (int i = 0; i < 3; ++i) {
      compress_store(vertex[i], covers, queue_.vertex[i] + count_);
      compress_store(c.x[i], covers, queue_.x[i] + count_);
      compress_store(c.y[i], covers, queue_.y[i] + count_);
    }
    compress_store(tile_box, covers, queue_.tile_box + count_);
    count_ += compress_store(primitive, covers, queue_.primitive + count_);
  }

  // Of the lanes in `few`, whose boxes have 1 to kLookedAt pixels, those that cover none.
  static Mask misses_all(const CornerLanes& c, const BoxLanes& box, Mask few) {
    const Mask candidates = few & has_tiny_extent(c);
    Mask missing = candidates;
    if (!any(candidates)) return missing;
    const I32 pixels = (box.x1 - box.x0) * (box.y1 - box.y0);
    TinyEdges edges(c, box);
    for (int k = 0; k < kLookedAt; ++k, edges.step()) missing = and_not(edges.inside() & (pixels > i32(k)), missing);
    return missing;
  }

  // The first n of the queue become screen triangles.
  void set_up(int n) {
    const I32 last = i32(n - 1), index = min_(lane_iota(), last);
    I32 vertex[3];
    Dvec3Lanes v[3];
    F64 view_depth[3];
    for (int i = 0; i < 3; ++i) {
      vertex[i] = gather(queue_.vertex[i], index);
      v[i] = position_of(scene_, vertex[i]);
      view_depth[i] = gather(vertices_.w.data(), vertex[i]);
    }
    const DepthPlaneLanes plane = depth_planes(frame_.primary, v, view_depth);
    const I32 primitive = gather(queue_.primitive, index);
    const I32 material = gather(&scene_.triangles.data()->bits, primitive * i32(kTriangleStride)) & i32(static_cast<int32_t>(kTriangleMaterialMask));
    const I32 flags = gather(frame_.material_flags, material);
    chunk_.has_translucent |= any(first_lanes(n) & ((flags & i32(int32_t{kMaterialTranslucent})) != I32::zero()));
    const size_t size = chunk_.triangles.size();
    chunk_.triangles.resize(size + static_cast<size_t>(n)), chunk_.tile_box.resize(size + static_cast<size_t>(n));
    gather(queue_.tile_box, index).store(chunk_.tile_box.data() + size);  // its padding has room for a vector
    const auto queued = [&](const int32_t* a) HWY_ATTR { return I32::load(a); };
    const Words depth0 = words_of(plane.depth0), dx = words_of(plane.dx), dy = words_of(plane.dy);
    alignas(64) int32_t quarter[4][4 * 16];  // of the records: the four words of each, one record after the other
    store_quads(queued(queue_.x[0]), queued(queue_.x[1]), queued(queue_.x[2]), queued(queue_.y[0]), quarter[0]);
    store_quads(queued(queue_.y[1]), queued(queue_.y[2]), primitive, flags, quarter[1]);
    store_quads(bits_of(plane.min), bits_of(plane.max), depth0.low, depth0.high, quarter[2]);
    store_quads(dx.low, dx.high, dy.low, dy.high, quarter[3]);
    char* const out = reinterpret_cast<char*>(chunk_.triangles.data() + size);
    for (int k = 0; k < 2 * kLanes; ++k) __builtin_prefetch(out + 64 * k, 1);  // what is written now and next
    for (int k = 0; k < n; ++k)
      for (int q = 0; q < 4; ++q) std::memcpy(out + 64 * k + 16 * q, quarter[q] + 4 * k, 16);
    counts_.triangles_drawn += static_cast<uint64_t>(n);
    drop(n);
  }

  struct Words { I32 low, high; };
  static HWY_INLINE Words words_of(F64 a) {
#if HWY_TARGET == HWY_SCALAR
    const int64_t bits = hn::GetLane(hn::BitCast(DDI(), a.v[0]));
    return {i32(static_cast<int32_t>(bits)), i32(static_cast<int32_t>(bits >> 32))};
#else
    const auto first = hn::BitCast(DI(), a.v[0]), second = hn::BitCast(DI(), a.v[1]);
    return {{hn::ConcatEven(DI(), second, first)}, {hn::ConcatOdd(DI(), second, first)}};
#endif
  }
  static HWY_INLINE void store_quads(I32 a, I32 b, I32 c, I32 d, int32_t* p) { hn::StoreInterleaved4(a.v, b.v, c.v, d.v, DI(), p); }
  // The order of words that set_up writes.
  static_assert(offsetof(ScreenTriangle, y_24_8) == 12 && offsetof(ScreenTriangle, primitive) == 24 && offsetof(ScreenTriangle, flags) == 28 &&
                offsetof(ScreenTriangle, depth_min) == 32 && offsetof(ScreenTriangle, depth_max) == 36 &&
                offsetof(ScreenTriangle, depth0) == 40 && offsetof(ScreenTriangle, depth_dx) == 48 && offsetof(ScreenTriangle, depth_dy) == 56);

  void drop(int n) {
    count_ -= n;
    const auto shift = [&](int32_t* a) HWY_ATTR { I32::load(a + n).store(a); };
    if (count_ == 0) return;  // else n is kLanes
    shift(queue_.primitive), shift(queue_.tile_box);
    for (int i = 0; i < 3; ++i) shift(queue_.vertex[i]), shift(queue_.x[i]), shift(queue_.y[i]);
  }

  static constexpr int kLookedAt = 4;
  static constexpr int kTileBits = 6;
  static_assert(kTileSize == 1 << kTileBits);

  const Frame& frame_;
  const SceneData& scene_;
  const ScreenVertices& vertices_;
  BinChunk& chunk_;
  FrameCounts& counts_;
  int count_ = 0;
  alignas(64) Queue queue_ = {};
};

void clip_range(const Frame& frame, const ScreenVertices& vertices, uint32_t begin, uint32_t end, const uint8_t* fate,
                BinChunk& chunk, FrameCounts& counts) {
  RangeClipper(frame, vertices, chunk, counts).run(begin, end, fate);
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace spanray {

const ClipRangeFn kClipRange[kIsaCount] = SPANRAY_KERNEL_TABLE(clip_range);

}  // namespace spanray
#endif
