// Rays against closed meshes, at all scales and distances; rays that leave surfaces (Y1, Y2, Y3, Y6, Y7, Y10).
#include <algorithm>
#include <cmath>

#include "cases.h"
#include "ray/bvh.h"
#include "ray_cases.h"
#include "shade/light.h"
#include "support/awkward_rays.h"
#include "support/surface_scenes.h"

namespace spanray::hard {

Bvh build_all(const TestFrame& t) { return build_bvh(t.scene, t.material_flags.data(), 0, 0, *t.parallel); }

std::unique_ptr<TestFrame> mesh_frame(const IndexedMesh& mesh, double scale, const glm::dvec3& move) {
  std::vector<SoupTriangle> soup;
  add_mesh(soup, mesh, scale, move);
  return make_test_frame(make_test_scene(soup), Camera(), test_settings(16, 16));
}

RayBatch rays_inside(const TestFrame& frame, Aim aim, int n, uint32_t seed, double scale, const glm::dvec3& center) {
  TestRandom random(seed);
  RayBatch rays = make_rays(n);
  for (int i = 0; i < n; ++i) {
    const uint32_t p = static_cast<uint32_t>(random.below(static_cast<int>(frame.scene.triangles.size())));
    const int v = random.below(3);
    const glm::dvec3 a = scene_vertex(frame.scene, p, v), b = scene_vertex(frame.scene, p, (v + 1) % 3),
                     c = scene_vertex(frame.scene, p, (v + 2) % 3);
    glm::dvec3 target = a;
    if (aim == Aim::kEdge) target = a + (b - a) * (i % 4 < 2 ? 0.5 : random.uniform());
    if (aim == Aim::kInterior) target = (a + b + c) / 3.0;
    glm::dvec3 origin = i % 2 == 0 ? center : center + random_point(random, 0.28 * scale);
    for (int k = 0; k < 3; ++k) origin[k] = static_cast<float>(origin[k]);
    set_ray(rays, i, origin, target - origin);
  }
  return rays;
}

void check_hits(TestFrame& t, const Bvh& bvh, const RayBatch& rays, Isa isa, Tally& tally) {
  t.frame.isa = isa;
  std::vector<uint32_t> closest(static_cast<size_t>(rays.count)), any(static_cast<size_t>(rays.count) / 32 + 1);
  trace_closest(t.frame, bvh, rays, closest.data());
  trace_any(t.frame, bvh, rays, any.data());
  for (size_t r = 0; r < static_cast<size_t>(rays.count); ++r)
    tally.check(closest[r] != kNoPrimitive && (any[r / 32] >> (r % 32) & 1) != 0);
}

glm::dvec3 normal_at(const SurfaceBatch& s, uint32_t i) {
  return {s.geometric_normal[0][i], s.geometric_normal[1][i], s.geometric_normal[2][i]};
}

void light_from(SceneData& scene, const glm::dvec3& toward) {
  const glm::dvec3 unit = normalize3(toward, glm::dvec3(0, 1, 0));
  Light light;
  light.kind = static_cast<int32_t>(LightKind::kDirectional);
  for (int k = 0; k < 3; ++k) light.direction[k] = static_cast<float>(-unit[k]);
  scene.lights = {light};
}

Finding y1_watertight(const Effort& effort) {
  auto t = mesh_frame(make_sphere(4), 1, glm::dvec3(0));
  const Bvh bvh = build_all(*t);
  Tally rays;
  for (const Isa isa : supported_isas())
    for (const Aim aim : kAims)
      check_hits(*t, bvh, rays_inside(*t, aim, effort.count(isa, 1000000, 340000), 11, 1, glm::dvec3(0)), isa, rays);
  return none_wrong(rays, "rays", 1000000, "a third each at vertices, edges, interiors");
}

// Identical hits at powers of two, no miss from inside a sphere at decimal scales.
Finding y2_scales(const Effort& effort) {
  const IndexedMesh mesh = make_sphere(3);
  const int count = effort.count(20000, 3000);
  Tally rays;
  for (const Isa isa : supported_isas()) {
    std::vector<uint32_t> first;
    for (int e = -20; e <= 20; e += effort.count(1, 4)) {
      const double scale = std::ldexp(1.0, e);
      auto t = mesh_frame(mesh, scale, glm::dvec3(0));
      t->frame.isa = isa;
      const Bvh bvh = build_all(*t);
      TestRandom random(5);
      RayBatch batch = make_rays(count);
      for (int i = 0; i < count; ++i) {
        const glm::dvec3 origin = glm::dvec3(glm::vec3(random_point(random, 1.5))), direction = random_point(random, 1);
        const double along = i % 2 == 0 ? scale : 1.0;  // then t stays, otherwise t scales
        set_ray(batch, i, origin * scale, direction * along, static_cast<float>(2 * scale / along));
      }
      std::vector<uint32_t> hits(static_cast<size_t>(count));
      trace_closest(t->frame, bvh, batch, hits.data());
      if (first.empty()) first = hits;
      for (size_t i = 0; i < hits.size(); ++i) rays.check(hits[i] == first[i]);
    }
    const auto hit = std::count_if(first.begin(), first.end(), [](uint32_t p) { return p != kNoPrimitive; });
    if (hit < count / 4) rays.check(false, [] { return std::string("hardly a ray hit"); });
  }
  for (const double scale : {1e-12, 1e-6, 1e-3, 0.1, 3.3, 1e2, 1e5, 1e9, 1e20, 1e30}) {
    auto t = mesh_frame(mesh, scale, glm::dvec3(0));
    const Bvh bvh = build_all(*t);
    for (const Isa isa : supported_isas())
      for (const Aim aim : kAims)
        check_hits(*t, bvh, rays_inside(*t, aim, effort.count(isa, 20000, 5000), 12, scale, glm::dvec3(0)), isa, rays);
  }
  return none_wrong(rays, "rays", 100000, "2^-20 to 2^20, 1e-12 to 1e30");
}

Finding y3_far_away(const Effort& effort) {
  const IndexedMesh mesh = make_sphere(3);
  Tally rays;
  for (const double distance : {1e3, 1e4, 1e5, 1e6}) {
    const glm::dvec3 center = glm::dvec3(glm::vec3(distance, -0.7 * distance, 0.4 * distance));
    auto t = mesh_frame(mesh, 1, center);
    const Bvh bvh = build_all(*t);
    for (const Isa isa : supported_isas())
      for (const Aim aim : kAims) check_hits(*t, bvh, rays_inside(*t, aim, effort.count(isa, 40000, 8000), 13, 1, center), isa, rays);
  }
  return none_wrong(rays, "rays", 50000);
}

// One axis-aligned quad in each plane; rays across it, along the axis, and along its diagonal.
Finding y6_flat_boxes(const Effort& effort) {
  Tally hits;
  for (int axis = 0; axis < 3; ++axis)
    for (const double at : {0.0, 1.0, -3.7, 1e5}) {
      const auto point = [&](double a, double b) {
        glm::dvec3 p;
        p[axis] = at, p[(axis + 1) % 3] = a, p[(axis + 2) % 3] = b;
        return p;
      };
      auto t = make_test_frame(make_test_scene({soup_triangle(point(-1, -1), point(1, -1), point(1, 1)),
                                                soup_triangle(point(-1, -1), point(1, 1), point(-1, 1))}),
                               Camera(), test_settings(16, 16));
      const Bvh bvh = build_all(*t);
      const int count = effort.count(20000, 2000);
      TestRandom random(3);
      RayBatch rays = make_rays(count);
      for (int i = 0; i < count; ++i) {
        const glm::dvec3 inner = random_point(random, 0.98), target = point(inner.x, inner.y);
        glm::dvec3 direction = random_point(random, 0.4);
        if (i % 3 == 0) direction = glm::dvec3(0);
        direction[axis] = i % 2 != 0 ? 1 : -1;
        set_ray(rays, i, (i == 0 ? point(0, 0) : target) - direction * (i == 0 ? 1.0 : 0.01), direction);
      }
      for (const Isa isa : supported_isas()) check_hits(*t, bvh, rays, isa, hits);
    }
  return none_wrong(hits, "rays", 20000);
}

// The renderer's shadow rays from surfaces to its first light, on every instruction set: answer(hit, own) of each, the primitive that it meets
// and the one that it leaves. Returns how many.
template <class Answer>
static uint64_t for_shadow_rays(TestFrame& t, const Bvh& bvh, const SurfaceBatch& surfaces, const Answer& answer) {
  uint64_t count = 0;
  for (const Isa isa : supported_isas()) {
    t.frame.isa = isa;
    RayBatch batch;
    AlignedBuffer<uint32_t> of;
    make_shadow_rays(t.frame, surfaces, 0, batch, of);
    batch.from.clear();  // where they start must do by itself
    std::vector<uint32_t> closest(static_cast<size_t>(batch.count));
    trace_closest(t.frame, bvh, batch, closest.data());
    for (size_t i = 0; i < closest.size(); ++i) answer(closest[i], surfaces.primitive[of[i]]);
    count += closest.size();
  }
  return count;
}

// Shadow rays of the renderer itself from points of a sphere, lights down to 1e-7 above the horizon of the triangle that they leave.
static void check_self_hits(const Effort& effort, double scale, Tally& rays) {
  Camera camera;
  for (int k = 0; k < 3; ++k) camera.eye[k] = scale * (k == 0 ? 1.1 : k == 1 ? 0.7 : 3.0);
  camera.near_plane = 1e-3 * scale;
  std::vector<SoupTriangle> soup;
  add_mesh(soup, make_sphere(3), scale, glm::dvec3(0));
  auto t = full_frame(make_test_scene(soup), camera, 512, 512);
  const Bvh bvh = build_all(*t);
  TestRandom random(31);
  HitBatch hits;
  while (hits.count < effort.count(4000, 1000)) {
    const uint32_t p = static_cast<uint32_t>(random.below(static_cast<int>(soup.size())));
    uint32_t pixel = 0;
    if (facing(t->scene, t->scene.triangles[p], t->frame.primary.eye) > 0 &&
        pixel_of(t->frame, point_on(t->scene, p, random), &pixel))
      add_hit(hits, pixel, 0, p);
  }
  SurfaceBatch surfaces;
  resolve_surfaces(t->frame, hits, surfaces);
  for (int n = 0; n < effort.count(40, 10); ++n) {  // a light that grazes one of the surfaces, and meets the others at all angles
    const int victim = random.below(hits.count);
    const glm::dvec3 normal = normal_at(surfaces, static_cast<uint32_t>(victim));
    const glm::dvec3 side = normalize3(cross3(normal, random_point(random)), glm::dvec3(1, 0, 0));
    light_from(t->scene, side + normal * std::pow(10.0, -random.uniform(0, 7)));
    for_shadow_rays(*t, bvh, surfaces, [&](uint32_t hit, uint32_t own) {
      rays.check(hit != own, [&] { return "self-hit at scale " + short_text(scale); });
    });
  }
}

// A floor, over it at 1e-4 and 2e-4 of the scale a small and a huge blocker, lights up to 1000 heights to the side: each ray
// must end at its blocker. The points on the floor are hits of rays that start beneath the blockers.
static void check_blockers(const Effort& effort, double s, Tally& rays) {
  const double h = 1e-4 * s;
  auto t = full_frame(make_test_scene({soup_triangle({-s, 0, -s}, {-s, 0, 3 * s}, {3 * s, 0, -s}),
                                       soup_triangle({-0.1 * s, h, -0.1 * s}, {0.3 * s, h, -0.1 * s}, {-0.1 * s, h, 0.3 * s}),
                                       soup_triangle({-1e3 * s, 2 * h, -1e3 * s}, {3e3 * s, 2 * h, -1e3 * s}, {-1e3 * s, 2 * h, 3e3 * s})}),
                      Camera(), 16, 16);
  const Bvh bvh = build_all(*t);
  TestRandom random(32);
  for (int n = 0; n < effort.count(100, 20); ++n) {
    const bool small = n % 2 == 0;
    const double tilt = small ? 10 : 1000;  // by height: stays under the small one, goes past it under the huge one
    light_from(t->scene, {random.uniform(0, tilt), 1, small ? random.uniform(-tilt, tilt) : 0});
    RayBatch down;
    HitBatch hits;
    hits.rays = &down;
    for (int i = 0; i < 100; ++i) {
      const glm::dvec3 p = random_point(random, small ? 0.05 * s : 0.5 * s);
      add_hit(hits, 0, static_cast<uint32_t>(add_ray(down, {small ? p.x : 0.6 * s, h / 2, p.z}, {0, -1, 0})), 0);
    }
    SurfaceBatch surfaces;
    resolve_surfaces(t->frame, hits, surfaces);
    const uint64_t answers = for_shadow_rays(*t, bvh, surfaces, [&](uint32_t hit, uint32_t) {
      rays.check(hit == (small ? 1u : 2u), [&] { return "missed blocker at scale " + short_text(s); });
    });
    rays.check(answers == 100 * supported_isas().size());
  }
}

Finding y7_leaving_surfaces(const Effort& effort) {
  Tally rays, blocked;
  for (double scale = 1e-3; scale < 2e6; scale *= 10) check_self_hits(effort, scale, rays), check_blockers(effort, scale, blocked);
  Tally all = rays;
  all.add(blocked);
  return none_wrong(all, "rays", 100000, grouped(rays.wrong()) + " self-hits, " + grouped(blocked.wrong()) + " missed blockers");
}

// The unit sphere from 1e5 away: t of the surface that is shaded, against the nearest hit of all in extended precision, in ulp of floats of
// that size.
Finding y10_far_sphere(const Effort& effort) {
  std::vector<SoupTriangle> soup;
  add_mesh(soup, make_sphere(2), 1, glm::dvec3(0));
  auto t = full_frame(make_test_scene(soup), Camera(), 16, 16);
  const Bvh bvh = build_all(*t);
  const int count = effort.count(15000, 1500);
  TestRandom random(26);
  const RayBatch rays = rays_from_far(random, count);
  HitBatch hits;
  hits.rays = &rays;
  std::vector<long double> best(static_cast<size_t>(count));  // infinity where nothing can be said
  for (int i = 0; i < count; ++i) {
    const Judged nearest = judge(t->scene, rays, i);
    best[static_cast<size_t>(i)] = nearest.margin < 1e-19L ? kInfinity : nearest.t;  // within 1e-9 of an edge, seen from 1e5 away
    add_hit(hits, 0, static_cast<uint32_t>(i), 0);
  }
  Worst ulps;
  for (const Isa isa : supported_isas()) {
    t->frame.isa = isa;
    trace_closest(t->frame, bvh, rays, hits.primitive.data());
    SurfaceBatch surfaces;
    resolve_surfaces(t->frame, hits, surfaces);
    for (int i = 0; i < count; ++i) {
      const long double want = best[static_cast<size_t>(i)];
      if (want < kInfinity) ulps.add(surfaces.valid[i] == 0 ? INFINITY : static_cast<double>(std::fabs(surfaces.t[i] - want)) / 0x1p-7);
    }
  }
  return within(ulps, 4, "ulp of t", "hits", 1000);
}

}  // namespace spanray::hard
