// Whole frames (Y11, Y12, Y13, T1).
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "cases.h"
#include "spanray/render.h"
#include "support/camera_at.h"
#include "support/edge_distance.h"
#include "support/raster_soup.h"
#include "support/shading_oracle.h"
#include "support/surface_oracle.h"

namespace spanray::hard {
namespace {

void add_square(std::vector<SoupTriangle>& soup, const glm::dvec3& center, const glm::dvec3& u, const glm::dvec3& v, uint32_t material) {
  soup.push_back(soup_triangle(center - u - v, center + u - v, center + u + v, material));
  soup.push_back(soup_triangle(center - u - v, center + u + v, center - u + v, material));
}

Material dark_material() {
  Material m;
  for (int k = 0; k < 3; ++k) m.ambient[k] = m.diffuse[k] = 0;
  return m;
}

double plane_depth(const SceneData& scene, const PrimaryRays& rays, uint32_t primitive, double x, double y) {
  const Triangle& t = scene.triangles[primitive];
  const glm::dvec3 v0 = vertex_position(scene, t, 0), n = cross3(vertex_position(scene, t, 1) - v0, vertex_position(scene, t, 2) - v0);
  return dot3(v0 - rays.eye, n) / dot3(rays.corner + rays.step_x * x + rays.step_y * y, n);
}

}  // namespace

Finding y11_critical_angle(const Effort&) {
  return not_measured("this version has no refraction: d dims a surface, it does not bend light");
}

// Two mirrors face each other, the eye between them: each bounce may add at most what the one before it added, to the limit of 64.
// Weight 1 loses nothing, so that the sums are exact in binary; 0.9 follows the geometric series.
Finding y12_mirror_corridor(const Effort&) {
  Tally steps;
  double last = 0;
  for (const float weight : {1.0f, 0.9f}) {
    Material mirror = dark_material();
    for (int k = 0; k < 3; ++k) mirror.mirror[k] = weight, mirror.emission[k] = 0.25f;
    std::vector<SoupTriangle> soup;
    add_square(soup, {0, 0, 1}, {500, 0, 0}, {0, 500, 0}, 0), add_square(soup, {0, 0, -1}, {500, 0, 0}, {0, 500, 0}, 0);
    const Scene scene(std::make_shared<SceneData>(make_test_scene(soup, {mirror})));
    Settings settings;
    settings.width = 40, settings.height = 30;
    Renderer renderer;
    std::vector<float> before(3 * 40 * 30, 0.0f), step_before(before.size(), INFINITY);
    for (int bounces = 0; bounces <= kMaxBounces; ++bounces) {
      settings.max_bounces = bounces;
      FrameRequest request;
      request.radiance = true;
      Framebuffer out;
      if (!renderer.render(scene, camera_at({0, 0, 0}, {0.1, 0.2, -1}), settings, out, request)) return none_wrong(steps, "frames", 1);
      const double want = 0.25 * std::pow(double(weight), bounces);
      for (size_t i = 0; i < before.size(); ++i) {
        const float step = out.radiance[i] - before[i];
        steps.check(std::fabs(step - want) <= out.radiance[i] * 0x1p-21 && step <= step_before[i] + out.radiance[i] * 0x1p-22f,
                    [&] { return std::to_string(bounces) + " bounces, weight " + short_text(weight) + ": " + short_text(step); });
        before[i] = out.radiance[i], step_before[i] = step;
      }
    }
    last = before[0];
  }
  return none_wrong(steps, "steps of radiance", 100000, "64 bounces, weights 1 and 0.9; the last sum is " + short_text(last));
}

// Colors, depths and ids of a soup with a light, shadows and mirrors, by both engines. Ids may differ within 1/256 pixel of an
// edge or where the two depths differ by less than 2e-6 of them.
Finding y13_raster_against_rays(const Effort& effort) {
  constexpr double kDepthTie = 2e-6;
  std::vector<Material> materials(2);
  for (float& m : materials[1].mirror) m = 0.3f;
  const auto owned = std::make_shared<SceneData>(make_test_scene(random_soup(13, effort.count(3000, 1000), 2), materials));
  SceneData& data = *owned;
  data.lights.emplace_back();
  data.lights[0].position[1] = 5, data.lights[0].position[2] = 4;
  for (float& c : data.lights[0].intensity) c = 60;
  const Scene scene(owned);
  const Camera camera = camera_at({0, 0, 3}, {0.1, 0.2, 0});
  Settings settings;
  settings.width = 2048, settings.height = effort.count(512, 128), settings.max_bounces = 1;
  FrameRequest request;
  request.depth = request.primitive = request.radiance = true;
  Framebuffer frames[2];
  Renderer renderer;
  Tally pixels;
  for (int i = 0; i < 2; ++i) {
    settings.visibility = i == 0 ? Visibility::kRaster : Visibility::kRay;
    if (!renderer.render(scene, camera, settings, frames[i], request)) return none_wrong(pixels, "pixels", 1, "could not render");
  }
  const PrimaryRays rays = make_primary_rays(camera, settings.width, settings.height);
  uint64_t ids_differ = 0;
  for (size_t p = 0; p < frames[0].primitive.size(); ++p) {
    const double x = static_cast<double>(p % settings.width) + 0.5, y = static_cast<double>(p / settings.width) + 0.5;
    const uint32_t a = frames[0].primitive[p], b = frames[1].primitive[p];
    const auto say = [&] { return std::to_string(int(x)) + "," + std::to_string(int(y)); };
    if (a == b) {
      pixels.check(std::memcmp(&frames[0].depth[p], &frames[1].depth[p], 4) == 0 &&
                       std::memcmp(&frames[0].radiance[3 * p], &frames[1].radiance[3 * p], 12) == 0,
                   say);
      continue;
    }
    ++ids_differ;
    double nearest = std::numeric_limits<double>::infinity();
    for (const uint32_t t : {a, b})
      if (t != kNoPrimitive) nearest = std::min(nearest, edge_distance(data, rays, t, x, y));
    bool allowed = nearest <= kEdgePixels;
    if (!allowed && a != kNoPrimitive && b != kNoPrimitive) {
      const double za = plane_depth(data, rays, a, x, y), zb = plane_depth(data, rays, b, x, y);
      allowed = std::fabs(za - zb) <= kDepthTie * std::fabs(za);
    }
    pixels.check(allowed, say);
  }
  return none_wrong(pixels, "pixels", 200000,
                    grouped(ids_differ) + " see another triangle, all within 1/256 pixel of an edge or at a tie of depths");
}

// Glowing panes through one point: the frame's colors against layers sorted and blended in double at each pixel. Pixels at an
// edge of a pane, and where two layers are nearer than 2e-6, are left out.
Finding t1_crossing_panes(const Effort& effort) {
  TestRandom random(101);
  Worst codes;
  for (int picture = 0; picture < effort.count(20, 3); ++picture) {
    std::vector<Material> materials;
    std::vector<SoupTriangle> soup;
    for (uint32_t i = 0; i < 8; ++i) {
      Material m = dark_material();
      m.transparency = static_cast<int32_t>(MaterialTransparency::kAlpha), m.opacity = static_cast<float>(random.uniform(0.1, 0.9));
      for (float& c : m.emission) c = static_cast<float>(random.uniform());
      materials.push_back(m);
      const glm::dvec3 u = normalize3(random_point(random), glm::dvec3(1, 0, 0));
      add_square(soup, random_point(random, 0.2), u, normalize3(cross3(u, random_point(random)), glm::dvec3(0, 1, 0)), i);
    }
    Settings settings;
    settings.width = 128, settings.height = 96;
    const Camera camera = camera_at({0.3, 0.4, 3}, {0, 0, 0});
    const auto t = make_test_frame(make_test_scene(soup, materials), camera, settings);
    const SceneData& data = t->scene;
    FrameRequest request;
    request.radiance = true;
    Framebuffer out;
    Renderer renderer;
    if (!renderer.render(Scene(std::make_shared<SceneData>(make_test_scene(soup, materials))), camera, settings, out, request))
      codes.add(INFINITY);
    for (uint32_t p = 0; p < out.radiance.size() / 3; ++p) {
      const uint32_t x = p % 128, y = p / 128;
      std::vector<std::pair<Real, uint32_t>> layers;
      bool doubtful = false;
      for (uint32_t id = 0; id < soup.size(); ++id) {
        const OracleHit hit = oracle_hit(data, id, oracle_primary(t->frame, pack_pixel(x, y)));
        if (hit.inside) layers.emplace_back(hit.t, id);
        doubtful |= edge_distance(data, t->frame.primary, id, x + 0.5, y + 0.5) <= 2 * kEdgePixels;
      }
      std::sort(layers.begin(), layers.end());
      for (size_t i = 1; i < layers.size(); ++i) doubtful |= layers[i].first - layers[i - 1].first <= 2e-6L * layers[i].first;
      if (doubtful || layers.size() < 2) continue;
      for (int c = 0; c < 3; ++c) {
        double want = data.background[c];
        for (size_t i = layers.size(); i-- > 0;) {
          const Material& m = data.materials[material_of(data.triangles[layers[i].second])];
          want = double(m.opacity) * double(m.emission[c]) + (1 - double(m.opacity)) * want;
        }
        codes.add(255 * std::fabs(oracle_srgb(out.radiance[3 * p + static_cast<uint32_t>(c)]) - oracle_srgb(want)));
      }
    }
  }
  return within(codes, 1, "of 255", "colors", 10000);
}

}  // namespace spanray::hard
