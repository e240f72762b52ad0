// The golden frames: what the determinism matrix renders. Their hashes stand in tests/golden/frames.txt.
#pragma once
#include <ostream>
#include <string>
#include <vector>

#include "spanray/settings.h"

namespace spanray {

struct GoldenFrame {
  std::string name, scene;  // scene: file in assets/
  size_t camera = 0;        // index into the scene's cameras
  Settings settings;
};

inline void PrintTo(const GoldenFrame& frame, std::ostream* out) { *out << frame.name; }

inline std::vector<GoldenFrame> golden_frames() {
  std::vector<GoldenFrame> frames;
  const auto add = [&](std::string name, std::string scene, size_t camera, auto change) {
    GoldenFrame f{std::move(name), std::move(scene), camera, {}};
    f.settings.width = 320, f.settings.height = 180;
    change(f.settings);
    frames.push_back(std::move(f));
  };
  const auto all_on = [](Settings&) {};
  add("cornell", "cornell.toml", 0, all_on);
  add("cornell_flat", "cornell.toml", 1, [](Settings& s) { s.shading = Shading::kFlat; });
  add("cornell_rays", "cornell.toml", 0, [](Settings& s) { s.visibility = Visibility::kRay; });
  add("spheres", "spheres.toml", 0, all_on);
  add("spheres_gouraud", "spheres.toml", 0, [](Settings& s) { s.shading = Shading::kGouraud; });
  add("spheres_nearest", "spheres.toml", 1, [](Settings& s) { s.filter = Filter::kNearest, s.shadows = Shadows::kNone; });
  add("columns", "columns.toml", 0, all_on);
  add("columns_bilinear", "columns.toml", 1, [](Settings& s) { s.filter = Filter::kBilinear, s.bump = false; });
  add("columns_odd_size", "columns.toml", 0, [](Settings& s) { s.width = 197, s.height = 131, s.culling = Culling::kBack; });
  add("gauze", "gauze.toml", 0, all_on);
  add("gauze_rays", "gauze.toml", 1, [](Settings& s) { s.visibility = Visibility::kRay; });
  add("glass", "glass.toml", 0, all_on);
  add("glass_rays", "glass.toml", 1, [](Settings& s) { s.visibility = Visibility::kRay, s.shading = Shading::kGouraud; });
  add("glass_screen_door", "glass.toml", 0, [](Settings& s) { s.transparency = Transparency::kScreenDoor; });
  add("hall", "hall.toml", 0, all_on);
  add("hall_aisle", "hall.toml", 1, all_on);
  add("orrery", "orrery.toml", 0, [](Settings& s) { s.time = 3; });
  add("molecule", "molecule.toml", 0, [](Settings& s) { s.shading = Shading::kGouraud; });
  add("molecule_rays", "molecule.toml", 1, [](Settings& s) { s.visibility = Visibility::kRay; });
  add("orrery_later_rays", "orrery.toml", 1, [](Settings& s) { s.time = 11.5, s.visibility = Visibility::kRay; });
  add("dahlia", "dahlia.toml", 0, all_on);
  add("henge", "henge.toml", 0, all_on);
  add("henge_rays", "henge.toml", 1, [](Settings& s) { s.visibility = Visibility::kRay, s.shading = Shading::kGouraud; });
  add("dahlia_rays", "dahlia.toml", 1, [](Settings& s) { s.visibility = Visibility::kRay; });
  const auto samples = [](int count, Antialiasing mode) {
    return [=](Settings& s) { s.width = 160, s.height = 90, s.samples = count, s.antialiasing = mode; };
  };
  add("hall_samples", "hall.toml", 0, samples(4, Antialiasing::kMultisample));
  add("spheres_supersamples", "spheres.toml", 0, samples(4, Antialiasing::kSupersample));
  add("glass_samples", "glass.toml", 0, samples(8, Antialiasing::kMultisample));
  add("gauze_samples_rays", "gauze.toml", 0, [=](Settings& s) {
    samples(16, Antialiasing::kMultisample)(s);
    s.visibility = Visibility::kRay;
  });
  add("spheres_quads", "spheres.toml", 0, [](Settings& s) { s.shading_rate = ShadingRate::k2x2; });
  add("glass_quads_rays", "glass.toml", 0, [](Settings& s) {
    s.width = 197, s.height = 131, s.visibility = Visibility::kRay, s.shading_rate = ShadingRate::k2x2;
  });
  add("hall_quads_samples", "hall.toml", 0, [=](Settings& s) {
    samples(4, Antialiasing::kMultisample)(s);
    s.shading_rate = ShadingRate::k2x2;
  });
  add("spheres_fast", "spheres.toml", 0, [](Settings& s) { s.normals = Normals::kInterpolated, s.powers = Powers::kFast; });
  add("columns_fast_gouraud", "columns.toml", 0, [](Settings& s) { s.shading = Shading::kGouraud, s.powers = Powers::kFast; });
  add("molecule_samples", "molecule.toml", 0, samples(4, Antialiasing::kMultisample));
  add("molecule_quads", "molecule.toml", 0, [](Settings& s) { s.shading_rate = ShadingRate::k2x2; });
  add("henge_samples", "henge.toml", 0, samples(4, Antialiasing::kMultisample));
  add("henge_quads_rays", "henge.toml", 0, [](Settings& s) {
    s.width = 197, s.height = 131, s.visibility = Visibility::kRay, s.shading_rate = ShadingRate::k2x2;
  });
  const auto lifted = [](Settings& s) { s.shadow_terminator = ShadowTerminator::kLifted; };
  add("hall_lifted", "hall.toml", 0, lifted);
  add("columns_lifted_gouraud_rays", "columns.toml", 0, [=](Settings& s) {
    lifted(s);
    s.width = 197, s.height = 131, s.visibility = Visibility::kRay, s.shading = Shading::kGouraud, s.samples = 4;
  });
  return frames;
}

}  // namespace spanray
