// Textures in double: filters without quantised weights.
#pragma once
#include "math/vec.h"
#include "scene/scene_data.h"

namespace spanray::reference {

// How another renderer may read a texture (ambiguity.h): beside the place by so many texels of the level that is read, from
// another level of detail, by another measure of the footprint. Zero: the model.
struct Nudge {
  double x = 0, y = 0, levels = 0;
  // -1, 1: the least and the greatest footprint that OpenGL 4.6, 8.14.1, allows: max(mu, mv) and mu + mv.
  int footprint = 0;
};

// Texture coordinates of the mesh at a point, and how they change by a step of one pixel in x and in y.
struct Coordinates {
  double u = 0, v = 0, du_dx = 0, dv_dx = 0, du_dy = 0, dv_dy = 0;
  Nudge nudge = {};
};

class Textures {
 public:
  Textures(const SceneData& scene, Filter filter) : scene_(scene), filter_(filter) {}

  // Channels in [0, 1], not remapped. Level of detail: log2 of the longer side of the pixel's parallelogram in texels (Williams
  // 1983; OpenGL 4.6, 8.14), at most last_level; nearest and bilinear take the nearest level, trilinear blends two.
  glm::dvec4 sample(const TextureUse& use, const Coordinates& at, double last_level = 1e9) const;
  // base + gain * sample, per channel not below 0.
  glm::dvec3 color(const TextureUse& use, const Coordinates& at) const;
  // base + gain * the channel that -imfchan names, or luminance (Rec. 709).
  double scalar(const TextureUse& use, const Coordinates& at, double last_level = 1e9) const;
  // Slopes of a height map along s and t (up): bm times the difference of heights over one texel, per texel of level 0. Central
  // differences of bilinear samples half a texel to either side.
  glm::dvec2 slopes(const TextureUse& use, const Coordinates& at) const;

 private:
  struct Levels {
    int first;
    double weight;
  };  // of the next one
  Levels levels(const TextureUse& use, const Coordinates& at, double last_level) const;
  glm::dvec4 texel(const TextureUse& use, int level, int x, int y) const;
  // Where the point lies on a level, in texels from its upper left corner.
  glm::dvec2 place(const TextureUse& use, const Coordinates& at, int level) const;
  glm::dvec4 bilinear(const TextureUse& use, int level, const glm::dvec2& place) const;
  const Texture& texture(const TextureUse& use) const { return scene_.textures[static_cast<size_t>(use.texture)]; }
  static double channel(const TextureUse& use, const glm::dvec4& c);

  const SceneData& scene_;
  const Filter filter_;
};

}  // namespace spanray::reference
