#include "reference/reference.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numbers>

#include "core/parallel.h"
#include "frame/samples.h"
#include "reference/light.h"
#include "scene/default_view.h"
#include "scene/pose.h"

namespace spanray {
namespace reference {
namespace {

constexpr int kBlock = 32;  // pixels a side: what a task renders

// A pinhole camera: rays through positions of the picture, y down, of view depth 1.
struct View {
  glm::dvec3 eye{0}, forward{0}, right{0}, down{0};  // right, down: by one pixel at view depth 1
  double half_width = 0, half_height = 0, near = 0;
  View(const Camera& c, int width, int height) : half_width(0.5 * width), half_height(0.5 * height), near(c.near_plane) {
    const auto vec = [](const double* v) { return glm::dvec3(v[0], v[1], v[2]); };
    eye = vec(c.eye), forward = normalize3(vec(c.target) - eye, glm::dvec3(0, 0, -1));
    const glm::dvec3 axis = std::fabs(forward.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, forward.y > 0 ? 1 : -1);
    glm::dvec3 side = cross3(forward, normalize3(vec(c.up), axis));
    if (!(length3(side) > 1e-9)) side = cross3(forward, axis);  // an up vector along the view is none
    side = normalize3(side, glm::dvec3(1, 0, 0));
    const double pixel = std::tan(c.fov_y_degrees * (std::numbers::pi / 360)) / half_height;
    right = side * pixel, down = cross3(forward, side) * pixel;
  }
  glm::dvec3 direction(double x, double y) const { return forward + right * (x - half_width) + down * (y - half_height); }
};

// Places in a pixel where it is sampled, and the side of the square that each stands for.
struct Places {
  std::vector<glm::dvec2> at;
  double side = 1;
};

// A grid: one sample in each of grid x grid squares, and in each of grid^2 columns and rows, so that upright and level edges are
// measured as finely as slanted ones. Source: Chiu, Shirley, Wang 1994, "Multi-Jittered Sampling", the canonical arrangement, not jittered.
Places make_places(const Settings& settings, int grid) {
  Places places;
  if (grid > 0) {
    for (int j = 0; j < grid; ++j)
      for (int i = 0; i < grid; ++i) places.at.emplace_back((i + (j + 0.5) / grid) / grid, (j + (i + 0.5) / grid) / grid);
  } else {
    const SamplePlaces pattern = make_sample_places(settings.samples);
    for (int i = pattern.first(); i < pattern.end(); ++i) places.at.emplace_back(pattern.x[i], pattern.y[i]);
  }
  places.side = 1 / std::sqrt(static_cast<double>(places.at.size()));
  return places;
}

// Derivative of a unit direction d = D / length by that of D.
glm::dvec3 of_unit(const glm::dvec3& d, double length, const glm::dvec3& derivative) {
  return (derivative - d * dot3(d, derivative)) * (1 / length);
}

class Renderer {
 public:
  Renderer(const SceneData& scene, const Camera& camera, const Settings& settings, int grid)
      : scene_(scene),
        settings_(settings),
        view_(camera, settings.width, settings.height),
        places_(make_places(settings, grid)),
        surfaces_(scene, settings),
        opaque_(scene, primitives(false)),
        blended_(scene, primitives(true)),
        lights_(scene.lights) {
    if (scene.light_follows_eye) lights_.assign(1, default_light(scene, camera));
  }
  // What a ray's walk through a tree asks of each hit.
  auto stop(const Ray& ray) const {
    return [this, &ray](uint32_t primitive, double) { return surfaces_.stops(ray, primitive); };
  }
  glm::dvec3 pixel(int x, int y) const {
    glm::dvec3 sum(0);
    const int n = static_cast<int>(places_.at.size());
    for (int i = 0; i < n; ++i) {
      Ray ray = primary(x, y, places_.at[static_cast<size_t>(i)]);
      ray.rank_shift = i * 64 / n;
      sum += radiance(ray, view_.near, 0);
    }
    return sum * (1.0 / n);
  }
  uint32_t center(int x, int y) const {
    const Ray ray = primary(x, y, {0.5, 0.5});
    return opaque_.closest(ray.line, view_.near, kFar, stop(ray)).primitive;
  }

