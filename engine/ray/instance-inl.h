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
  float near_origin[3], far_origin[3], inv_near[3], inv_far[3];
  int near_row[3], far_row[3];  // of BvhNode::bounds
};

// As the one of ray/traverse-inl.h, for Stack.
HWY_INLINE ChildLanes box_children(const BvhNode& node, int first, const PartRay& ray, float limit) {
  F8 near = f8(0.0f), far = f8(limit);
  for (int k = 0; k < 3; ++k) {
    near = cull_max((F8::load(node.bounds[ray.near_row[k]] + first) - f8(ray.near_origin[k])) * f8(ray.inv_near[k]), near);
    far = cull_min((F8::load(node.bounds[ray.far_row[k]] + first) - f8(ray.far_origin[k])) * f8(ray.inv_far[k]), far);
  }
  return {near <= far, near};
}

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
    ray.near_origin[k] = negative ? low : high, ray.far_origin[k] = negative ? high : low;
    ray.near_row[k] = negative ? k + 3 : k, ray.far_row[k] = negative ? k : k + 3;
    if (d == 0) {
      ray.inv_near[k] = ray.inv_far[k] = negative ? -inf : inf;
    } else if (std::fabs(d) < 0x1p-126) {
      ray.inv_near[k] = ray.inv_far[k] = std::numeric_limits<float>::quiet_NaN();  // the axis never culls
    } else {
      const double inverse = 1 / d;
      ray.inv_near[k] = static_cast<float>(inverse * (1 - static_cast<double>(kSlabWidening)));
      ray.inv_far[k] = static_cast<float>(inverse * (1 + static_cast<double>(kSlabWidening)));
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

// As traverse() of ray/traverse-inl.h: visit(number) is called for the leaves that the ray may meet, near first, but for kAny in no order; it
// returns true to end, and so does this.
template <class Visitor, class Ray, class Visit>
HWY_INLINE bool traverse_single(const SingleTree& tree, const Ray& ray, const Visitor& visitor, const Visit& visit) {
  Stack stack;
  uint32_t child = 0;
  for (;;) {
    if ((child & kLeafBit) == 0) {
      child = Visitor::kAny ? stack.push_any(tree[child], ray, visitor.limit) : stack.push_sorted(tree[child], ray, visitor.limit);
      if (child != kNothing) continue;
    } else if (visit(child & ~kLeafBit)) {
      return true;
    }
    do {
      if (stack.top == 0) return false;
      --stack.top;
    } while (!Visitor::kAny && stack.near[stack.top] > visitor.limit);
    child = stack.child[stack.top];
  }
}

// Visits what the ray may hit of one place; true if the visitor wants to end.
template <class Visitor>
HWY_INLINE bool traverse_place(const SceneData& scene, const InstanceTrees& trees, uint32_t index, const WorldRay& world, const LaneRay& ray, Visitor& visitor) {
  const PlacedPart& place = trees.placed[index];
  PartRay in_part;
  enter_part(world, place, in_part);
  return traverse_single(trees.parts[place.part], in_part, visitor,
                         [&](uint32_t triangle) HWY_ATTR { return visit_triangle(scene, place.first + triangle, ray, visitor); });
}

// Of all places, at no more than visitor.limit.
template <class Visitor>
HWY_INLINE void traverse_instances(const SceneData& scene, const InstanceTrees& trees, const LaneRay& ray, Visitor& visitor) {
  const WorldRay world(ray);
  traverse_single(trees.top, ray, visitor, [&](uint32_t place) HWY_ATTR { return traverse_place(scene, trees, place, world, ray, visitor); });
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
