// Visibility engine 2: a bounding volume hierarchy over triangles, and batches of rays against it.
#pragma once
#include <cstddef>
#include <memory>

#include "frame/frame.h"

namespace spanray {

// Trees of two levels, where the scene has instances (ray/bvh_instances.h): where they are worth it, wherever possible, or never.
enum class InstanceUse { kAuto, kAlways, kNever };

class Bvh {
 public:
  Bvh();
  Bvh(Bvh&&) noexcept;
  Bvh& operator=(Bvh&&) noexcept;
  ~Bvh();
  struct Data;  // ray/bvh_data.h
  const Data& data() const { return *data_; }
  size_t memory_bytes() const;
  size_t primitive_count() const;
  int levels() const;             // 2 where parts of instances have trees of their own
  size_t instance_count() const;  // that stand in those

 private:
  friend class BvhRefit;  // ray/bvh_refit.h
  friend Bvh build_bvh(const SceneData&, const uint32_t*, uint32_t, uint32_t, Parallel&, TreeQuality, bool, InstanceUse);
  std::unique_ptr<Data> data_;
};

// Builds over the triangles and exact primitives whose material flags satisfy (flags & mask) == value; material_flags as in Frame. The tree is
// the same for any number of threads, and hits do not depend on it, nor on its quality. An empty set is allowed. follows_motion: for a BvhRefit.
Bvh build_bvh(const SceneData& scene, const uint32_t* material_flags, uint32_t mask, uint32_t value, Parallel& parallel,
              TreeQuality quality = TreeQuality::kFast, bool follows_motion = false, InstanceUse instances = InstanceUse::kAuto);

// For each ray the primitive with the least t in [0, t_max], ties to the lowest id, kNoPrimitive if none. Masked materials ask
// frame.accept_rays; Settings::culling applies. out: rays.count entries. For this and the next two: a hit must be provably in front
// of the origin, in double, so t = 0 is none; a hit at exactly t_max counts. A direction that is zero, NaN or infinite, an origin that
// is not finite, a t_max that is negative or NaN: miss. Answers depend neither on the tree, nor on the order of the batch, nor on the
// instruction set; speed does: 16 neighbours that point into one octant go down the tree together. Thread-safe.
// Exact primitives (ray/exact_set.h) are hit like triangles, but by primary rays (rays.primary), which leave them to raster/exact.h.
void trace_closest(const Frame& frame, const Bvh& bvh, const RayBatch& rays, uint32_t* out);

// Bit i of out (32 a word) is set if ray i hits anything with t in [0, t_max]. Both faces occlude.
void trace_any(const Frame& frame, const Bvh& bvh, const RayBatch& rays, uint32_t* out);

// Rays exactly through an edge or a corner hit all triangles that have it: right for "the closest" and "any", but as layers they would count
// twice. kOfOne: each surface that a ray crosses once (owns_hit() of ray/triangle_test.h), as the rasterizer's top-left rule has it.
enum class HitsOnEdges { kOfAll, kOfOne };

// Appends every hit with t in [0, t_max] (unordered, each primitive once a ray). Of triangles: exact primitives are opaque, so no layers.
void trace_all(const Frame& frame, const Bvh& bvh, const RayBatch& rays, HitsOnEdges edges, FragmentList& out);

}  // namespace spanray
