// Weights, normals and tangents of surfaces against long double on the original triangles (I1 to I5).
#include <algorithm>
#include <cmath>

#include "cases.h"
#include "support/surface_scenes.h"

namespace spanray::hard {
namespace {

constexpr double kTexels = 4096;

// Errors of uv, in texels of a texture of 4096, over the pixels of a picture `size` wide that lie inside triangle 0 of `t`.
void add_uv_errors(TestFrame& t, int x0, int x1, int y0, int y1, int step, Worst& texels) {
  HitBatch hits;
  for (int y = y0; y < y1; y += step)
    for (int x = x0; x < x1; x += step) {
      const uint32_t pixel = pack_pixel(static_cast<uint32_t>(x), static_cast<uint32_t>(y));
      if (oracle_hit(t.scene, 0, oracle_primary(t.frame, pixel)).inside) add_hit(hits, pixel, 0, 0);
    }
  for (const Isa isa : supported_isas()) {
    t.frame.isa = isa;
    SurfaceBatch s;
    resolve_surfaces(t.frame, hits, s);
    for (int i = 0; i < hits.count; ++i) {
      const OracleHit want = oracle_hit(t.scene, 0, oracle_primary(t.frame, hits.pixel[static_cast<size_t>(i)]));
      const Real b[3] = {s.weight[0][i], s.weight[1][i], s.weight[2][i]};
      Real uv[2], exact[2];
      oracle_uv(t.scene, 0, b, uv), oracle_uv(t.scene, 0, want.b, exact);
      for (int k = 0; k < 2; ++k) texels.add(static_cast<double>(std::fabs(uv[k] - exact[k])) * kTexels);
    }
  }
}

}  // namespace

Finding i1_perspective(const Effort& effort) {
  const SoupTriangle tri = with_uv(soup_triangle({-0.7, -0.4, -1}, {6e5, -5e5, -1e6}, {-2e3, 5e5, -1e6}), {0, 0}, {1, 0}, {0.3, 1});
  Camera camera;
  camera.eye[2] = 0, camera.target[2] = -1;
  auto t = full_frame(make_test_scene({tri}), camera, 2048, 2048);
  Worst texels;
  add_uv_errors(*t, 0, 2048, 0, 2048, effort.count(3, 6), texels);
  return within(texels, 1.0 / 256, "texels", "coordinates", 20000);
}

// Two pixels wide, and forty times as deep as it is wide.
Finding i2_far_pixel(const Effort& effort) {
  Camera camera;
  camera.eye[0] = 100, camera.eye[1] = 50, camera.eye[2] = 80, camera.fov_y_degrees = 90;
  const auto any = full_frame(make_test_scene({soup_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0})}), camera, 16384, 16384);
  const PrimaryRays& r = any->frame.primary;
  const auto at = [&](double x, double y, double depth) { return r.eye + (r.corner + r.step_x * x + r.step_y * y) * depth; };
  const double pixel = length3(r.step_x) * 30;
  TestRandom random(2);
  Worst texels;
  for (int n = 0; n < effort.count(1000, 100); ++n) {
    const glm::dvec3 a = random_point(random, 0.5), b = random_point(random, 0.5), c = random_point(random, 0.5);
    const SoupTriangle tri = with_uv(soup_triangle(at(16000.1 + a.x, 16000.2 + a.y, 30), at(16002.8 + b.x, 16001.4 + b.y, 30 + 40 * pixel),
                                                   at(16001.2 + c.x, 16003.1 + c.y, 30 - 40 * pixel)),
                                     {0, 0}, {1, 0}, {0, 1});
    auto t = full_frame(make_test_scene({tri}), camera, 16384, 16384);
    add_uv_errors(*t, 15998, 16006, 15998, 16006, 1, texels);
  }
  return within(texels, 1.0 / 256, "texels", "coordinates", 200);
}

// Equal normals at the corners of random triangles, inside of them and clamped to them.
Finding i3_equal_attributes(const Effort& effort) {
  TestRandom random(3);
  Tally values;
  for (int n = 0; n < effort.count(60, 8); ++n) {
    const glm::dvec3 normal = normalize3(random_point(random) + glm::dvec3(0, 0, 1.8), glm::dvec3(0, 0, 1));
    const glm::dvec3 a = random_point(random, 0.4), b = random_point(random, 0.4), c = random_point(random, 0.4);
    const SoupTriangle tri =
        with_normals(soup_triangle(a + glm::dvec3(-1.1, -1, 0), b + glm::dvec3(1.3, -0.9, 0), c + glm::dvec3(0, 1.2, 0)),
                     normal, normal, normal);
    auto t = full_frame(make_test_scene({tri}), Camera{}, 640, 640);
    HitBatch hits;
    for (uint32_t y = 200; y < 460; y += 3)
      for (uint32_t x = 200; x < 460; x += 3) add_hit(hits, pack_pixel(x, y), 0, 0);
    for (const Isa isa : supported_isas()) {
      t->frame.isa = isa;
      SurfaceBatch s;
      resolve_surfaces(t->frame, hits, s);
      for (int i = 0; i < hits.count; ++i)
        for (int k = 0; k < 3; ++k)
          values.check(bits_of(s.normal[k][i]) == bits_of(s.normal[k][0]) && std::fabs(s.normal[k][i] - normal[k]) < 1e-6);
    }
  }
  return none_wrong(values, "components of normals", 100000);
}

