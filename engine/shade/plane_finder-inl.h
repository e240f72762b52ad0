// Which planes a block of hits of primary rays sees: those of their triangles, in the cells of the picture where they lie, each set up once.
// Include inside a *_kernel.cpp (simd/dispatch.h), after the project headers.
#if defined(SPANRAY_PLANE_FINDER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_PLANE_FINDER_INL_H_
#undef SPANRAY_PLANE_FINDER_INL_H_
#else
#define SPANRAY_PLANE_FINDER_INL_H_
#endif

#include <cstring>

#include "shade/plane-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {
namespace surface_lanes {

// Lanes whose primitive is a triangle: no miss, no exact primitive.
HWY_INLINE Mask hits_triangle(const SceneData& scene, I32 primitive) {
  return less_unsigned(primitive, i32(static_cast<uint32_t>(scene.triangles.size())));
}

// The same of hits at .. at + kLanes - 1, as far as there are any.
HWY_INLINE Mask triangles_at(const SceneData& scene, const HitBatch& hits, int at) {
  return hits_triangle(scene, I32::load(hits.primitive.data() + at)) & first_lanes(hits.count - at);
}

// Finds the planes of a block by triangle and cell.
class PlaneFinder {
 public:
  PlaneFinder(PlaneBlock& block, const Triangle* triangles) : block_(block), triangles_(triangles) { std::memset(slot_, 0xff, sizeof slot_); }
  int count() const { return static_cast<int>(count_); }
  uint32_t find(uint32_t primitive, uint32_t cell) {
    __builtin_prefetch(triangles_ + primitive);
    // Written before it is known whether it is new: that cannot be predicted, so nothing branches on it.
    block_.primitive[count_] = primitive, block_.cell[count_] = cell;
    for (uint32_t i = (primitive ^ cell * 0x85ebca6bu) * 0x9e3779b9u >> 16;; ++i) {  // Fibonacci hashing: neighbouring ids spread
      uint16_t& slot = slot_[i % kSlots];
      const uint32_t plane = slot < count_ ? slot : count_;  // count_ where the slot is free
      if (((block_.primitive[plane] ^ primitive) | (block_.cell[plane] ^ cell)) != 0) continue;
      slot = static_cast<uint16_t>(plane);
      count_ += plane == count_;
      return plane;
    }
  }

 private:
  static constexpr uint32_t kSlots = 4 * kPlaneHits;  // at most a quarter full
  PlaneBlock& block_;
  const Triangle* const triangles_;
  uint32_t count_ = 0;
  uint16_t slot_[kSlots];
};

HWY_INLINE void prefetch_vertices(const SceneData& scene, uint32_t primitive) {
  for (const uint32_t v : scene.triangles[primitive].vertex) __builtin_prefetch(&scene.vertices[v]);
}

// The planes of up to kPlaneHits hits from `at` on; misses and exact primitives have none.
[[maybe_unused]] static void set_up_block(const Frame& frame, const HitBatch& hits, int at, PlaneBlock& block) {
  const int count = hits.count - at < kPlaneHits ? hits.count - at : kPlaneHits;
  const SceneData& scene = *frame.scene;
  PlaneFinder finder(block, scene.triangles.data());
  constexpr int kLag = 24;  // planes whose triangles are still on their way from memory
  constexpr int kTogether = 3;  // triangles of a vector whose lanes are found by one comparison each; the others one by one
  int fetched = 0;
  uint32_t last = 0, last_primitive = kNoPrimitive, last_cell = 0;  // the last plane looked up: most vectors go on seeing it
  for (int i = 0; i < count; i += kLanes) {
    const Mask hit = triangles_at(scene, hits, at + i);
    const I32 primitive = select(hit, I32::load(hits.primitive.data() + at + i), i32(0)), cell = I32::load(hits.pixel.data() + at + i) & i32(kCellMask);
    I32 plane = i32(last);
    uint32_t left = to_bits(and_not((primitive == i32(last_primitive)) & (cell == i32(last_cell)), hit));
    uint32_t primitives[kLanes], cells[kLanes];
    if (left != 0) primitive.store(primitives), cell.store(cells);
    for (int found = 0; left != 0 && found < kTogether; ++found) {
      const int k = __builtin_ctz(left);
      const Mask same = (primitive == i32(primitives[k])) & (cell == i32(cells[k]));
      last = finder.find(primitives[k], cells[k]), last_primitive = primitives[k], last_cell = cells[k];
      plane = select(same, i32(last), plane);
      left &= ~to_bits(same);
    }
    select(hit, plane, i32(last)).store(block.plane_of_hit + i);  // lanes without a hit follow others
    for (; left != 0; left &= left - 1) {
      const int k = __builtin_ctz(left);
      block.plane_of_hit[i + k] = finder.find(primitives[k], cells[k]);
    }
    for (; fetched < finder.count() - kLag; ++fetched) prefetch_vertices(scene, block.primitive[fetched]);
  }
  block.planes = finder.count();
  if (block.planes == 0) return;
  for (int i = 0; i < kPlaneLine; ++i)  // lanes past the last plane follow it
    block.primitive[block.planes + i] = block.primitive[block.planes - 1], block.cell[block.planes + i] = block.cell[block.planes - 1];
  for (; fetched < block.planes; ++fetched) prefetch_vertices(scene, block.primitive[fetched]);
  for (int i = 0; i < block.planes; i += kLanes) set_up_planes(frame, block, i);
}

}  // namespace surface_lanes
// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_PLANE_FINDER_INL_H_
