#include "gl_texture.h"

#include <algorithm>
#include <vector>

#include "math/color.h"

namespace spanray::peers {
namespace {

constexpr int kMaskLastLevel = 2;

GLint min_filter(Filter filter) {
  switch (filter) {
    case Filter::kNearest: return GL_NEAREST_MIPMAP_NEAREST;
    case Filter::kBilinear: return GL_LINEAR_MIPMAP_NEAREST;
    case Filter::kTrilinear: return GL_LINEAR_MIPMAP_LINEAR;
  }
  return GL_LINEAR;
}

GLuint begin_texture(const TextureUse& use, Filter filter, int last_level) {
  GLuint name = 0;
  glGenTextures(1, &name);
  glBindTexture(GL_TEXTURE_2D, name);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, min_filter(filter));
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter == Filter::kNearest ? GL_NEAREST : GL_LINEAR);
  const GLint wrap = use.clamp != 0 ? GL_CLAMP_TO_EDGE : GL_REPEAT;
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, wrap);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, wrap);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, last_level);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  return name;
}

struct Level { const Texel* texels; int width, height; size_t size; };
Level level_of(const SceneData& scene, const Texture& t, int k) {
  const int w = std::max(1, t.width >> k), h = std::max(1, t.height >> k);
  return {scene.texels.data() + t.offset[k], w, h, static_cast<size_t>(w) * static_cast<size_t>(h)};
}

uint8_t encoded(uint16_t linear) { return srgb8_from_linear(static_cast<float>(linear) / 65535.0f); }

uint16_t channel_of(const Texel& t, int32_t channel) {
  const uint16_t c[4] = {t.r, t.g, t.b, t.a};
  if (channel >= 0 && channel < 4) return c[channel];
  const double luminance = 0.2126 * t.r + 0.7152 * t.g + 0.0722 * t.b;
  return static_cast<uint16_t>(luminance + 0.5);
}

GLuint make_channel_texture(const SceneData& scene, const TextureUse& use, Filter filter, int last) {
  const Texture& t = scene.textures[static_cast<size_t>(use.texture)];
  const GLuint name = begin_texture(use, filter, last);
  std::vector<uint16_t> values;
  for (int k = 0; k <= last; ++k) {
    const Level level = level_of(scene, t, k);
    values.resize(level.size);
    for (size_t i = 0; i < level.size; ++i) values[i] = channel_of(level.texels[i], use.channel);
    glTexImage2D(GL_TEXTURE_2D, k, GL_R16, level.width, level.height, 0, GL_RED, GL_UNSIGNED_SHORT, values.data());
  }
  return name;
}

}  // namespace

GLuint make_color_texture(const SceneData& scene, const TextureUse& use, Filter filter, TexelFormat format) {
  const Texture& t = scene.textures[static_cast<size_t>(use.texture)];
  const GLuint name = begin_texture(use, filter, t.levels - 1);
  std::vector<uint8_t> bytes;
  for (int k = 0; k < t.levels; ++k) {
    const Level level = level_of(scene, t, k);
    if (format == TexelFormat::kRgba16) {
      glTexImage2D(GL_TEXTURE_2D, k, GL_RGBA16, level.width, level.height, 0, GL_RGBA, GL_UNSIGNED_SHORT, level.texels);
      continue;
    }
    bytes.resize(4 * level.size);
    for (size_t i = 0; i < level.size; ++i) {
      const Texel& texel = level.texels[i];
      bytes[4 * i] = encoded(texel.r), bytes[4 * i + 1] = encoded(texel.g), bytes[4 * i + 2] = encoded(texel.b), bytes[4 * i + 3] = 255;
    }
    glTexImage2D(GL_TEXTURE_2D, k, GL_SRGB8_ALPHA8, level.width, level.height, 0, GL_RGBA, GL_UNSIGNED_BYTE, bytes.data());
  }
  return name;
}

GLuint make_mask_texture(const SceneData& scene, const TextureUse& use, Filter filter) {
  const int levels = scene.textures[static_cast<size_t>(use.texture)].levels;
  return make_channel_texture(scene, use, filter, std::min(kMaskLastLevel, levels - 1));
}

GLuint make_height_texture(const SceneData& scene, const TextureUse& use) {
  return make_channel_texture(scene, use, Filter::kBilinear, scene.textures[static_cast<size_t>(use.texture)].levels - 1);
}

}  // namespace spanray::peers
