// A tree with two levels answers as one tree over all triangles does, and as no tree at all.
#include "ray/bvh_instances.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/common.hpp>

#include "core/hash.h"
#include "support/ray_answers.h"
#include "support/scattered_instances.h"

namespace spanray {
namespace {

// Exactly through corners, middles and inner points of edges and through inner points of random triangles, from near and far, in their planes and not, some
// along axes, some that end at about the hit.
RayBatch rays_at_triangles(const SceneData& scene, TestRandom& random, int n) {
  RayBatch rays = make_rays(n);
  for (int i = 0; i < n; ++i) {
    const uint32_t p = static_cast<uint32_t>(random.below(static_cast<int>(scene.triangles.size())));
    glm::dvec3 v[3];
    for (int c = 0; c < 3; ++c) v[c] = scene_vertex(scene, p, (c + i) % 3);
    const double size = std::max({length3(v[1] - v[0]), length3(v[2] - v[0]), 1e-30});
    glm::dvec3 at = v[0];
    if (i % 4 == 1) at = (v[0] + v[1]) * 0.5;
    if (i % 4 == 2) at = v[0] + (v[1] - v[0]) * random.uniform(0, 1);
    if (i % 4 == 3) at = v[0] + (v[1] - v[0]) * random.uniform(0, 0.5) + (v[2] - v[0]) * random.uniform(0, 0.5);
    const double far = size * std::ldexp(1.0, random.between(-2, i % 7 == 1 ? 60 : 12));  // along an axis, rays hit from anywhere
    glm::dvec3 d = random_point(random, far);
    if (i % 7 == 0) d = (v[1] - v[0]) * random.uniform(-3, 3) + (v[2] - v[0]) * random.uniform(-3, 3);  // in its plane
    if (i % 7 == 1) d = {0, 0, 0}, d[random.below(3)] = i % 2 == 0 ? far : -far;
    if (i % 7 == 2) d = v[1] - v[0];
    const glm::dvec3 origin = at - d;
    set_ray(rays, i, origin, d, i % 5 == 0 ? static_cast<float>(random.uniform(0.9, 1.1)) : kInfinity);
  }
  return rays;
}

void expect_as_flat(TestFrame& t, const Bvh& two, const Bvh& flat, const RayBatch& rays, const char* where) {
  const Answers want = brute_force(t, rays);
  EXPECT_GT(std::count(want.any.begin(), want.any.end(), true), rays.count / 4) << where;
  for (const Isa isa : supported_isas()) {
    expect_equal(trace(t, flat, rays, isa), want, rays, std::string(where) + " flat");
    expect_equal(trace(t, two, rays, isa), want, rays, std::string(where) + " " + std::string(isa_name(isa)));
  }
}

TEST(RayInstance, AnswersAreThoseOfTheFlatTreeAndOfNoTree) {
  TestRandom random(71);
  for (int kind = 0; kind < 4; ++kind) {
    auto t = scattered(random, 14, [&](int i, glm::dvec3& scale, glm::dvec3& offset) {
      offset = random_point(random, 3);
      if (kind == 1) scale = glm::dvec3(i % 3 == 0 ? -1 : 0.7);
      if (kind == 2) scale = {random.uniform(0.5, 1), i % 2 == 0 ? 1.3 : -1.3, random.uniform(0.6, 1.2)};
      if (kind == 3) scale = glm::dvec3(std::ldexp(1.0, random.between(-6, 2)));
    });
    for (const TreeQuality quality : {TreeQuality::kFast, TreeQuality::kHigh}) {
      const Bvh two = build(*t, InstanceUse::kAlways, quality), flat = build(*t, InstanceUse::kNever, quality);
      EXPECT_EQ(places(two), 14u);
      EXPECT_EQ(places(flat), 0u);
      EXPECT_EQ(two.primitive_count(), t->scene.triangles.size());
      expect_as_flat(*t, two, flat, rays_at_triangles(t->scene, random, 3000), "at triangles");
      expect_as_flat(*t, two, flat, random_rays(random, 1000), "random");
    }
  }
}

TEST(RayInstance, AnswersAreThoseOfTheFlatTreeForAllSizesAndPlaces) {
  TestRandom random(72);
  size_t used = 0, all = 0;
  for (int n = 0; n < 24; ++n) {
    const int exponent = n < 2 ? (n == 0 ? -20 : 20) : random.between(-20, 20);
    const double size = std::ldexp(1.0, exponent);
    auto t = scattered(random, 4, [&](int i, glm::dvec3& scale, glm::dvec3& offset) {
      scale = glm::dvec3(size * random.uniform(0.7, 1), size, i % 2 == 0 ? size : -size * 0.8);
      offset = random_point(random, size * std::ldexp(1.0, random.between(0, n < 12 ? 10 : 20)));
    });
    const Bvh two = build(*t, InstanceUse::kAlways), flat = build(*t, InstanceUse::kNever);
    used += places(two), all += 4;
    EXPECT_EQ(two.primitive_count(), t->scene.triangles.size());
    expect_as_flat(*t, two, flat, rays_at_triangles(t->scene, random, 2000), "sizes");
  }
  EXPECT_GT(used, all / 2);
}

// A place may be far from where its part is, and the part far from its own origin.
TEST(RayInstance, PartsFarFromTheirOwnOrigin) {
  TestRandom random(73);
  for (int n = 0; n < 10; ++n) {
    const glm::dvec3 away = random_point(random, std::ldexp(1.0, 2 + n));
    std::vector<SoupTriangle> part;
    add_mesh(part, make_sphere(2), 1, away);
    InstanceScene s;
    s.add_part(mess(random, 10));
    s.add_part(part);
    for (int i = 0; i < 4; ++i) s.place(1, random_map(random, glm::dvec3(i % 2 == 0 ? 1 : -0.5), random_point(random, i < 2 ? 1 : length3(away))));
    auto t = frame_of_scene(s.build());
    const Bvh two = build(*t, InstanceUse::kAlways), flat = build(*t, InstanceUse::kNever);
    EXPECT_EQ(places(two), 4u) << n;
    expect_as_flat(*t, two, flat, rays_at_triangles(t->scene, random, 2000), "far parts");
  }
}

TEST(RayInstance, TiesGoToTheLowestIdAmongInstancesAtOnePlace) {
  TestRandom random(74);
  InstanceScene s;
  s.add_part(ball(1));
  s.add_part(ball(1));
  s.add_part(mess(random, 30));
  AffineMap turned = random_map(random, glm::dvec3(1.5), glm::dvec3(0.3, 0, 0));
  for (int i = 0; i < 6; ++i) s.place(1, i % 3 == 0 ? AffineMap() : turned);  // part 1 without a map is where part 0 stands
  s.place(2, turned), s.place(2, turned);
  auto t = frame_of_scene(s.build());
  const Bvh two = build(*t, InstanceUse::kAlways), flat = build(*t, InstanceUse::kNever);
  EXPECT_EQ(places(two), 8u);
  expect_as_flat(*t, two, flat, rays_at_triangles(t->scene, random, 4000), "coincident");
}

// From within closed meshes through their corners and along their edges, each mesh is left once.
TEST(RayInstance, NothingLeaksThroughEdgesAndCorners) {
  TestRandom random(75);
  InstanceScene s;
  s.add_part({});
  s.add_part(ball(3));
  const double sizes[] = {1, 0x1p-20, 0x1p20, 3.7, 0.01};
  for (const double size : sizes) s.place(1, random_map(random, glm::dvec3(size, size * 0.9, -size), random_point(random, size * 30)));
  auto t = frame_of_scene(s.build());
  const Bvh two = build(*t, InstanceUse::kAlways);
  EXPECT_EQ(places(two), 5u);
  for (size_t which = 0; which < 5; ++which) {
    const Instance& instance = t->scene.instances[which];
    RayBatch rays = make_rays(6 * static_cast<int>(instance.count));
    const glm::dvec3 center(instance.world_from_part.offset[0], instance.world_from_part.offset[1], instance.world_from_part.offset[2]);
    for (int i = 0; i < rays.count; ++i) {
      const uint32_t p = instance.first + static_cast<uint32_t>(i / 6);
      const glm::dvec3 a = scene_vertex(t->scene, p, i % 3), b = scene_vertex(t->scene, p, (i + 1) % 3);
      const glm::dvec3 at = i % 6 < 3 ? a : a + (b - a) * random.uniform(0, 1);
      set_ray(rays, i, center, at - center);
    }
    for (const Isa isa : supported_isas()) {
      t->frame.isa = isa;
      FragmentList list;
      trace_all(t->frame, two, rays, HitsOnEdges::kOfOne, list);
      std::vector<int> own(static_cast<size_t>(rays.count), 0);
      for (size_t i = 0; i < list.ray.size(); ++i) own[list.ray[i]] += list.primitive[i] >= instance.first && list.primitive[i] < instance.first + instance.count;
      for (size_t i = 0; i < own.size(); ++i) ASSERT_EQ(own[i], 1) << isa_name(isa) << " sphere " << which << " ray " << i;
    }
  }
}

TEST(RayInstance, MasksCullingAndTheTriangleThatARayLeaves) {
  TestRandom random(76);
  InstanceScene s;
  std::vector<SoupTriangle> part = ball(2);
  for (SoupTriangle& triangle : part) triangle.material = random.below(2) == 0;
  s.add_part(mess(random, 30)), s.add_part(part);
  for (int i = 0; i < 9; ++i) s.place(1, random_map(random, glm::dvec3(i % 2 == 0 ? 1 : -1), random_point(random, 2)));
  std::vector<Material> materials(2);
  materials[1].transparency = static_cast<int32_t>(MaterialTransparency::kMask);
  materials[1].opacity = 0.5f;
  auto t = frame_of_scene(s.build(materials));
  t->frame.accept_rays = accept_every_other;
  t->frame.settings.culling = Culling::kBack;
  const Bvh two = build(*t, InstanceUse::kAlways), flat = build(*t, InstanceUse::kNever);
  ASSERT_EQ(places(two), 9u);
  RayBatch rays = rays_at_triangles(t->scene, random, 4000);
  for (const bool leaving : {false, true}) {
    rays.from.clear();
    if (leaving)
      for (int i = 0; i < rays.count; ++i) rays.from.push_back(brute_force_closest(t->scene, rays, i));
    for (const Isa isa : supported_isas()) expect_equal(trace(*t, two, rays, isa), trace(*t, flat, rays, isa), rays, isa_name(isa));
  }
  // Opaque and other triangles each have a tree; instances stand in both.
  std::vector<uint32_t> flags = {0, kMaterialTranslucent};
  for (const uint32_t value : {0u, uint32_t{kMaterialTranslucent}}) {
    const auto tree = [&](InstanceUse use) { return build_bvh(t->scene, flags.data(), kMaterialTranslucent, value, *t->parallel, TreeQuality::kFast, false, use); };
    const Bvh some = tree(InstanceUse::kAlways), some_flat = tree(InstanceUse::kNever);
    EXPECT_EQ(places(some), 9u);
    EXPECT_EQ(some.primitive_count(), some_flat.primitive_count());
    rays.from.clear();
    for (const Isa isa : supported_isas()) expect_equal(trace(*t, some, rays, isa), trace(*t, some_flat, rays, isa), rays, isa_name(isa));
  }
}

TEST(RayInstance, RaysThatAreNoneAndScenesOfInstancesOnly) {
  TestRandom random(77);
  InstanceScene s;
  s.add_part({});
  s.add_part({bad_ray_target(), soup_triangle({-9, -9, 50}, {-9, -8, 50}, {-8, -9, 50})});
  s.place(1, AffineMap());
  auto t = frame_of_scene(s.build());
  const Bvh two = build(*t, InstanceUse::kAlways);
  ASSERT_EQ(places(two), 1u);
  const std::vector<RayCase> cases = bad_rays();
  const RayBatch rays = batch_of(cases);
  for (const Isa isa : supported_isas()) {
    const Answers got = trace(*t, two, rays, isa);
    for (size_t i = 0; i < cases.size(); ++i) {
      EXPECT_EQ(got.any[i], cases[i].hit) << isa_name(isa) << " ray " << i;
      EXPECT_EQ(got.closest[i], cases[i].hit ? 0 : kNoPrimitive) << isa_name(isa) << " ray " << i;
    }
  }
}

// What the tree promises of boxes (ray/bvh_instances.h): points as far beside a triangle of the scene as a hit may be are inside the
// box of its leaf, as rays see it.
TEST(RayInstance, BoxesHoldWhatRaysMayHit) {
  TestRandom random(79);
  for (int n = 0; n < 6; ++n) {
    auto t = scattered(random, 8, [&](int i, glm::dvec3& scale, glm::dvec3& offset) {
      offset = random_point(random, std::ldexp(1.0, 2 * n));
      scale = {random.uniform(0.4, 1), 1, i % 2 == 0 ? -1 : 0.6};
    });
    const Bvh two = build(*t, InstanceUse::kAlways);
    const InstanceTrees& trees = *two.data().instances;
    size_t checked = 0;
    for (const PlacedPart& place : trees.placed) {
      for (const BvhNode& node : trees.parts[place.part])
        for (int c = 0; c < kBvhWidth; ++c) {
          if (!(node.bounds[0][c] <= node.bounds[3][c]) || (node.child[c] & kLeafBit) == 0) continue;
          {
            const uint32_t p = place.first + (node.child[c] & ~kLeafBit);
            glm::dvec3 lo(INFINITY), hi(-INFINITY);
            for (int v = 0; v < 3; ++v) lo = glm::min(lo, scene_vertex(t->scene, p, v)), hi = glm::max(hi, scene_vertex(t->scene, p, v));
            const double beside = 0x1p-11 * std::max({hi.x - lo.x, hi.y - lo.y, hi.z - lo.z});
            for (int s = 0; s < 24; ++s) {
              const glm::dvec3 off((s & 1) != 0 ? beside : -beside, (s & 2) != 0 ? beside : -beside, (s & 4) != 0 ? beside : -beside);
              const glm::dvec3 q = scene_vertex(t->scene, p, s / 8) + off;
              for (int k = 0; k < 3; ++k) {
                long double in_part = 0;
                for (int j = 0; j < 3; ++j)
                  in_part += static_cast<long double>(place.part_from_world[k][j]) * (static_cast<long double>(q[j]) - static_cast<long double>(place.offset[j]));
                ASSERT_GE(in_part, static_cast<long double>(node.bounds[k][c]) - static_cast<long double>(place.slack[k])) << n << " triangle " << p;
                ASSERT_LE(in_part, static_cast<long double>(node.bounds[k + 3][c]) + static_cast<long double>(place.slack[k])) << n << " triangle " << p;
              }
            }
            ++checked;
          }
        }
    }
    EXPECT_EQ(checked, trees.triangles);
  }
}

uint64_t hash_of(const InstanceTrees& trees) {
  Hash hash;
  const auto add = [&](const AlignedBuffer<BvhNode>& nodes) {
    for (const BvhNode& n : nodes) hash.add(n.bounds, sizeof n.bounds).add(n.child, sizeof n.child);
  };
  add(trees.top);
  for (const SingleTree& part : trees.parts) add(part);
  for (const PlacedPart& p : trees.placed)
    hash.add(p.part_from_world, sizeof p.part_from_world).add(p.slack, sizeof p.slack).add(p.slack_of_origin, sizeof p.slack_of_origin).add_word(p.first).add_word(p.part);
  return hash.value();
}

TEST(RayInstance, TheBytesDoNotDependOnThreads) {
  TestRandom random(78);
  InstanceScene s;
  s.add_part(ball(1)), s.add_part(ball(5)), s.add_part(mess(random, 3000));
  for (int i = 0; i < 500; ++i) s.place(static_cast<size_t>(1 + i % 2), random_map(random, glm::dvec3(0.3), random_point(random, 10)));
  auto t = frame_of_scene(s.build());
  for (const TreeQuality quality : {TreeQuality::kFast, TreeQuality::kHigh}) {
    uint64_t first = 0;
    for (const int threads : {1, 2, 7}) {
      Parallel parallel(threads);
      const Bvh bvh = build_bvh(t->scene, t->material_flags.data(), 0, 0, parallel, quality);
      ASSERT_EQ(places(bvh), 500u) << "worth it by any measure";
      if (first == 0) first = hash_of(*bvh.data().instances);
      EXPECT_EQ(hash_of(*bvh.data().instances), first) << threads;
    }
  }
}

}  // namespace
}  // namespace spanray
