#include "reference/reference.h"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "core/parallel.h"
#include "frame/samples.h"
#include "reference/light.h"
#include "reference/view.h"
#include "reference/world.h"
#include "scene/pose.h"

namespace spanray {
namespace reference {
namespace {

constexpr int kBlock = 32;  // pixels a side: what a task renders

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
      : settings_(settings),
        view_(camera, settings.width, settings.height),
        places_(make_places(settings, grid)),
        world_(scene, camera, settings) {}
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
    return world_.opaque.closest(ray.line, view_.near, kFar, world_.stop(ray)).primitive;
  }

 private:
  static constexpr double kFar = std::numeric_limits<double>::infinity();

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
    return !world_.opaque.any(way.line, 0, way.t_max, world_.stop(shadow));
  }
  glm::dvec3 shade(const Ray& ray, const Surface& s) const {
    glm::dvec3 sum = ambient_radiance(world_.scene, s);
    for (const Light& light : world_.lights) {
      if (!faces(s, light)) continue;
      const glm::dvec3 light_sum = reflected(world_.scene, settings_.shading, s, light, ray.line.origin);
      if (light_sum != glm::dvec3(0) && lit(ray, s, light)) sum += light_sum;
    }
    return sum;
  }
  // Blended layers before t_max over what lies behind (Porter and Duff 1984), farthest first; what they let through.
  double blend(const Ray& ray, double t_min, double t_max, glm::dvec3& color) const {
    if (world_.blended.empty()) return 1;
    std::vector<Met> layers = world_.blended.all(ray.line, t_min, t_max, world_.stop(ray));
    std::sort(layers.begin(), layers.end(),
              [](const Met& a, const Met& b) { return a.t != b.t ? a.t > b.t : a.primitive > b.primitive; });
    double through = 1;
    for (const Met& met : layers) {
      const Surface s = world_.surfaces.at(ray, met.primitive);
      const double alpha = std::clamp(s.opacity, 0.0, 1.0);
      color = shade(ray, s) * alpha + color * (1 - alpha), through *= 1 - alpha;
    }
    return through;
  }
  Ray mirrored(const Ray& ray, const Surface& s) const {
    const double length = length3(ray.line.direction);
    const glm::dvec3 d = -s.view, &n = s.normal;
    const auto turned = [&](const glm::dvec3& derivative) {
      const glm::dvec3 dd = of_unit(d, length, derivative);
      return dd - n * (2 * dot3(dd, n));  // the normal's own change left out, as the model says
    };
    Ray next;
    next.line = {start_above(s), mirror_direction(s)}, next.x = ray.x, next.y = ray.y;
    next.origin_dx = s.position_dx, next.origin_dy = s.position_dy;
    next.direction_dx = turned(ray.direction_dx), next.direction_dy = turned(ray.direction_dy);
    return next;
  }
  glm::dvec3 radiance(const Ray& ray, double t_min, int bounce) const {
    const Met met = world_.opaque.closest(ray.line, t_min, kFar, world_.stop(ray));
    const bool hit = met.primitive != kNoPrimitive;
    glm::dvec3 color(world_.scene.background[0], world_.scene.background[1], world_.scene.background[2]);
    Surface s;
    if (hit) s = world_.surfaces.at(ray, met.primitive), color = shade(ray, s);
    const double through = blend(ray, t_min, met.t, color);
    if (!hit || settings_.reflections == Reflections::kNone || bounce >= settings_.max_bounces) return color;
    if (!(s.mirror.x > 0 || s.mirror.y > 0 || s.mirror.z > 0)) return color;
    return color + s.mirror * through * radiance(mirrored(ray, s), 0, bounce + 1);
  }

  const Settings settings_;
  const View view_;
  const Places places_;
  const World world_;
};

Result<void> check(const SceneData& scene, const Settings& settings, int grid) {
  constexpr int kMaxGrid = 64;
  if (!sample_count_ok(settings.samples) || grid < 0 || grid > kMaxGrid)
    return Error{"reference: that number of samples is not possible"};
  return check_model(scene, settings);
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
