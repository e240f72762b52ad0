// Rays against instances (ray/bvh_instances.h), one by one: after a batch has been down the tree of everything else. Included once a target.
// Contract: boxes of parts cull, and conservatively; hit_triangle() decides, on the triangles of the scene.
#if defined(SPANRAY_INSTANCE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_INSTANCE_INL_H_
#undef SPANRAY_INSTANCE_INL_H_
#else
#define SPANRAY_INSTANCE_INL_H_
#endif

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "ray/bvh_instances.h"
#include "ray/packet-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {

// A ray in the space of a part; t is that of the world. Near planes are met from the one origin, far planes from the other: boxes seem
// larger by the slack.
struct PartRay {
  float from_near[3], from_far[3], inverse_near[3], inverse_far[3];
  int near_row[3], far_row[3];  // of BvhNode::bounds
  HWY_INLINE float near_origin(int k) const { return from_near[k]; }
  HWY_INLINE float far_origin(int k) const { return from_far[k]; }
  HWY_INLINE float inv_near(int k) const { return inverse_near[k]; }
  HWY_INLINE float inv_far(int k) const { return inverse_far[k]; }
};

// The ray in world space as doubles: direction as LaneRay has it, within rounding.
struct WorldRay {
  double origin[3], direction[3], reach;  // reach: the largest |coordinate| of the origin
  explicit WorldRay(const LaneRay& ray) : reach(0) {
    const TraceRay& e = ray.exact;
    for (int k = 0; k < 3; ++k) origin[k] = static_cast<double>(e.origin[k]), reach = std::max(reach, std::fabs(origin[k]));
    direction[e.kx] = e.shear_x * e.direction_z, direction[e.ky] = e.shear_y * e.direction_z, direction[e.kz] = e.direction_z;
  }
};

HWY_INLINE void enter_part(const WorldRay& world, const PlacedPart& place, PartRay& ray) {
  constexpr float inf = std::numeric_limits<float>::infinity();
  const double from[3] = {world.origin[0] - place.offset[0], world.origin[1] - place.offset[1], world.origin[2] - place.offset[2]};
  for (int k = 0; k < 3; ++k) {
    const double* const row = place.part_from_world[k];
    const double origin = row[0] * from[0] + row[1] * from[1] + row[2] * from[2];
    const double d = row[0] * world.direction[0] + row[1] * world.direction[1] + row[2] * world.direction[2];
    const double slack = place.slack[k] + place.slack_of_origin[k] * world.reach;
    const bool negative = std::signbit(d);
    const float low = float_below(origin - slack), high = float_above(origin + slack);
    ray.from_near[k] = negative ? low : high, ray.from_far[k] = negative ? high : low;
    ray.near_row[k] = negative ? k + 3 : k, ray.far_row[k] = negative ? k : k + 3;
    if (d == 0) {
      ray.inverse_near[k] = ray.inverse_far[k] = negative ? -inf : inf;
    } else if (std::fabs(d) < 0x1p-126) {
      ray.inverse_near[k] = ray.inverse_far[k] = std::numeric_limits<float>::quiet_NaN();  // the axis never culls
    } else {
      const double inverse = 1 / d;
      ray.inverse_near[k] = static_cast<float>(inverse * (1 - static_cast<double>(kSlabWidening)));
      ray.inverse_far[k] = static_cast<float>(inverse * (1 + static_cast<double>(kSlabWidening)));
    }
  }
}

// One triangle of the scene: vertices along the first axis, then coordinates.
struct SceneTriangle {
  float vertex[9];
  HWY_INLINE SceneTriangle(const SceneData& scene, uint32_t primitive) {
    const Triangle& t = scene.triangles[primitive];
    for (int v = 0; v < 3; ++v)
      for (int k = 0; k < 3; ++k) vertex[3 * v + k] = scene.vertices[t.vertex[v]].position[k];
  }
  HWY_INLINE TriangleView view() const { return {vertex, 3, 1}; }
};

// True if the visitor wants to end. A closest hit is always known by its t here.
template <class Visitor> HWY_INLINE bool visit_triangle(const SceneData& scene, uint32_t primitive, const LaneRay& ray, Visitor& visitor) {
  if (primitive == ray.from) return false;
  const SceneTriangle triangle(scene, primitive);
  double t;
  if (!hit_triangle(ray.exact, triangle.view(), t)) return false;
  if constexpr (Visitor::kClosest) return visitor.hit(t, primitive, 0), false;
  else return visitor.takes(triangle.view()) && visitor.hit(t, primitive);
}

// Visits what the ray may hit of one place; true if the visitor wants to end.
template <class Visitor>
HWY_INLINE bool traverse_place(const SceneData& scene, const InstanceTrees& trees, uint32_t index, const WorldRay& world, const LaneRay& ray, Visitor& visitor) {
  const PlacedPart& place = trees.placed[index];
  PartRay in_part;
  enter_part(world, place, in_part);
  return descend_to_leaves(trees.parts[place.part], 0, in_part, visitor,
                 [&](uint32_t leaf) HWY_ATTR { return visit_triangle(scene, place.first + (leaf & ~kLeafBit), ray, visitor); });
}

// Of all places, at no more than visitor.limit.
template <class Visitor>
HWY_INLINE void traverse_instances(const SceneData& scene, const InstanceTrees& trees, const LaneRay& ray, Visitor& visitor) {
  const WorldRay world(ray);
  descend_to_leaves(trees.top, 0, ray, visitor, [&](uint32_t leaf) HWY_ATTR { return traverse_place(scene, trees, leaf & ~kLeafBit, world, ray, visitor); });
}

// Of the rays of a packet that has found its closest hits elsewhere: what is nearer among instances.
HWY_NOINLINE void closest_of_instances(ClosestPacket& packet, const InstanceTrees& trees) {
  alignas(64) float lows[kLanes], limits[kLanes];
  packet.low.store(lows), packet.p.limit.store(limits);
  for (uint32_t rest = packet.p.valid; rest != 0; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    LaneRay ray;
    take_lane(packet.lanes(), i, ray);
    ClosestVisitor visitor{packet.batch, packet.data,     ray.exact, packet.first + i, packet.best_t[i],
                           packet.best[i], packet.place[i], lows[i],   limits[i],        (packet.known >> i & 1u) != 0};
    traverse_instances(*packet.batch.frame.scene, trees, ray, visitor);
    packet.best[i] = visitor.best;
  }
}

// Of all rays of a batch that no bit of `out` is set for.
HWY_NOINLINE void any_of_instances(AnyPacket& packet, const InstanceTrees& trees, uint32_t* out) {
  for (int first = 0; first < packet.batch.rays.count; first += kLanes) {
    const uint32_t hit = out[first / 32] >> (first % 32) & ((1u << kLanes) - 1);
    if (hit == (1u << kLanes) - 1) continue;
    packet.start(first);
    for (uint32_t rest = packet.p.valid & ~hit; rest != 0; rest &= rest - 1) {
      const int i = std::countr_zero(rest);
      LaneRay ray;
      take_lane(packet.lanes(), i, ray);
      AnyVisitor visitor{packet.batch, ray.exact, first + i, packet.lanes().limit[i]};
      traverse_instances(*packet.batch.frame.scene, trees, ray, visitor);
      if (visitor.found) out[(first + i) / 32] |= 1u << ((first + i) % 32);
    }
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_INSTANCE_INL_H_