 private:
  static constexpr double kFar = std::numeric_limits<double>::infinity();

  std::vector<uint32_t> primitives(bool blended) const {
    std::vector<uint32_t> list;
    for (uint32_t i = 0; i < scene_.triangles.size(); ++i)
      if ((surfaces_.role(i) == Role::kBlended) == blended) list.push_back(i);
    return list;
  }
  Ray primary(int x, int y, const glm::dvec2& place) const {
    Ray ray;
    ray.line = {view_.eye, view_.direction(x + place.x, y + place.y)};
    ray.direction_dx = view_.right * places_.side, ray.direction_dy = view_.down * places_.side;
    ray.x = x, ray.y = y;
    return ray;
  }

  bool lit(const Ray& ray, const Surface& s, const Light& light) const {
    if (settings_.shadows == Shadows::kNone) return true;
    const Way way = way_to(light, start_above(s));
    Ray shadow;  // a point: cut-outs are read at full detail
    shadow.line = way.line, shadow.x = ray.x, shadow.y = ray.y;
    return !opaque_.any(way.line, 0, way.t_max, stop(shadow));
  }
  glm::dvec3 shade(const Ray& ray, const Surface& s) const {
    glm::dvec3 sum = ambient_radiance(scene_, s);
    for (const Light& light : lights_) {
      if (!faces(s, light)) continue;
      const glm::dvec3 light_sum = reflected(scene_, settings_.shading, s, light, ray.line.origin);
      if (light_sum != glm::dvec3(0) && lit(ray, s, light)) sum += light_sum;
    }
    return sum;
  }
  // Blended layers before t_max over what lies behind (Porter and Duff 1984), farthest first; what they let through.
  double blend(const Ray& ray, double t_min, double t_max, glm::dvec3& color) const {
    if (blended_.empty()) return 1;
    std::vector<Met> layers = blended_.all(ray.line, t_min, t_max, stop(ray));
    std::sort(layers.begin(), layers.end(),
              [](const Met& a, const Met& b) { return a.t != b.t ? a.t > b.t : a.primitive > b.primitive; });
    double through = 1;
    for (const Met& met : layers) {
      const Surface s = surfaces_.at(ray, met.primitive);
      const double alpha = std::clamp(s.opacity, 0.0, 1.0);
      color = shade(ray, s) * alpha + color * (1 - alpha), through *= 1 - alpha;
    }
    return through;
  }
  Ray mirrored(const Ray& ray, const Surface& s) const {
    const double length = length3(ray.line.direction);
    const glm::dvec3 d = -s.view, &n = s.normal;
    glm::dvec3 r = d - n * (2 * dot3(d, n));
    // A shading normal may point the ray into its own surface.
    r += s.geometric * std::max(kHorizon - dot3(s.geometric, r), 0.0);
    const auto turned = [&](const glm::dvec3& derivative) {
      const glm::dvec3 dd = of_unit(d, length, derivative);
      return dd - n * (2 * dot3(dd, n));  // the normal's own change left out, as the model says
    };
    Ray next;
    next.line = {start_above(s), r}, next.x = ray.x, next.y = ray.y;
    next.origin_dx = s.position_dx, next.origin_dy = s.position_dy;
    next.direction_dx = turned(ray.direction_dx), next.direction_dy = turned(ray.direction_dy);
    return next;
  }
  glm::dvec3 radiance(const Ray& ray, double t_min, int bounce) const {
    const Met met = opaque_.closest(ray.line, t_min, kFar, stop(ray));
    const bool hit = met.primitive != kNoPrimitive;
    glm::dvec3 color(scene_.background[0], scene_.background[1], scene_.background[2]);
    Surface s;
    if (hit) s = surfaces_.at(ray, met.primitive), color = shade(ray, s);
    const double through = blend(ray, t_min, met.t, color);
    if (!hit || settings_.reflections == Reflections::kNone || bounce >= settings_.max_bounces) return color;
    if (!(s.mirror.x > 0 || s.mirror.y > 0 || s.mirror.z > 0)) return color;
    return color + s.mirror * through * radiance(mirrored(ray, s), 0, bounce + 1);
  }

