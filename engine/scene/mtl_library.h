// What an MTL file says, before it becomes materials. tinyobjloader's MTL reader is not used: it keeps no line numbers, takes
// an absent Kd for black and drops Tr beside d.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "scene/scene_data.h"
#include "scene/text_input.h"
#include "spanray/result.h"

namespace spanray {

// The fields of MTL that have numbers, and those that have textures.
enum class MtlField { kKa, kKd, kKs, kKe, kTf, kNs, kNi, kD, kTr, kIllum, kCount };
enum class MtlMap { kKa, kKd, kKs, kNs, kKe, kD, kBump, kNormal, kCount };

struct MtlNumbers {
  int line = 0;  // 0: not given
  float value[3] = {0, 0, 0};
};
struct MtlTexture {
  int line = 0;  // 0: not given
  std::string name;
  TextureUse use;  // its texture is not set yet
};
struct MtlMaterial {
  std::string name;
  int line = 0;
  MtlNumbers numbers[static_cast<int>(MtlField::kCount)];
  MtlTexture maps[static_cast<int>(MtlMap::kCount)];
  const MtlNumbers& operator[](MtlField f) const { return numbers[static_cast<int>(f)]; }
  const MtlTexture& operator[](MtlMap m) const { return maps[static_cast<int>(m)]; }
};

inline bool is_color(MtlMap map) {
  return map == MtlMap::kKa || map == MtlMap::kKd || map == MtlMap::kKs || map == MtlMap::kKe;
}
const char* mtl_map_name(MtlMap map);

// Never fails: what it cannot use it warns about, with file and line, and leaves out. Values are as written, unchecked but
// finite.
std::vector<MtlMaterial> read_mtl(std::string_view text, const std::string& file, Messages& messages);

// Numbers of a material, textures left out. Choices:
// - Ka absent or zero: ambient = Kd. Kd absent: 0.8, or 1 where there is a map_Kd. d wins over Tr = 1 - d.
// - illum 0 (constant color): Kd is emitted, nothing is reflected. 1: no highlight. 3, 5, 8: mirror = Ks (8, "reflection
// without
//   ray tracing", is the same here). 4, 6, 7, 9 (glass): blended by d, no mirror. 10 and unknown: as 2, with a warning.
// - opacity < 1: kAlpha; with a map_d: kMask and opacity 1.
// Colors are clamped to >= 0, Kd, Tf and opacity to [0, 1], Ns to [0, 1e4], each with a warning.
Material convert_material(const MtlMaterial& mtl, const std::string& file, Messages& messages);

}  // namespace spanray
