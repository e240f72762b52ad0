// Packets of rays against spheres and planes: what first_hit() says of each primitive alone, bit by bit, on every instruction
// set, where plain doubles cannot tell: tangents, far away, from within, at the very start and end of a ray, at one distance.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "frame/exact_hit.h"
#include "ray/exact_set.h"
#include "support/every_isa.h"
#include "support/plane_scenes.h"
#include "support/ray_answers.h"

namespace spanray {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

struct Exact {
  std::unique_ptr<TestFrame> t;
  ExactSet set;
  uint32_t count;

  Exact(const std::vector<Sphere>& spheres, const std::vector<Plane>& planes)
      : count(static_cast<uint32_t>(spheres.size() + planes.size())) {
    SceneData scene = make_test_scene({});
    for (const Sphere& s : spheres) add_sphere(s, scene);
    for (const Plane& p : planes) add_plane(p, scene);
    t = make_test_frame(std::move(scene), Camera(), test_settings(16, 16));
    set = ExactSet(t->scene, t->material_flags.data(), 0, 0);
  }
  ExactRay ray(const RayBatch& rays, int i, double t_min = 0) const {
    ExactRay r;
    r.origin = ray_origin(rays, i), r.direction = ray_direction(rays, i), r.t_max = static_cast<double>(rays.t_max[i]);
    r.from = rays.from[i], r.t_min = t_min, r.front_only = t->frame.settings.culling == Culling::kBack;
    return r;
  }
};

// Of all primitives, one by one.
struct Met {
  uint32_t primitive = kNoPrimitive;
  double t = kInf;
};
Met ask_all(const Exact& e, const ExactRay& ray) {
  Met best;
  for (uint32_t p = 0; p < e.count; ++p)
    if (const double t = first_hit(ray, e.t->scene, p).t; t <= ray.t_max && t < best.t) best = {p, t};
  return best;
}

// Balls in and through each other, some twice; planes that touch, cut and lie far from them, one twice.
Exact crowded() {
  std::vector<Sphere> spheres = {ball({0, 0, 0}, 5),      ball({0, 0, 0}, 5),    ball({0, 0, 0}, 3),    ball({10, 0, 0}, 5),
                                 ball({0, 10, 0}, 5),     ball({3, 4, 0}, 0.25), ball({-7, 1, 2}, 1.5), ball({6, 8, 1}, 1),
                                 ball({-40, -40, 9}, 30), ball({0, 0, -12}, 4),  ball({9, 9, 9}, 0.1)};
  TestRandom random(11);
  for (int i = 0; i < 9; ++i) spheres.push_back(ball(random_point(random, 14), random.uniform(0.1, 2)));
  return Exact(spheres,
               {plane_at({5, 0, 0}, {1, 0, 0}), plane_at({0, -9, 0}, {0.1, 1, -0.2}), plane_at({0, -9, 0}, {0.1, 1, -0.2}),
                plane_at({3, 4, 0}, {3, 4, 0}), plane_at({0, 0, 40}, {0, 0, -1})});
}

// A ray to some place of a primitive: its middle, its surface, or a tangent; from anywhere, from within, from its surface.
void add_hard_ray(const Exact& e, TestRandom& random, RayBatch& rays) {
  const uint32_t p = static_cast<uint32_t>(random.below(static_cast<int>(e.count)));
  const bool is_sphere = e.t->scene.is_sphere(p);
  const glm::dvec3 middle = is_sphere ? center_of(e.t->scene.sphere(p)) : point_of(e.t->scene.plane(p));
  const double r = is_sphere ? static_cast<double>(e.t->scene.sphere(p).radius) : 6;
  const glm::dvec3 n = normalize3(random_point(random), glm::dvec3(1, 0, 0)), flat = cross3(n, random_point(random));
  glm::dvec3 o = random_point(random, 25), to = middle + random_point(random, r);
  switch (random.below(8)) {
    case 0:
      o = middle + n * r, to = o + flat;
      break;  // a tangent at its start, but for rounding
    case 1:
      o = middle + n * r - flat * random.uniform(1, 9), to = middle + n * r;
      break;
    case 2:
      o = middle + random_point(random, 0.7 * r);
      break;  // from within
    case 3:
      o = middle + n * r * (1 + random.uniform(-1e-6, 1e-6));
      break;  // from the surface
    case 4:
      o = glm::dvec3(3, 4, 0) - glm::dvec3(-4, 3, 0) * static_cast<double>(random.between(-3, 9)), to = {3, 4, 0};
      break;  // touches two
    case 5:
      o = {random.uniform(-9, 9), 5, 0}, to = {0, 5, 0};
      break;  // and so does this
    default:
      break;
  }
  glm::dvec3 d = (to - o) * std::ldexp(1.0, random.between(-30, 30));
  if (random.below(6) == 0) d[random.below(3)] = 0;
  add_ray(rays, o, d, std::numeric_limits<float>::infinity(), random.below(2) == 0 ? p : kNoPrimitive);
  if (random.below(3) == 0) return;
  // It ends where it meets something, or a little before or behind; or about the place nearest to the middle.
  const int i = rays.count - 1;
  const double met = random.below(4) == 0 ? dot3(middle - o, d) / dot3(d, d) : ask_all(e, e.ray(rays, i)).t;
  const float end = static_cast<float>(met),
              ends[] = {end, std::nextafterf(end, 0), std::nextafterf(end, 1e38f), 0.999f * end, 1.001f * end};
  rays.t_max[i] = ends[random.below(5)];
}

void expect_as_all(Exact& e, const RayBatch& rays) {
  const size_t n = static_cast<size_t>(rays.count);
  std::vector<Met> closest(n);
  std::vector<bool> any(n);
  for (int i = 0; i < rays.count; ++i) {
    ExactRay ray = e.ray(rays, i);
    closest[static_cast<size_t>(i)] = ask_all(e, ray);
    ray.front_only = false;
    any[static_cast<size_t>(i)] = ask_all(e, ray).primitive != kNoPrimitive;
  }
  on_every_isa([&](int isa) {
    e.t->frame.isa = static_cast<Isa>(isa + 1);
    std::vector<uint32_t> primitive(n, kNoPrimitive), bits(n / 32 + 1, 0);
    closest_exact(e.t->frame, e.set, rays, 0, primitive.data());
    any_exact(e.t->frame, e.set, rays, bits.data());
    for (size_t i = 0; i < n; ++i) {
      ASSERT_EQ(primitive[i], closest[i].primitive) << i;
      ASSERT_EQ((bits[i / 32] >> (i % 32) & 1u) != 0, any[i]) << i;
    }
  });
}

TEST(RayExact, HardRaysAsAskingEveryPrimitive) {
  Exact e = crowded();
  for (const Culling culling : {Culling::kNone, Culling::kBack}) {
    e.t->frame.settings.culling = culling;
    TestRandom random(12);
    RayBatch rays;
    for (int i = 0; i < 200000; ++i) add_hard_ray(e, random, rays);
    expect_as_all(e, rays);
  }
}

// From 2^24 radii away plain doubles cannot tell what hits from what misses.
TEST(RayExact, SpheresFromFarAway) {
  TestRandom random(13);
  std::vector<Sphere> spheres;
  for (int i = 0; i < 40; ++i)
    spheres.push_back(ball({random.uniform(-3, 3), random.uniform(-2, 2), random.uniform(-2, 2)}, 1));
  Exact e(spheres, {});
  RayBatch rays;
  int near_tangents = 0;
  for (int i = 0; i < 100000; ++i) {
    const Sphere& s = spheres[static_cast<size_t>(random.below(40))];
    const double away = std::ldexp(1.0, random.between(18, 27)), angle = random.uniform(0, 6.28);
    const double beside = 1 + std::ldexp(random.uniform(-1, 1), -random.between(0, 23));
    near_tangents += std::fabs(1 - beside) < 1e-4;
    add_ray(rays, center_of(s) + glm::dvec3(-away, beside * std::cos(angle), beside * std::sin(angle)), {1, 0, 0});
  }
  EXPECT_GT(near_tangents, 30000);
  expect_as_all(e, rays);
}

// By 2^-48 of the square of the radius outside of it, or on it: less than plain doubles are sure of.
TEST(RayExact, OriginsNearlyOnASphere) {
  TestRandom random(16);
  for (const double scale : {1.0, 0x1p-24}) {
    const double r = (0x1p24 - 1) * scale;
    Exact e({ball({0, 0, 0}, r), ball({0.5 * r, 0, 0}, 0.25 * r)}, {});
    RayBatch rays;
    for (int i = 0; i < 2000; ++i) {
      glm::dvec3 o(0);
      const int axis = random.below(3);
      o[axis] = random.below(2) == 0 ? r : -r, o[(axis + 1) % 3] = random.between(-1, 1) * scale;
      add_ray(rays, o, random_point(random), std::numeric_limits<float>::infinity(), random.below(3) == 0 ? kNoPrimitive : 0);
    }
    expect_as_all(e, rays);
  }
}

// A tree of many levels; batches whose last packet is not full; bits that are set already stay.
TEST(RayExact, ManySpheresAndAnswersOfTriangles) {
  TestRandom random(14);
  std::vector<Sphere> spheres;
  for (int i = 0; i < 1500; ++i) spheres.push_back(ball(random_point(random, 10), random.uniform(0.01, 0.6)));
  Exact e(spheres, {plane_at({0, -5, 0}, {0, 1, 0})});
  for (const int count : {1, 7, 33, 2000}) {
    RayBatch rays = crossing_rays(random, count, 10, glm::dvec3(0), e.count);
    expect_as_all(e, rays);
    std::vector<uint32_t> bits(static_cast<size_t>(count) / 32 + 1, 0), set(bits.size(), 0x55555555);
    any_exact(e.t->frame, e.set, rays, bits.data()), any_exact(e.t->frame, e.set, rays, set.data());
    for (size_t i = 0; i < bits.size(); ++i) EXPECT_EQ(set[i], bits[i] | 0x55555555) << i;
  }
}

// The bits of t: a hit counts beyond t_min, so one at its own t does not, and one at the double before it does.
void expect_bits_of_t(Exact& e, const RayBatch& rays, int least) {
  int met = 0;
  for (int i = 0; i < rays.count; ++i) {
    const Met first = ask_all(e, e.ray(rays, i));
    if (first.primitive == kNoPrimitive) continue;
    ++met;
    RayBatch one;
    add_ray(one, ray_origin(rays, i), ray_direction(rays, i), rays.t_max[i], rays.from[i]);
    for (const double t_min : {first.t, std::nextafter(first.t, 0.0), std::nextafter(first.t, kInf)}) {
      const uint32_t want = ask_all(e, e.ray(one, 0, t_min)).primitive;
      on_every_isa([&](int isa) {
        e.t->frame.isa = static_cast<Isa>(isa + 1);
        uint32_t got = kNoPrimitive;
        closest_exact(e.t->frame, e.set, one, t_min, &got);
        ASSERT_EQ(got, want) << i << " beyond " << t_min;
      });
    }
  }
  EXPECT_GT(met, least);
}

TEST(RayExact, TheBitsOfT) {
  Exact e = crowded();
  TestRandom random(15);
  RayBatch rays;
  for (int i = 0; i < 4000; ++i) add_hard_ray(e, random, rays);
  expect_bits_of_t(e, rays, 2000);
}

// Their places differ from the origin by more digits than a double has; behind 1e30 they end.
TEST(RayExact, PlanesFromFarAway) {
  TestRandom random(17);
  for (int i = 0; i < 60; ++i) {
    const glm::dvec3 n = random_point(random);
    Exact e({}, {plane_at(n * std::ldexp(1.0, random.between(-20, 102)), n), plane_at(random_point(random), n)});
    RayBatch rays;
    for (int k = 0; k < 60; ++k)
      add_ray(rays, random_point(random) * std::ldexp(1.0, -random.between(0, 40)),
              random_point(random) * std::ldexp(1.0, random.between(-20, 20)), std::numeric_limits<float>::infinity(),
              random.below(4) == 0 ? 0 : kNoPrimitive);
    expect_as_all(e, rays);
    expect_bits_of_t(e, rays, 10);
  }
}

// What is left of the height when its largest parts cancel: plain doubles get its sign wrong.
TEST(RayExact, PlanesThroughFarPoints) {
  TestRandom random(18);
  for (int exponent = 40; exponent < 99; ++exponent) {
    const double far = std::ldexp(1.0, exponent);
    Exact e({}, {plane_at({far, -far, 0}, {1, 1, 1})});
    RayBatch rays;
    for (int k = 0; k < 200; ++k) add_ray(rays, random_point(random, 4), random_point(random));
    expect_as_all(e, rays);
  }
}

}  // namespace
}  // namespace spanray