// n0 = -n1 = n, and n2 = -n too: zero where b0 = 1/2, from the middle of one edge to the middle of the other.
Finding i4_opposed_normals(const Effort& effort) {
  const glm::dvec3 n(0, 0.6, 0.8);
  const SoupTriangle tri = with_normals(soup_triangle({-1, -1, 0}, {1, -1, 0}, {-1, 1, 0}), n, -n, -n);
  auto t = full_frame(make_test_scene({tri}), Camera{}, 512, 512);
  RayBatch rays;
  HitBatch hits;
  hits.rays = &rays;
  const int steps = effort.count(1024, 64);  // a power of two: the points lie on the line exactly
  for (int i = 0; i <= steps; ++i)
    for (const double off : {0.0, 1e-7, -1e-7}) {
      const double f = static_cast<double>(i) / steps;
      add_hit(hits, 0, static_cast<uint32_t>(add_ray(rays, {-f + off, -1 + f + off, 4}, {0, 0, -1})), 0);
    }
  Tally surfaces;
  for (const Isa isa : supported_isas()) {
    t->frame.isa = isa;
    SurfaceBatch s;
    resolve_surfaces(t->frame, hits, s);
    for (int i = 0; i < hits.count; ++i) {
      bool right = std::fabs(length_real(real3(s.normal, i)) - 1) <= 1e-6L;
      for (int k = 0; k < 3; ++k) right &= s.normal[k][i] == s.geometric_normal[k][i];
      surfaces.check(right);
    }
  }
  return none_wrong(surfaces, "surfaces", 195);
}

// Bump and normal map where there is no tangent: the normal stays as it is. Where there is an extreme one: finite.
Finding i5_zero_uv_area(const Effort&) {
  const auto tri = [](glm::dvec2 a, glm::dvec2 b, glm::dvec2 c) {
    return with_uv(soup_triangle({-1, -1, 0}, {1, -1, 0}, {0, 1, 0}), a, b, c);
  };
  const std::vector<SoupTriangle> soup = {
      tri({0.3, 0.3}, {0.3, 0.3}, {0.3, 0.3}),  // all equal
      tri({0, 0}, {1, 0}, {0.5, 0}),            // along u
      tri({0, 0}, {1, 1}, {0.5, 0.5}),          // along a line
      with_normals(tri({0, 0}, {1, 0}, {0.5, 1}), {1, 0, 0}, {1, 0, 0}, {1, 0, 0}),  // u grows along the normal
      tri({0, 0}, {1e-38, 0}, {0, 1e-38}),
      tri({0, 0}, {1e30, 0}, {0, 1e30}),
  };
  SceneData scene = make_test_scene(soup, {Material{}});
  TestRandom random(6);
  scene.materials[0].map_bump = scene.materials[0].map_normal = add_texture(scene, 32, 32, [&](int, int) { return noise_texel(random); });
  auto t = make_test_frame(std::move(scene), Camera{}, test_settings(64, 64));
  HitBatch hits;
  for (uint32_t p = 0; p < soup.size(); ++p)
    for (uint32_t y = 24; y < 40; ++y) add_hit(hits, pack_pixel(32, y), 0, p);
  Tally surfaces;
  for (const Isa isa : supported_isas()) {
    t->frame.isa = isa;
    SurfaceBatch plain, s;
    t->frame.plan = PlanFlags{};
    resolve_surfaces(t->frame, hits, plain);
    t->frame.plan.bump = true;
    resolve_surfaces(t->frame, hits, s);
    for (int i = 0; i < hits.count; ++i) {
      bool right = true;
      for (int k = 0; k < 3; ++k)
        right &= std::isfinite(s.normal[k][i]) &&
                 (hits.primitive[static_cast<size_t>(i)] >= 4 || bits_of(s.normal[k][i]) == bits_of(plain.normal[k][i]));
      surfaces.check(right);
    }
  }
  return none_wrong(surfaces, "surfaces", 96);
}

}  // namespace spanray::hard
