// spanray why: how one pixel comes about, every step, in hexadecimal floats.
#include <charconv>
#include <cstdio>
#include <cstring>
#include <memory>
#include <span>

#include <CLI/CLI.hpp>

#include "command.h"
#include "core/hash.h"
#include "frame_options.h"
#include "render/trace_pixel.h"
#include "scene/pose.h"
#include "spanray/settings_text.h"
#include "spanray/stats.h"

namespace spanray::demo {
namespace {

struct WhyOptions {
  FrameOptions frame;
  std::string pixel;
};

// "name  0x1.8p+1 0x1p+0  (3 1)"
template <class T> void row(int indent, const char* name, std::span<const T> values) {
  std::printf("%*s%-*s", indent, "", 26 - indent, name);
  for (const T value : values) std::printf(" %a", static_cast<double>(value));
  std::printf("   (");
  for (size_t i = 0; i < values.size(); ++i) std::printf("%s%.9g", i > 0 ? " " : "", static_cast<double>(values[i]));
  std::printf(")\n");
}
template <size_t N> void row(int indent, const char* name, const float (&values)[N]) {
  row(indent, name, std::span<const float>(values));
}
void row(int indent, const char* name, float value) { row(indent, name, std::span<const float>(&value, 1)); }
void row(int indent, const char* name, const glm::dvec3& v) {
  const double values[3] = {v.x, v.y, v.z};
  row(indent, name, std::span<const double>(values));
}

void text_row(int indent, const char* name, const std::string& text) {
  std::printf("%*s%-*s %s\n", indent, "", 26 - indent, name, text.c_str());
}

std::string primitive_text(uint32_t primitive) { return primitive == kNoPrimitive ? "background" : std::to_string(primitive); }

void print_light(int indent, const LightTrace& trace, const SceneData& scene) {
  const Light& light = scene.lights[static_cast<size_t>(trace.light)];
  const bool point = light.kind == static_cast<int32_t>(LightKind::kPoint);
  std::printf("%*slight %d, %s\n", indent, "", trace.light, point ? "point" : "directional");
  row(indent + 2, "intensity", light.intensity);
  row(indent + 2, "to light", trace.to_light);
  row(indent + 2, "irradiance, facing it", trace.irradiance);
  if (!trace.in_front) text_row(indent + 2, "behind the surface", "the geometric normal does not face the light");
  if (trace.has_ray) {
    row(indent + 2, trace.lifted ? "shadow ray origin, lifted" : "shadow ray origin", trace.origin);
    row(indent + 2, "shadow ray direction", trace.direction);
    row(indent + 2, "shadow ray t_max", trace.t_max);
    if (trace.blocker != kNoPrimitive) text_row(indent + 2, "nearest on the way", "primitive " + std::to_string(trace.blocker));
  }
  text_row(indent + 2, "lit", trace.lit ? "1" : "0");
  row(indent + 2, "radiance if lit", trace.alone);
  row(indent + 2, "sum after it", trace.sum);
}

void print_surface(int indent, const SurfaceTrace& s, const SceneData& scene) {
  text_row(indent, "primitive", primitive_text(s.primitive));
  const std::string name = s.material < scene.material_names.size() ? " '" + scene.material_names[s.material] + "'" : "";
  text_row(indent, "material", std::to_string(s.material) + name);
  if (scene.is_sphere(s.primitive)) {
    row(indent, "sphere: center", scene.sphere(s.primitive).center);
    row(indent, "radius", scene.sphere(s.primitive).radius);
  }
  if (scene.is_plane(s.primitive)) {
    row(indent, "plane: point", scene.plane(s.primitive).point);
    row(indent, "normal", scene.plane(s.primitive).normal);
  }
  for (int j = 0; j < 3 && scene.is_triangle(s.primitive); ++j) {
    const Triangle& triangle = scene.triangles[s.primitive];
    const std::string label = "vertex " + std::to_string(triangle.vertex[j]);
    row(indent, label.c_str(), scene.vertices[triangle.vertex[j]].position);
  }
  row(indent, "t", s.t);
  row(indent, "barycentrics", s.weight);
  row(indent, "position", s.position);
  row(indent, "position error", s.position_error);
  row(indent, "geometric normal", s.geometric_normal);
  row(indent, "shading normal", s.normal);
  row(indent, "view", s.view);
  if (s.lift[0] != 0 || s.lift[1] != 0 || s.lift[2] != 0) row(indent, "lift", s.lift);
  row(indent, "uv (before options)", s.uv);
  row(indent, "dp/dx", s.dpdx);
  row(indent, "dp/dy", s.dpdy);
  row(indent, "ambient", s.ambient);
  row(indent, "diffuse", s.diffuse);
  row(indent, "specular", s.specular);
  row(indent, "shininess", s.shininess);
  row(indent, "emission", s.emission);
  row(indent, "mirror", s.mirror);
  row(indent, "opacity", s.opacity);
  row(indent, "ambient + emission", s.ambient_radiance);
  for (const LightTrace& light : s.lights) print_light(indent, light, scene);
  row(indent, "radiance", s.radiance);
}

void print_level(size_t k, const PixelTrace& trace, const SlotTrace& slot, const SceneData& scene) {
  const LevelTrace& level = slot.levels[k];
  // At the center of a pixel of which all samples see one surface, a smaller one may hide it.
  const auto used = [&](uint32_t seen, bool asked) { return asked && seen == slot.primitive ? "  <- used" : ""; };
  if (k == 0) {
    std::printf("primary ray\n");
    row(2, "eye", trace.eye);
    row(2, "direction (depth 1)", slot.direction);
    text_row(2, "raster sees", primitive_text(slot.raster_primitive) + used(slot.raster_primitive, !trace.by_ray));
    row(2, "raster depth, near / z", slot.raster_depth);
    text_row(2, "ray sees", primitive_text(slot.ray_primitive) + used(slot.ray_primitive, trace.by_ray));
  } else {
    std::printf("mirror ray, bounce %zu\n", k);
    row(2, "origin", level.origin);
    row(2, "direction", level.direction);
    row(2, "weight", level.weight);
  }
  if (level.surface.valid) {
    std::printf("surface, bounce %zu\n", k);
    print_surface(2, level.surface, scene);
  } else {
    std::printf("background\n");
    row(2, "radiance", scene.background);
  }
  for (size_t i = 0; i < level.layers.size(); ++i) {
    std::printf("translucent layer %zu of %zu, farthest first\n", i + 1, level.layers.size());
    print_surface(2, level.layers[i], scene);
  }
  if (level.layers.empty()) return;
  std::printf("composite\n");
  row(2, "radiance over all layers", level.layers_over);
  row(2, "they let through", level.transmittance);
}

// One surface of the pixel, from its primary ray to what comes back.
void print_slot(const PixelTrace& trace, const SlotTrace& slot, const SceneData& scene) {
  const std::string seen = primitive_text(slot.primitive);
  if (slot.quad)
    std::printf("shaded once for 2x2 pixels: %s\n", seen.c_str());
  else if (trace.samples > 1)
    std::printf("seen by %g of %d samples: %s\n", static_cast<double>(slot.weight) * trace.samples, trace.samples,
                seen.c_str());
  if (slot.quad || trace.samples > 1) {
    const double at[2] = {slot.position.x, slot.position.y};
    row(2, "shaded at", std::span<const double>(at));
  }
  for (size_t k = 0; k < slot.levels.size(); ++k) print_level(k, trace, slot, scene);
  for (size_t k = slot.levels.size(); k-- > 1;) {
    std::printf("bounce %zu comes back\n", k);
    row(2, "its radiance", slot.levels[k].radiance);
    row(2, "times", slot.levels[k].weight);
    row(2, "radiance one level up", slot.levels[k - 1].radiance);
  }
}

// Renders the picture and compares its pixel with the derivation, bit for bit.
int verify(const Job& job, const PixelTrace& trace, int x, int y) {
  Renderer renderer;
  Framebuffer picture;
  FrameRequest request;
  request.radiance = request.primitive = true;
  if (auto done = renderer.render(job.scene, job.camera, job.settings, picture, request); !done) return fail(done.error());
  const size_t pixel = static_cast<size_t>(y) * static_cast<size_t>(job.settings.width) + static_cast<size_t>(x);
  const uint8_t* rgba = picture.color.rgba.data() + 4 * pixel;
  const float* radiance = picture.radiance.data() + 3 * pixel;
  const bool equal = std::memcmp(rgba, trace.rgba, 4) == 0 && std::memcmp(radiance, trace.radiance, sizeof trace.radiance) == 0 &&
                     picture.primitive[pixel] == trace.primitive;
  std::printf("rendered picture\n");
  text_row(2, "primitive", primitive_text(picture.primitive[pixel]));
  row(2, "radiance", std::span<const float>(radiance, 3));
  std::printf("  %-24s %d %d %d %d\n", "bytes", rgba[0], rgba[1], rgba[2], rgba[3]);
  text_row(2, "verdict", equal ? "equal to the derivation, bit for bit" : "DIFFERS from the derivation");
  return equal ? kDone : fail("the derivation of pixel " + std::to_string(x) + "," + std::to_string(y) + " differs from the picture");
}

void parse_pixel(const std::string& text, int& x, int& y) {
  const char *begin = text.data(), *end = begin + text.size();
  const auto [comma, bad_x] = std::from_chars(begin, end, x);
  if (bad_x == std::errc() && comma != end && *comma == ',')
    if (const auto [stop, bad_y] = std::from_chars(comma + 1, end, y); bad_y == std::errc() && stop == end) return;
  throw UsageError("why: '" + text + "' is not a pixel X,Y, such as 640,360 (0,0 is the upper left)");
}

int why(const WhyOptions& options) {
  int x = 0, y = 0;
  parse_pixel(options.pixel, x, y);
  Result<Job> loaded = options.frame.load_to_see();
  if (!loaded) return fail(loaded.error());
  const Job& job = loaded.value();
  for (const std::string& text : job.messages) message(text);
  if (x < 0 || y < 0 || x >= job.settings.width || y >= job.settings.height)
    throw UsageError("why: pixel " + options.pixel + " lies outside the picture of " + std::to_string(job.settings.width) + "x" +
                     std::to_string(job.settings.height));
  Result<PixelTrace> traced = trace_pixel(job.scene, job.camera, job.settings, x, y);
  if (!traced) return fail(traced.error());
  const PixelTrace& trace = traced.value();
  std::printf("pixel %d,%d of %dx%d, scene_hash %s, numeric_contract %d\n", x, y, job.settings.width, job.settings.height,
              hash_text(job.scene.hash()).c_str(), kNumericContract);
  for (const auto& [key, value] : settings_words(job.settings)) std::printf("%s=%s ", key.c_str(), value.c_str());
  std::printf("\n");
  const Scene standing = scene_at(job.scene, job.settings.time);
  for (const SlotTrace& slot : trace.slots) print_slot(trace, slot, standing.data());
  std::printf("pixel\n");
  row(2, "radiance", trace.radiance);
  std::printf("  %-24s %d %d %d %d\n", "bytes", trace.rgba[0], trace.rgba[1], trace.rgba[2], trace.rgba[3]);
  return verify(job, trace, x, y);
}

}  // namespace

void add_why(CLI::App& app, Run& run) {
  CLI::App* command = app.add_subcommand("why", "How one pixel comes about, in hexadecimal floats");
  auto options = std::make_shared<WhyOptions>();
  options->frame.add_to(*command);
  command->add_option("PIXEL", options->pixel, "0,0 is the upper left")->type_name("X,Y")->required();
  command->callback([options, &run] { run = [options] { return why(*options); }; });
}

}  // namespace spanray::demo
