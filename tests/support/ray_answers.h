// What a tree answers to a batch of rays, and what brute force does.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string_view>
#include <vector>

#include "ray/bvh.h"
#include "support/awkward_rays.h"

namespace spanray {

// AcceptRaysFn by accepts(pixel), of each ray that is asked for.
template <class Accepts> uint32_t accept_each(const RayBatch& rays, int first, uint32_t candidates, const Accepts& accepts) {
  uint32_t accepted = 0;
  for (uint32_t i = 0; i < 32; ++i)
    if ((candidates >> i & 1) != 0 && accepts(rays.pixel[static_cast<size_t>(first) + i])) accepted |= 1u << i;
  return accepted;
}

// An AcceptRaysFn: of each triangle the pixels of one parity.
inline uint32_t accept_every_other(const Frame&, const RayBatch& rays, int first, uint32_t primitive, uint32_t candidates) {
  return accept_each(rays, first, candidates, [primitive](uint32_t pixel) { return (pixel + primitive) % 2 == 0; });
}

// Adds a ray that leaves primitive `from`. Returns its number.
inline int add_ray(RayBatch& rays, const glm::dvec3& o, const glm::dvec3& d, float t_max = std::numeric_limits<float>::infinity(),
                   uint32_t from = kNoPrimitive) {
  const int i = rays.count;
  rays.resize(i + 1, false), rays.from.resize(static_cast<size_t>(i) + 1);
  for (int k = 0; k < 3; ++k) rays.origin[k][i] = static_cast<float>(o[k]), rays.direction[k][i] = static_cast<float>(d[k]);
  rays.t_max[i] = t_max, rays.pixel[i] = 0, rays.from[i] = from;
  return i;
}

// Rays through a cloud of that scale: some along an axis or in a plane of two, some with an end, some that leave one of its primitives.
inline RayBatch crossing_rays(TestRandom& random, int count, double scale, const glm::dvec3& offset, uint32_t primitives) {
  RayBatch rays;
  for (int i = 0; i < count; ++i) {
    const glm::dvec3 o = offset + random_point(random, 2 * scale);
    glm::dvec3 d = offset + random_point(random, scale) - o;
    if (i % 5 == 0) d[i % 3] = 0;
    if (i % 7 == 0) d[(i + 1) % 3] = -0.0;
    const float end = i % 3 == 0 ? static_cast<float>(random.uniform(0, 1)) : std::numeric_limits<float>::infinity();
    add_ray(rays, o, d, end, i % 4 == 0 ? static_cast<uint32_t>(random.below(static_cast<int>(primitives))) : kNoPrimitive);
  }
  return rays;
}

struct Answers {
  std::vector<uint32_t> closest;
  std::vector<bool> any;
  std::vector<std::vector<uint32_t>> all;  // ascending
  bool operator==(const Answers&) const = default;
};

inline Answers trace(TestFrame& t, const Bvh& bvh, const RayBatch& rays, Isa isa) {
  t.frame.isa = isa;
  const size_t n = static_cast<size_t>(rays.count);
  Answers a;
  a.closest.resize(n), a.all.resize(n);
  std::vector<uint32_t> bits(n / 32 + 1, 0xdeadbeef);
  trace_closest(t.frame, bvh, rays, a.closest.data());
  trace_any(t.frame, bvh, rays, bits.data());
  FragmentList list;
  trace_all(t.frame, bvh, rays, HitsOnEdges::kOfAll, list);
  for (size_t i = 0; i < n; ++i) a.any.push_back(bits[i / 32] >> (i % 32) & 1);
  for (size_t i = 0; i < list.ray.size(); ++i) {
    EXPECT_EQ(list.pixel[i], rays.pixel[list.ray[i]]);
    a.all[list.ray[i]].push_back(list.primitive[i]);
  }
  for (auto& hits : a.all) std::sort(hits.begin(), hits.end());
  return a;
}

// `occludes` stands for the masks, `seen` for masks and culling.
template <class Occludes, class Seen>
Answers brute_force(const TestFrame& t, const RayBatch& rays, const Occludes& occludes, const Seen& seen) {
  Answers a;
  for (int i = 0; i < rays.count; ++i) {
    uint32_t closest;
    a.any.push_back(!brute_force_all(t.scene, rays, i, [&](uint32_t p) { return occludes(i, p); }, &closest).empty());
    a.all.push_back(brute_force_all(t.scene, rays, i, [&](uint32_t p) { return seen(i, p); }, &closest));
    a.closest.push_back(closest);
  }
  return a;
}
inline Answers brute_force(const TestFrame& t, const RayBatch& rays) {
  const auto yes = [](int, uint32_t) { return true; };
  return brute_force(t, rays, yes, yes);
}

inline Bvh build_all(const TestFrame& t) { return build_bvh(t.scene, t.material_flags.data(), 0, 0, *t.parallel); }

inline void expect_equal(const Answers& got, const Answers& want, const RayBatch& rays, std::string_view where) {
  if (got == want) return;
  for (size_t i = 0; i < want.closest.size(); ++i)
    if (got.closest[i] != want.closest[i] || got.any[i] != want.any[i] || got.all[i] != want.all[i]) {
      const glm::dvec3 o = ray_origin(rays, static_cast<int>(i)), d = ray_direction(rays, static_cast<int>(i));
      ADD_FAILURE() << where << " ray " << i << ": closest " << got.closest[i] << " want " << want.closest[i] << ", any " << got.any[i] << " want "
                    << want.any[i] << ", all " << got.all[i].size() << " want " << want.all[i].size() << "; origin " << o.x << " " << o.y << " " << o.z
                    << " direction " << d.x << " " << d.y << " " << d.z;
      return;
    }
}

}  // namespace spanray
