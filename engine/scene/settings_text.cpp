#include "spanray/settings_text.h"

#include <algorithm>

namespace spanray {
namespace {

constexpr EnumName<Isa> kIsaNames[] = {
    {Isa::kAuto, "auto"}, {Isa::kScalar, "scalar"}, {Isa::kSse4, "sse4"}, {Isa::kAvx2, "avx2"}, {Isa::kAvx512, "avx512"}};
constexpr EnumName<Shading> kShadingNames[] = {
    {Shading::kFlat, "flat"}, {Shading::kGouraud, "gouraud"}, {Shading::kPhong, "phong"}};
constexpr EnumName<Shadows> kShadowsNames[] = {{Shadows::kNone, "none"}, {Shadows::kRay, "ray"}};
constexpr EnumName<Reflections> kReflectionsNames[] = {{Reflections::kNone, "none"}, {Reflections::kRay, "ray"}};
constexpr EnumName<Visibility> kVisibilityNames[] = {{Visibility::kRaster, "raster"}, {Visibility::kRay, "ray"}};
constexpr EnumName<Filter> kFilterNames[] = {
    {Filter::kNearest, "nearest"}, {Filter::kBilinear, "bilinear"}, {Filter::kTrilinear, "trilinear"}};
constexpr EnumName<Transparency> kTransparencyNames[] = {{Transparency::kScene, "scene"},
                                                         {Transparency::kNone, "none"},
                                                         {Transparency::kAlpha, "alpha"},
                                                         {Transparency::kScreenDoor, "screen-door"}};
constexpr EnumName<Culling> kCullingNames[] = {{Culling::kNone, "none"}, {Culling::kBack, "back"}};
constexpr EnumName<Antialiasing> kAntialiasingNames[] = {{Antialiasing::kMultisample, "multisample"},
                                                         {Antialiasing::kSupersample, "supersample"}};
constexpr EnumName<Normals> kNormalsNames[] = {{Normals::kInterpolated, "interpolated"},
                                               {Normals::kRenormalized, "renormalized"}};
constexpr EnumName<Powers> kPowersNames[] = {{Powers::kFast, "fast"}, {Powers::kExact, "exact"}};
constexpr EnumName<ShadingRate> kShadingRateNames[] = {{ShadingRate::k2x2, "2x2"}, {ShadingRate::k1x1, "1x1"}};
constexpr EnumName<TreeQuality> kTreeQualityNames[] = {{TreeQuality::kFast, "fast"}, {TreeQuality::kHigh, "high"}};
constexpr EnumName<LightGridUse> kLightGridUseNames[] = {
    {LightGridUse::kAuto, "auto"}, {LightGridUse::kNever, "never"}, {LightGridUse::kAlways, "always"}};
constexpr EnumName<ShadowTerminator> kShadowTerminatorNames[] = {{ShadowTerminator::kOff, "off"},
                                                                 {ShadowTerminator::kLifted, "lifted"}};

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

// Number of insertions, deletions, replacements and exchanges of neighbours that turn a into b, case ignored.
// Source: Damerau 1964, in its restricted form ("optimal string alignment").
size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<size_t>> d(a.size() + 1, std::vector<size_t>(b.size() + 1));
  for (size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  for (size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
  for (size_t i = 1; i <= a.size(); ++i)
    for (size_t j = 1; j <= b.size(); ++j) {
      const char ca = lower(a[i - 1]), cb = lower(b[j - 1]);
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (ca != cb ? 1u : 0u)});
      if (i > 1 && j > 1 && ca == lower(b[j - 2]) && lower(a[i - 2]) == cb) d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

}  // namespace

template <>
std::span<const EnumName<Isa>> enum_names<Isa>() {
  return kIsaNames;
}
template <>
std::span<const EnumName<Shading>> enum_names<Shading>() {
  return kShadingNames;
}
template <>
std::span<const EnumName<Shadows>> enum_names<Shadows>() {
  return kShadowsNames;
}
template <>
std::span<const EnumName<Reflections>> enum_names<Reflections>() {
  return kReflectionsNames;
}
template <>
std::span<const EnumName<Visibility>> enum_names<Visibility>() {
  return kVisibilityNames;
}
template <>
std::span<const EnumName<Filter>> enum_names<Filter>() {
  return kFilterNames;
}
template <>
std::span<const EnumName<Transparency>> enum_names<Transparency>() {
  return kTransparencyNames;
}
template <>
std::span<const EnumName<Culling>> enum_names<Culling>() {
  return kCullingNames;
}
template <>
std::span<const EnumName<Antialiasing>> enum_names<Antialiasing>() {
  return kAntialiasingNames;
}
template <>
std::span<const EnumName<Normals>> enum_names<Normals>() {
  return kNormalsNames;
}
template <>
std::span<const EnumName<Powers>> enum_names<Powers>() {
  return kPowersNames;
}
template <>
std::span<const EnumName<ShadingRate>> enum_names<ShadingRate>() {
  return kShadingRateNames;
}
template <>
std::span<const EnumName<TreeQuality>> enum_names<TreeQuality>() {
  return kTreeQualityNames;
}
template <>
std::span<const EnumName<LightGridUse>> enum_names<LightGridUse>() {
  return kLightGridUseNames;
}
template <>
std::span<const EnumName<ShadowTerminator>> enum_names<ShadowTerminator>() {
  return kShadowTerminatorNames;
}

std::string nearest_word(std::string_view word, const std::vector<std::string>& known) {
  if (word.size() > 64) return {};
  std::string best;
  size_t best_distance = std::max<size_t>(1, word.size() / 3) + 1;
  for (const std::string& candidate : known) {
    if (candidate.size() > 64) continue;
    const size_t distance = edit_distance(word, candidate);
    if (distance >= best_distance) continue;
    best_distance = distance;
    best = candidate;
  }
  if (best.empty() && word.size() >= 2)  // the beginning of a word: "fov" for "fov_y"
    for (const std::string& candidate : known)
      if (candidate.size() > word.size() && edit_distance(word, std::string_view(candidate).substr(0, word.size())) == 0)
        return candidate;
  return best;
}

std::string did_you_mean(std::string_view word, const std::vector<std::string>& known) {
  std::string near = nearest_word(word, known);
  for (char& c : near)
    if (static_cast<unsigned char>(c) < 32 || c == 127) c = '?';  // names from files reach the terminal
  return near.empty() ? std::string() : " (did you mean '" + near + "'?)";
}

}  // namespace spanray
