#include "scene/height_rows.h"

#include <algorithm>
#include <map>
#include <utility>

namespace spanray {
namespace {

constexpr size_t kMostHeights = size_t{1} << 30;  // indices of lanes have 31 bits
constexpr int kRepeated = 2;

uint16_t channel_of(const Texel& t, int32_t channel) {
  const uint16_t of[4] = {t.r, t.g, t.b, t.a};
  return of[channel];
}

size_t heights_of(const Texture& t) {
  size_t n = 0;
  for (int level = 0; level < t.levels; ++level)
    n += static_cast<size_t>(std::max(1, t.width >> level) + kRepeated) * static_cast<size_t>(std::max(1, t.height >> level));
  return n;
}

HeightRows append_rows(const Texture& t, int32_t channel, SceneData& scene) {
  HeightRows rows{};
  scene.heights.reserve(scene.heights.size() + heights_of(t));
  for (int level = 0; level < t.levels; ++level) {
    rows.offset[level] = static_cast<int32_t>(scene.heights.size());
    const int width = std::max(1, t.width >> level), height = std::max(1, t.height >> level);
    const Texel* row = scene.texels.data() + t.offset[level];
    for (int y = 0; y < height; ++y, row += width) {
      for (int x = 0; x < width; ++x) scene.heights.push_back(channel_of(row[x], channel));
      for (int x = 0; x < kRepeated; ++x) scene.heights.push_back(channel_of(row[x % width], channel));
    }
  }
  return rows;
}

}  // namespace

void make_height_rows(SceneData& scene) {
  HeightRows none{};
  none.offset[0] = -1;
  scene.height_rows.assign(scene.texture_uses.size(), none);
  scene.heights.clear();
  std::map<std::pair<int32_t, int32_t>, HeightRows> made;  // by texture and channel
  for (const Material& m : scene.materials) {
    if (m.map_bump < 0) continue;
    const TextureUse& use = scene.texture_uses[static_cast<size_t>(m.map_bump)];
    if (use.texture < 0 || use.clamp != 0 || use.channel < 0 || use.channel > 3) continue;
    const Texture& texture = scene.textures[static_cast<size_t>(use.texture)];
    const auto [it, is_new] = made.try_emplace({use.texture, use.channel}, none);
    if (is_new && scene.heights.size() + heights_of(texture) <= kMostHeights) it->second = append_rows(texture, use.channel, scene);
    scene.height_rows[static_cast<size_t>(m.map_bump)] = it->second;
  }
  if (made.empty()) scene.height_rows.clear();
}

}  // namespace spanray
