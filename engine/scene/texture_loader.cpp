#include "scene/texture_loader.h"

#include <algorithm>
#include <limits>

#include "math/color.h"

namespace spanray {
namespace {

// 16-bit sRGB samples to linear light times 65535, rounded half up.
const std::vector<uint16_t>& linear_from_srgb16() {
  static const std::vector<uint16_t> table = [] {
    std::vector<uint16_t> t(65536);
    for (size_t i = 0; i < t.size(); ++i)
      t[i] = static_cast<uint16_t>(static_cast<double>(linear_from_srgb(static_cast<float>(i) / 65535.0f)) * 65535.0 + 0.5);
    return t;
  }();
  return table;
}

Texel texel_of(const uint16_t* s, int channels, int bits, bool color) {
  const auto data = [&](uint16_t v) { return static_cast<uint16_t>(bits == 8 ? std::min<int>(v, 255) * 257 : v); };
  const auto light = [&](uint16_t v) {
    if (!color) return data(v);
    return bits == 8 ? linear16_from_srgb8(static_cast<uint8_t>(std::min<int>(v, 255))) : linear_from_srgb16()[v];
  };
  const bool grey = channels <= 2;
  const uint16_t r = light(s[0]);
  const uint16_t a = channels == 2 ? data(s[1]) : channels == 4 ? data(s[3]) : uint16_t{65535};
  return {r, grey ? r : light(s[1]), grey ? r : light(s[2]), a};
}

// The source texels that one destination texel covers along an axis, with integer weights of sum src.
struct Tap {
  int first, count;
  int64_t weight[3];
};

Tap tap_of(int j, int src, int dst) {
  Tap tap{};
  const int64_t begin = static_cast<int64_t>(j) * src, end = begin + src;
  tap.first = static_cast<int>(begin / dst);
  for (int64_t i = tap.first; i * dst < end; ++i)
    tap.weight[tap.count++] = std::min((i + 1) * dst, end) - std::max(i * dst, begin);
  return tap;
}

}  // namespace

void box_filter(const Texel* src, int src_width, int src_height, Texel* dst, int dst_width, int dst_height) {
  std::vector<Tap> columns;
  for (int x = 0; x < dst_width; ++x) columns.push_back(tap_of(x, src_width, dst_width));
  const int64_t total = static_cast<int64_t>(src_width) * src_height;
  for (int y = 0; y < dst_height; ++y) {
    const Tap row = tap_of(y, src_height, dst_height);
    for (const Tap& column : columns) {
      int64_t sum[4] = {0, 0, 0, 0};
      for (int j = 0; j < row.count; ++j) {
        const Texel* line = src + static_cast<int64_t>(row.first + j) * src_width + column.first;
        for (int i = 0; i < column.count; ++i) {
          const int64_t w = row.weight[j] * column.weight[i];
          sum[0] += w * line[i].r, sum[1] += w * line[i].g, sum[2] += w * line[i].b, sum[3] += w * line[i].a;
        }
      }
      const auto mean = [&](int64_t s) { return static_cast<uint16_t>((2 * s + total) / (2 * total)); };
      *dst++ = {mean(sum[0]), mean(sum[1]), mean(sum[2]), mean(sum[3])};
    }
  }
}

Result<int32_t> append_texture(const RawImage& image, bool color, SceneData& scene) {
  if (image.width < 1 || image.height < 1 || image.width > kMaxImageSide || image.height > kMaxImageSide)
    return Error{"image of " + std::to_string(image.width) + " x " + std::to_string(image.height) +
                 " pixels; 1 to 16384 a side"};
  const size_t pixels = static_cast<size_t>(image.width) * static_cast<size_t>(image.height);
  if (image.channels < 1 || image.channels > 4 || image.samples.size() != pixels * static_cast<size_t>(image.channels))
    return Error{"damaged image: " + std::to_string(image.samples.size()) + " samples"};
  Texture texture;
  texture.width = image.width;
  texture.height = image.height;
  size_t total = scene.texels.size();
  for (int w = image.width, h = image.height;; w = std::max(1, w / 2), h = std::max(1, h / 2)) {
    if (total <= static_cast<size_t>(std::numeric_limits<int32_t>::max()))
      texture.offset[texture.levels] = static_cast<int32_t>(total);
    total += static_cast<size_t>(w) * static_cast<size_t>(h);
    ++texture.levels;
    if (w == 1 && h == 1) break;
  }
  // Lanes gather a texel as two words, so twice its index must fit 32 bits.
  if (total > static_cast<size_t>(std::numeric_limits<int32_t>::max() / 2))
    return Error{"too many texels: at most 2^30 - 1 in a scene"};
  scene.texels.resize(total);
  Texel* out = scene.texels.data() + texture.offset[0];
  for (size_t i = 0; i < pixels; ++i)
    out[i] = texel_of(image.samples.data() + i * static_cast<size_t>(image.channels), image.channels, image.bits, color);
  int w = image.width, h = image.height;
  for (int level = 1; level < texture.levels; ++level) {
    const int next_w = std::max(1, w / 2), next_h = std::max(1, h / 2);
    box_filter(scene.texels.data() + texture.offset[level - 1], w, h, scene.texels.data() + texture.offset[level], next_w,
               next_h);
    w = next_w, h = next_h;
  }
  scene.textures.push_back(texture);
  return static_cast<int32_t>(scene.textures.size() - 1);
}

TextureLoader::Loaded TextureLoader::load(const std::string& path, bool color, const std::string& mtl_file,
                                          const MtlTexture& texture) {
  const auto [it, is_new] = loaded_.try_emplace({path, color});
  if (!is_new) return it->second;
  const auto unusable = [&](const Error& e) {
    messages_.warn(mtl_file, texture.line, "texture " + quoted(texture.name) + " left out: " + e.to_string());
    return Loaded{};
  };
  const Result<RawImage> image = decode_image_file(path);
  if (!image) return unusable(image.error());
  const Result<int32_t> index = append_texture(image.value(), color, scene_);
  if (!index) return unusable(index.error());
  scene_.texture_names.push_back(path);
  const RawImage& raw = image.value();
  const uint16_t opaque = raw.bits == 8 ? 255 : 65535;
  if (raw.channels == 2 || raw.channels == 4)
    for (size_t i = static_cast<size_t>(raw.channels) - 1; i < raw.samples.size(); i += static_cast<size_t>(raw.channels))
      it->second.has_alpha = it->second.has_alpha || raw.samples[i] != opaque;
  const Texture& made = scene_.textures.back();
  const size_t pixels = static_cast<size_t>(made.width) * static_cast<size_t>(made.height);
  const Texel* const texels = scene_.texels.data() + made.offset[0];
  it->second.gray = std::all_of(texels, texels + pixels, [](const Texel& t) { return t.r == t.g && t.g == t.b; });
  it->second.texture = index.value();
  return it->second;
}

int32_t TextureLoader::use(MtlMap slot, const MtlTexture& texture, const std::string& mtl_file, const std::string& obj_folder) {
  Result<std::string> path = finder_.find(folder_of(mtl_file), texture.name);
  if (!path && folder_of(mtl_file) != obj_folder)
    if (Result<std::string> other = finder_.find(obj_folder, texture.name)) path = std::move(other);
  if (!path) {
    if (!std::exchange(missing_[texture.name], true))
      messages_.warn(mtl_file, texture.line, std::string(mtl_map_name(slot)) + " left out: " + path.error().message);
    return -1;
  }
  const Loaded loaded = load(path.value(), is_color(slot), mtl_file, texture);
  if (loaded.texture < 0) return -1;
  TextureUse use = texture.use;
  use.texture = loaded.texture;
  if (slot == MtlMap::kD && use.channel < 0 && loaded.has_alpha) use.channel = 3;
  // The luminance of gray is each of its channels: height maps of one are kept in rows (scene/height_rows.h).
  if (!is_color(slot) && loaded.gray && (use.channel < 0 || use.channel == 4)) use.channel = 1;
  scene_.texture_uses.push_back(use);
  return static_cast<int32_t>(scene_.texture_uses.size() - 1);
}

}  // namespace spanray