  const SceneData& scene_;
  const Settings settings_;
  const View view_;
  const Places places_;
  const Surfaces surfaces_;
  const Tree opaque_, blended_;
  std::vector<Light> lights_;
};

uint8_t srgb_byte(double linear) {
  const double v = std::clamp(linear, 0.0, 1.0);
  return static_cast<uint8_t>(255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055) + 0.5);
}

Result<void> check(const SceneData& scene, const Settings& settings, int grid) {
  constexpr int kMaxGrid = 64;
  if (settings.width < 1 || settings.height < 1 || settings.width > kMaxImageSide || settings.height > kMaxImageSide)
    return Error{"reference: a picture has 1 to 16384 pixels a side"};
  if (!(std::fabs(settings.time) <= kMostSeconds)) return Error{"reference: the time is at most 1e6 seconds either way"};
  if (!sample_count_ok(settings.samples) || grid < 0 || grid > kMaxGrid)
    return Error{"reference: that number of samples is not possible"};
  for (size_t i = 0; i < scene.materials.size(); ++i)
    if (const int model = scene.materials[i].reflectance; model != kBlinnPhong && model != kLambert)
      return Error{"reference: material " + scene.material_names[i] + " has a reflectance that the reference does not model"};
  for (const Light& light : scene.lights)
    if (light.kind != static_cast<int32_t>(LightKind::kPoint) && light.kind != static_cast<int32_t>(LightKind::kDirectional))
      return Error{"reference: the scene has a kind of light that the reference does not model"};
  return {};
}

}  // namespace
}  // namespace reference

Result<void> render_reference(const Scene& scene, const Camera& camera, const Settings& settings,
                              const ReferenceOptions& options, Framebuffer& out) {
  if (!scene.valid()) return Error{"reference: there is no scene"};
  if (Result<void> checked = reference::check(scene.data(), settings, options.grid); !checked) return checked;
  const Scene standing = scene_at(scene, settings.time);
  const reference::Renderer renderer(standing.data(), camera, settings, options.grid);
  const size_t width = static_cast<size_t>(settings.width), pixels = width * static_cast<size_t>(settings.height);
  out = {};
  out.color.width = settings.width, out.color.height = settings.height;
  out.color.rgba.assign(4 * pixels, 255), out.radiance.resize(3 * pixels), out.primitive.resize(pixels);
  const int columns = (settings.width + reference::kBlock - 1) / reference::kBlock,
            rows = (settings.height + reference::kBlock - 1) / reference::kBlock;
  std::mutex mutex;
  int done = 0;
  Parallel parallel(options.threads);
  parallel.for_each(static_cast<size_t>(columns) * static_cast<size_t>(rows), [&](size_t block, int) {
    const int x0 = static_cast<int>(block) % columns * reference::kBlock,
              y0 = static_cast<int>(block) / columns * reference::kBlock;
    for (int y = y0; y < std::min(y0 + reference::kBlock, settings.height); ++y)
      for (int x = x0; x < std::min(x0 + reference::kBlock, settings.width); ++x) {
        const size_t i = static_cast<size_t>(y) * width + static_cast<size_t>(x);
        const glm::dvec3 radiance = renderer.pixel(x, y);
        for (size_t c = 0; c < 3; ++c) {
          out.radiance[3 * i + c] = static_cast<float>(radiance[static_cast<int>(c)]);
          out.color.rgba[4 * i + c] = reference::srgb_byte(radiance[static_cast<int>(c)]);
        }
        out.primitive[i] = renderer.center(x, y);
      }
    const std::lock_guard lock(mutex);
    ++done;
    if (options.progress) options.progress(static_cast<double>(done) / (static_cast<double>(columns) * rows));
  });
  return {};
}

}  // namespace spanray
