// Parts of triangles: every ray that hits a triangle meets one of its parts' boxes, before or where it hits, however it was rounded.
#include "ray/bvh_presplit.h"

#include <gtest/gtest.h>

#include "ray/bvh_parts.h"
#include "support/awkward_rays.h"

namespace spanray {
namespace {

using bvh::Box;
using bvh::Ref;

struct Parts {
  SceneData scene;
  std::vector<Box> box;  // of the first triangle's
};

// One triangle among enough small ones that share their splits with it.
Parts split_one(const SoupTriangle& triangle, TestRandom& random) {
  std::vector<SoupTriangle> soup = {triangle};
  for (int i = 0; i < 400; ++i) {
    const glm::dvec3 p = random_point(random, 4);
    soup.push_back(soup_triangle(p, p + glm::dvec3(0.01, 0, 0), p + glm::dvec3(0, 0.01, 0)));
  }
  Parts parts{make_test_scene(soup), {}};
  AlignedBuffer<Ref> refs(soup.size());
  Box all = Box::empty();
  for (uint32_t i = 0; i < refs.size(); ++i) {
    refs[i].box = bvh::triangle_box(parts.scene, parts.scene.triangles[i]);
    all.add(refs[i].box);
    refs[i].set_primitive(i);
  }
  Parallel parallel(1);
  const AlignedBuffer<Ref> split = bvh::presplit(parts.scene, refs, all, parallel);
  for (const Ref& ref : split)
    if (ref.primitive() == 0) parts.box.push_back(ref.box);
  return parts;
}

// Where slab() has the ray enter a box; infinite if it misses.
double enters(const TraceRay& ray, const Box& box) {
  float near = 0, far = kLargestT;
  for (int k = 0; k < 3; ++k) slab(ray, k, box.lo[k], box.hi[k], near, far);
  return near <= far ? static_cast<double>(near) : INFINITY;
}

// How far a ray leaves the plane that it should lie in: not at all, by the last bits of a double, by those of a float, visibly.
double off_plane(TestRandom& random) {
  return random.below(5) == 0 ? 0 : std::ldexp(random.uniform(-1, 1), -4 - random.below(56));
}

// In and beside the plane of a triangle, along its edges and not, from near and far, through it and past it.
struct RayThrough { glm::dvec3 origin, direction; };
RayThrough awkward_ray(TestRandom& random, const glm::dvec3 (&corner)[3], bool on_grid) {
  const auto in_plane = [&](double reach) {
    double b[2];
    for (double& x : b) x = on_grid ? random.between(-4, 8) * 0.25 : random.uniform(-reach, 1 + reach);
    return corner[0] + (corner[1] - corner[0]) * b[0] + (corner[2] - corner[0]) * b[1];
  };
  const int kind = random.below(4), i = random.below(3);
  const glm::dvec3 edge = corner[(i + 1) % 3] - corner[i];
  glm::dvec3 origin = in_plane(random.below(2) == 0 ? 1 : 100), direction = in_plane(0.2) - origin;
  if (kind == 0) direction = edge;
  if (kind == 1) origin = corner[i] - edge * random.uniform(0, 3), direction = edge;
  if (kind == 2) direction = in_plane(0) - (origin = random_point(random, random.below(4) == 0 ? 1e4 : 5));
  for (int k = 0; k < 3; ++k) origin[k] += off_plane(random), direction[k] += off_plane(random);
  if (random.below(4) == 0) direction[random.below(3)] = 0;
  return {origin, direction};
}

TEST(RayPresplit, EveryHitIsInsideAPart) {
  TestRandom random(51);
  int hits = 0, thin = 0, parts_seen = 0;
  for (int n = 0; n < 400; ++n) {
    const bool on_grid = n % 2 == 0;
    glm::dvec3 p[3];
    for (int v = 0; v < 2; ++v)
      for (int k = 0; k < 3; ++k) p[v][k] = on_grid ? random.between(-8, 8) * 0.5 : random.uniform(-4, 4);
    for (int k = 0; k < 3; ++k) p[2][k] = p[1][k] + (on_grid ? random.between(-1, 1) * 0.125 : random.uniform(-0.1, 0.1));
    const Parts parts = split_one(soup_triangle(p[0], p[1], p[2]), random);
    if (parts.box.size() < 4) continue;
    parts_seen += static_cast<int>(parts.box.size());
    glm::dvec3 corner[3];
    float v[9];
    for (int c = 0; c < 3; ++c) {
      corner[c] = scene_vertex(parts.scene, 0, c);
      for (int k = 0; k < 3; ++k) v[3 * c + k] = static_cast<float>(corner[c][k]);
    }
    for (int i = 0; i < 3000; ++i) {
      const RayThrough r = awkward_ray(random, corner, on_grid);
      float origin[3], direction[3];
      for (int k = 0; k < 3; ++k)
        origin[k] = static_cast<float>(r.origin[k]), direction[k] = static_cast<float>(r.direction[k]);
      TraceRay ray;
      double t;
      if (!prepare_ray(origin, direction, kInfinity, ray) || !hit_triangle(ray, TriangleView{v, 3, 1}, t)) continue;
      ++hits;
      const SeenTriangle seen(ray, TriangleView{v, 3, 1});
      double s = 0;
      for (int c = 0; c < 3; ++c) s = std::max({s, std::fabs(seen.x[c]), std::fabs(seen.y[c])});
      thin += !(std::fabs(seen.u + seen.v + seen.w) > kEdgeOn * s * s);
      double first = INFINITY;
      for (const Box& box : parts.box) first = std::min(first, enters(ray, box));
      ASSERT_LE(first, t) << "triangle " << n << " ray " << i;
    }
  }
  EXPECT_GT(parts_seen, 2000);
  EXPECT_GT(hits, 50000);
  EXPECT_GT(thin, 500) << "too few triangles were seen edge-on to prove anything";
}

}  // namespace
}  // namespace spanray
