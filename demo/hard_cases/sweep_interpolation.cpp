// Errors of texture coordinates, by the ratio of view depths across a triangle and by its shape.
#include <algorithm>
#include <cmath>

#include "rivals.h"
#include "support/surface_scenes.h"
#include "sweep.h"

namespace spanray::hard {
namespace {

constexpr double kTexels = 4096;

std::vector<Curve> contenders() {
  return {{"spanray: set up in double, evaluated in float", true, {}},
          {"the same edge functions, set up in float", false, {}},
          {"screen positions snapped to 1/256 pixel, 1/w in double", false, {}}};
}

// The largest errors of uv, in texels, over some pixels inside the only triangle of the frame.
void add_uv_errors(TestFrame& t, const std::vector<uint32_t>& pixels, Sweep& sweep) {
  const PrimaryRays& r = t.frame.primary;
  HitBatch hits;
  for (const uint32_t pixel : pixels)
    if (oracle_hit(t.scene, 0, oracle_primary(t.frame, pixel)).inside) add_hit(hits, pixel, 0, 0);
  SurfaceBatch surfaces;
  resolve_surfaces(t.frame, hits, surfaces);
  std::array<glm::vec3, 3> from_eye;
  std::array<double, 3> px, py, w;
  for (size_t i = 0; i < 3; ++i) {
    const float* p = t.scene.vertices[t.scene.triangles[0].vertex[i]].position;
    const glm::dvec3 v = glm::dvec3(p[0], p[1], p[2]) - r.eye;
    from_eye[i] = glm::vec3(v), w[i] = dot3(r.forward, v);
    px[i] = dot3(r.pixel_row_x, v) / w[i], py[i] = dot3(r.pixel_row_y, v) / w[i];
  }
  Worst worst[3];
  for (int i = 0; i < hits.count; ++i) {
    const uint32_t pixel = hits.pixel[static_cast<size_t>(i)];
    const double x = (pixel & 0xffff) + 0.5, y = (pixel >> 16) + 0.5;
    const glm::vec3 direction(r.corner + x * r.step_x + y * r.step_y);
    const std::array<double, 3> weights[3] = {{double(surfaces.weight[0][i]), double(surfaces.weight[1][i]), double(surfaces.weight[2][i])},
                                              weights_in_float(direction, from_eye), weights_of_snapped(x, y, px, py, w)};
    const OracleHit want = oracle_hit(t.scene, 0, oracle_primary(t.frame, pixel));
    Real exact[2];
    oracle_uv(t.scene, 0, want.b, exact);
    for (size_t k = 0; k < 3; ++k) {
      const Real b[3] = {weights[k][0], weights[k][1], weights[k][2]};
      Real uv[2];
      oracle_uv(t.scene, 0, b, uv);
      for (int c = 0; c < 2; ++c) worst[k].add(std::min(static_cast<double>(std::fabs(uv[c] - exact[c])) * kTexels, kTexels));
    }
  }
  for (size_t k = 0; k < 3; ++k) sweep.curves[k].y.push_back(hits.count == 0 ? NAN : worst[k].value());
}

std::vector<uint32_t> grid_of_pixels(int size, int step) {
  std::vector<uint32_t> pixels;
  for (int y = 0; y < size; y += step)
    for (int x = 0; x < size; x += step) pixels.push_back(pack_pixel(static_cast<uint32_t>(x), static_cast<uint32_t>(y)));
  return pixels;
}

Camera looking_down_z() {
  Camera camera;
  camera.eye[2] = 0, camera.target[2] = -1;
  return camera;
}

}  // namespace

Sweep sweep_uv_by_w_ratio(const Effort& effort) {
  Sweep s;
  s.title = "Texture coordinates, by the ratio of view depths across a triangle";
  s.what =
      "A floor-like triangle from depth 1 to the depth on the axis, uv over a texture of 4096 texels, 2048 pixels wide, "
      "against long double on the "
      "unsnapped triangle. Snapped screen positions move the texture by whole texels wherever it is stretched; edge functions "
      "in float "
      "cancel.";
  s.x_name = "greatest over least view depth", s.y_name = "largest error, texels of 4096";
  s.x = decades(0, 6, 0.5), s.curves = contenders();
  s.bound_name = "contract: 1/256 texel (row I1)", s.bound.assign(s.x.size(), 1.0 / 256);
  const std::vector<uint32_t> pixels = grid_of_pixels(2048, effort.count(9, 31));
  for (const double ratio : s.x) {
    const SoupTriangle tri =
        with_uv(soup_triangle({-0.7, -0.4, -1}, {0.6 * ratio, -0.5 * ratio, -ratio}, {-0.002 * ratio, 0.5 * ratio, -ratio}),
                {0, 0}, {1, 0}, {0.3, 1});
    auto t = full_frame(make_test_scene({tri}), looking_down_z(), 2048, 2048);
    add_uv_errors(*t, pixels, s);
  }
  return s;
}

// At each ratio several slopes, the worst of them.
Sweep sweep_uv_by_sliver(const Effort& effort) {
  Sweep s;
  s.title = "Texture coordinates, by the shape of a triangle";
  s.what =
      "Triangles 1500 pixels long and ever thinner, down to a seventh of a pixel, at several slopes, one end twice as far as "
      "the other. uv runs over "
      "4096 texels along the triangle and across it: across a sliver, positions snapped to 1/256 pixel are wrong by a large "
      "share of its width. Where "
      "4096 texels share a pixel or two, weights in float pass 1/256 texel, too.";
  s.x_name = "length over width", s.y_name = "largest error, texels of 4096";
  s.x = decades(0, 4, 0.5), s.curves = contenders();
  s.bound_name = "1/256 texel, as rows I1 and I2 ask", s.bound.assign(s.x.size(), 1.0 / 256);
  const Camera camera = looking_down_z();
  const auto any = full_frame(make_test_scene({soup_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0})}), camera, 2048, 2048);
  const PrimaryRays& r = any->frame.primary;
  const auto at = [&](double x, double y, double depth) { return r.eye + (r.corner + r.step_x * x + r.step_y * y) * depth; };
  for (const double ratio : s.x) {
    Sweep slopes;
    slopes.curves = contenders();
    for (int n = 0; n < effort.count(9, 3); ++n) {
      const double angle = 0.05 + n * 0.163, length = 1500, width = length / ratio;
      const glm::dvec2 along(std::cos(angle), std::sin(angle)), across(-along.y, along.x), a(200.3, 200.7);
      const glm::dvec2 b = a + along * length, c = a + along * (0.6 * length) + across * width;
      const SoupTriangle tri = with_uv(soup_triangle(at(a.x, a.y, 5), at(b.x, b.y, 10), at(c.x, c.y, 7)), {0, 0}, {1, 0}, {0.6, 1});
      std::vector<uint32_t> pixels;  // around points of the triangle
      TestRandom random(static_cast<uint32_t>(101 + n));
      for (int i = 0; i < effort.count(4000, 1000); ++i) {
        const double u = random.uniform(), v = random.uniform() * (1 - u);
        const glm::dvec2 p = a + (b - a) * u + (c - a) * v;
        if (p.x >= 0 && p.y >= 0 && p.x < 2048 && p.y < 2048)
          pixels.push_back(pack_pixel(static_cast<uint32_t>(p.x), static_cast<uint32_t>(p.y)));
      }
      auto t = full_frame(make_test_scene({tri}), camera, 2048, 2048);
      add_uv_errors(*t, pixels, slopes);
    }
    for (size_t k = 0; k < 3; ++k) {
      Worst worst;
      for (const double y : slopes.curves[k].y)
        if (!std::isnan(y)) worst.add(y);
      s.curves[k].y.push_back(worst.checked() == 0 ? NAN : worst.value());
    }
  }
  return s;
}

}  // namespace spanray::hard
