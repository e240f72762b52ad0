#include "reference/reference.h"

#include <algorithm>

#include "reference/light.h"
#include "reference/pixels.h"
#include "reference/rays.h"
#include "reference/world.h"
#include "scene/pose.h"

namespace spanray {
namespace reference {
namespace {

class Renderer {
 public:
  Renderer(const SceneData& scene, const Camera& camera, const Settings& settings, int grid)
      : settings_(settings),
        view_(camera, settings.width, settings.height),
        places_(make_places(settings, grid)),
        world_(scene, camera, settings) {}
  glm::dvec3 pixel(int x, int y) const {
    glm::dvec3 sum(0);
    for (size_t i = 0; i < places_.at.size(); ++i) sum += radiance(primary_ray(view_, places_, i, x, y), view_.near, 0);
    return sum * (1 / static_cast<double>(places_.at.size()));
  }
  uint32_t center(int x, int y) const {
    const Ray ray = primary_ray(view_, {{{0.5, 0.5}}, 1}, 0, x, y);
    return world_.opaque.closest(ray.line, view_.near, kFar, world_.stop(ray)).primitive;
  }

 private:
  static constexpr double kFar = std::numeric_limits<double>::infinity();

  bool free(const Ray& ray, const Way& way) const {
    Ray shadow;  // a point: cut-outs are read at full detail
    shadow.line = way.line, shadow.x = ray.x, shadow.y = ray.y;
    return !world_.opaque.any(way.line, 0, way.t_max, world_.blocks(shadow));
  }
  // Of a light that the surface faces, in one of the two ways: from above the triangle where it can.
  bool lit(const Ray& ray, const Surface& s, const Light& light) const {
    if (settings_.shadows == Shadows::kNone) return true;
    const glm::dvec3 start = start_above(s), lifted = s.position + s.lift;
    if (faces_lifted(s, light) && free(ray, {{start, lifted - start}, kLiftReach})) return free(ray, way_to(light, lifted));
    return faces(s, light) && free(ray, way_to(light, start));
  }
  glm::dvec3 shade(const Ray& ray, const Surface& s) const {
    glm::dvec3 sum = ambient_radiance(world_.scene, s);
    for (const Light& light : world_.lights) {
      if (!faces(s, light) && !faces_lifted(s, light)) continue;
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
  glm::dvec3 radiance(const Ray& ray, double t_min, int bounce) const {
    const Met met = world_.opaque.closest(ray.line, t_min, kFar, world_.stop(ray));
    const bool hit = met.primitive != kNoPrimitive;
    glm::dvec3 color(world_.scene.background[0], world_.scene.background[1], world_.scene.background[2]);
    Surface s;
    if (hit) s = world_.surfaces.at(ray, met.primitive), color = shade(ray, s);
    const double through = blend(ray, t_min, met.t, color);
    if (!hit || settings_.reflections == Reflections::kNone || bounce >= settings_.max_bounces) return color;
    if (!(s.mirror.x > 0 || s.mirror.y > 0 || s.mirror.z > 0)) return color;
    return color + s.mirror * through * radiance(mirrored_ray(ray, s), 0, bounce + 1);
  }

  const Settings settings_;
  const View view_;
  const Places places_;
  const World world_;
};

}  // namespace
}  // namespace reference

Result<void> render_reference(const Scene& scene, const Camera& camera, const Settings& settings,
                              const ReferenceOptions& options, Framebuffer& out) {
  if (!scene.valid()) return Error{"reference: there is no scene"};
  if (Result<void> checked = reference::check_request(scene.data(), settings, options.grid); !checked) return checked;
  const Scene standing = scene_at(scene, settings.time);
  const reference::Renderer renderer(standing.data(), camera, settings, options.grid);
  const size_t width = static_cast<size_t>(settings.width), pixels = width * static_cast<size_t>(settings.height);
  out = {};
  out.color.width = settings.width, out.color.height = settings.height;
  out.color.rgba.assign(4 * pixels, 255), out.radiance.resize(3 * pixels), out.primitive.resize(pixels);
  reference::for_each_pixel(settings, options, [&](int x, int y) {
    const size_t i = static_cast<size_t>(y) * width + static_cast<size_t>(x);
    const glm::dvec3 radiance = renderer.pixel(x, y);
    for (size_t c = 0; c < 3; ++c) {
      out.radiance[3 * i + c] = static_cast<float>(radiance[static_cast<int>(c)]);
      out.color.rgba[4 * i + c] = reference::srgb_byte(radiance[static_cast<int>(c)]);
    }
    out.primitive[i] = renderer.center(x, y);
  });
  return {};
}

}  // namespace spanray
