// Settings by one word, between which most users choose. `report` measures each of them on the user's own scene.
#pragma once
#include <string>

#include "spanray/settings.h"

namespace spanray::demo {

struct Preset {
  const char* name;
  const char* what;        // for people
  void (*set)(Settings&);  // techniques only: neither size nor threads
};

// Knobs that no preset turns. 2x2 with four samples is beaten by one sample, without rays it saves nothing
// (docs/decisions/0012-shading-rate.md).
inline void exact_details(Settings& s) {
  s.normals = Normals::kRenormalized, s.powers = Powers::kExact, s.shading_rate = ShadingRate::k1x1;
}

inline constexpr Preset kPresets[] = {
    {"draft", "no rays: no shadows, no mirrors, no bump; bilinear textures, 1 sample",
     [](Settings& s) {
       exact_details(s);
       s.shading = Shading::kPhong, s.shadows = Shadows::kNone, s.reflections = Reflections::kNone,
       s.visibility = Visibility::kRaster;
       s.filter = Filter::kBilinear, s.textures = true, s.bump = false, s.samples = 1,
       s.antialiasing = Antialiasing::kMultisample;
     }},
    {"balanced", "shadows, one bounce of mirrors, bump; trilinear textures, 4 samples, each surface shaded once a pixel",
     [](Settings& s) {
       exact_details(s);
       s.shading = Shading::kPhong, s.shadows = Shadows::kRay, s.reflections = Reflections::kRay, s.max_bounces = 1;
       s.visibility = Visibility::kRaster, s.filter = Filter::kTrilinear, s.textures = s.bump = true;
       s.samples = 4, s.antialiasing = Antialiasing::kMultisample;
     }},
    {"exact", "every technique that there is, as many bounces as the scene asks for; 16 samples, each shaded",
     [](Settings& s) {
       exact_details(s);
       s.shading = Shading::kPhong, s.shadows = Shadows::kRay, s.reflections = Reflections::kRay,
       s.visibility = Visibility::kRaster;
       s.filter = Filter::kTrilinear, s.textures = s.bump = true, s.samples = 16, s.antialiasing = Antialiasing::kSupersample;
     }},
};

// nullptr: there is none of that name.
inline const Preset* preset_from_text(const std::string& name) {
  for (const Preset& preset : kPresets)
    if (name == preset.name) return &preset;
  return nullptr;
}

}  // namespace spanray::demo
