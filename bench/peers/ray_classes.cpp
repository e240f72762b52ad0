#include "ray_classes.h"

#include <cmath>
#include <limits>

#include "math/elementary.h"
#include "measure.h"
#include "render/make_frame.h"
#include "shade/light.h"
#include "shade/surface.h"

namespace spanray::peers {
namespace {

constexpr int kPartWidth = 64, kPartHeight = 16, kBlock = 4;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

// The pixels of the part that begins at (x0, y0), block by block.
std::vector<uint32_t> pixels_of_part(const Settings& s, int x0, int y0) {
  std::vector<uint32_t> pixels;
  for (int by = y0; by < y0 + kPartHeight; by += kBlock)
    for (int bx = x0; bx < x0 + kPartWidth; bx += kBlock)
      for (int i = 0; i < kBlock * kBlock; ++i) {
        const int x = bx + i % kBlock, y = by + i / kBlock;
        if (x < s.width && y < s.height) pixels.push_back(pack_pixel(static_cast<uint32_t>(x), static_cast<uint32_t>(y)));
      }
  return pixels;
}

RayBatch primary_part(const Frame& frame, const std::vector<uint32_t>& pixels) {
  const PrimaryRays& p = frame.primary;
  RayBatch rays;
  rays.resize(static_cast<int>(pixels.size()), false);
  for (size_t i = 0; i < pixels.size(); ++i) {
    const glm::dvec3 d = p.corner + p.step_x * ((pixels[i] & 0xffff) + 0.5) + p.step_y * ((pixels[i] >> 16) + 0.5);
    const glm::dvec3 o = p.eye + d * p.near_plane;
    for (int k = 0; k < 3; ++k) rays.origin[k][i] = static_cast<float>(o[k]), rays.direction[k][i] = static_cast<float>(d[k]);
    rays.t_max[i] = kInfinity;
    rays.pixel[i] = pixels[i];
  }
  return rays;
}

HitBatch trace_hits(const TracedScene& traced, const RayBatch& rays) {
  std::vector<uint32_t> primitive(static_cast<size_t>(rays.count));
  trace_closest(traced.frame, traced.bvh, rays, primitive.data());
  HitBatch hits;
  hits.resize(rays.count, false);
  int n = 0;
  for (int i = 0; i < rays.count; ++i) {
    if (primitive[static_cast<size_t>(i)] == kNoPrimitive) continue;
    hits.pixel[static_cast<size_t>(n)] = rays.pixel[static_cast<size_t>(i)];
    hits.primitive[static_cast<size_t>(n++)] = primitive[static_cast<size_t>(i)];
  }
  hits.resize(n, false);
  return hits;
}

// A pseudo-random number in [0, 1) of a pixel (Jarzynski and Olano 2020, "Hash Functions for GPU Rendering": pcg).
double random_of(uint32_t pixel, uint32_t dimension) {
  const uint32_t state = (pixel * 2u + dimension) * 747796405u + 2891336453u;
  const uint32_t word = ((state >> ((state >> 28) + 4)) ^ state) * 277803737u;
  return static_cast<double>((word >> 22) ^ word) * 0x1p-32;
}

// Cosine-distributed about n: a point of the unit sphere put on top of n (its direction is n plus that point).
glm::dvec3 cosine_direction(const glm::dvec3& n, uint32_t pixel) {
  const double z = 2 * random_of(pixel, 0) - 1, angle = 2 * kPi * random_of(pixel, 1), r = std::sqrt(std::max(0.0, 1 - z * z));
  return normalize3(n + glm::dvec3(r * std::cos(angle), r * std::sin(angle), z), n);
}

// The origins of `mirrors` with other directions.
RayBatch scattered_part(const RayBatch& mirrors, const SurfaceBatch& surfaces, const AlignedBuffer<uint32_t>& surface_of_ray, float length) {
  RayBatch rays;
  rays.resize(mirrors.count, false);
  rays.from.resize(mirrors.from.size());
  for (size_t i = 0; i < static_cast<size_t>(mirrors.count); ++i) {
    const uint32_t s = surface_of_ray[i];
    const glm::dvec3 n(surfaces.geometric_normal[0][s], surfaces.geometric_normal[1][s], surfaces.geometric_normal[2][s]);
    const glm::dvec3 d = cosine_direction(n, mirrors.pixel[i]);
    for (int k = 0; k < 3; ++k) rays.origin[k][i] = mirrors.origin[k][i], rays.direction[k][i] = static_cast<float>(d[k]);
    rays.t_max[i] = length;
    rays.pixel[i] = mirrors.pixel[i];
    rays.from[i] = mirrors.from[i];
  }
  return rays;
}

float diagonal(const SceneData& scene) {
  glm::dvec3 d;
  for (int k = 0; k < 3; ++k) d[k] = static_cast<double>(scene.bounds_max[k]) - scene.bounds_min[k];
  return static_cast<float>(length3(d));
}

void add_part(RayClass& c, RayBatch&& rays) {
  if (rays.count > 0) c.parts.push_back(std::move(rays));
}

}  // namespace

size_t RayClass::count() const {
  size_t n = 0;
  for (const RayBatch& part : parts) n += static_cast<size_t>(part.count);
  return n;
}

TracedScene::TracedScene(const Scene& traced, const Camera& camera, const Settings& settings, Parallel& parallel, int builds) : scene(traced) {
  const SceneData& data = scene.data();
  flags.assign(data.materials.size(), 0);
  Settings traced_settings = settings;
  traced_settings.textures = traced_settings.bump = false;
  traced_settings.culling = Culling::kNone;
  traced_settings.shading = Shading::kPhong;
  frame = make_frame(data, camera, traced_settings, make_plan(data, find_scene_use(data), traced_settings), parallel);
  frame.plan.bounces = true;  // every surface mirrors here
  frame.material_flags = flags.data(), frame.accept_rays = nullptr;
  std::vector<double> ms;
  for (int i = 0; i < builds; ++i) {
    const Stopwatch watch;
    bvh = build_bvh(data, flags.data(), 0, 0, parallel, settings.tree);
    ms.push_back(watch.wall());
  }
  build_ms = median(ms);
}

std::vector<RayClass> make_ray_classes(const TracedScene& traced) {
  const Frame& frame = traced.frame;
  RayClass primary{"primary", false, {}}, shadow{"shadow", true, {}}, mirror{"mirror", false, {}}, diffuse{"diffuse", false, {}}, ao{"ao", true, {}};
  const float reach = 0.15f * diagonal(*frame.scene);
  for (int y0 = 0; y0 < frame.settings.height; y0 += kPartHeight) {
    for (int x0 = 0; x0 < frame.settings.width; x0 += kPartWidth) {
      RayBatch rays = primary_part(frame, pixels_of_part(frame.settings, x0, y0));
      const HitBatch hits = trace_hits(traced, rays);
      add_part(primary, std::move(rays));
      if (hits.count == 0) continue;
      SurfaceBatch surfaces;
      resolve_surfaces(frame, hits, surfaces);
      for (float* channel : surfaces.mirror)
        for (int i = 0; i < surfaces.count; ++i) channel[i] = 1;
      AlignedBuffer<uint32_t> surface_of_ray;
      for (int light = 0; light < static_cast<int>(frame.scene->lights.size()); ++light) {
        RayBatch to_light;
        surface_of_ray.clear();
        make_shadow_rays(frame, surfaces, light, to_light, surface_of_ray);
        add_part(shadow, std::move(to_light));
      }
      RayBatch mirrors;
      surface_of_ray.clear();
      make_bounce_rays(frame, surfaces, hits, mirrors, surface_of_ray);
      add_part(diffuse, scattered_part(mirrors, surfaces, surface_of_ray, kInfinity));
      add_part(ao, scattered_part(mirrors, surfaces, surface_of_ray, reach));
      add_part(mirror, std::move(mirrors));
    }
  }
  std::vector<RayClass> classes;
  for (RayClass* c : {&primary, &shadow, &mirror, &diffuse, &ao}) classes.push_back(std::move(*c));
  return classes;
}

}  // namespace spanray::peers
