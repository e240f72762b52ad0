// Image files -> textures of a scene: 16-bit linear texels with mip levels.
#pragma once
#include <map>
#include <string>
#include <utility>

#include "codec/decode.h"
#include "scene/mtl_library.h"
#include "scene/path_finder.h"

namespace spanray {

// Appends a texture with all its levels and returns its index. color: red, green and blue are sRGB-encoded; alpha never is.
// 8-bit samples that are not colors become v * 257. Grey fills r, g and b; alpha is 65535 where there is none.
// Errors (no file named): sides out of 1..16384, samples missing, more than 2^31 - 1 texels in the scene.
Result<int32_t> append_texture(const RawImage& image, bool color, SceneData& scene);

// One level from the next larger one.
// Box filter with exact integer area weights, rounded half up; any sizes with dst = max(1, src / 2).
// Source:   the area average of Williams 1983, "Pyramidal Parametrics", for sizes that are no powers of 2.
// Input:    row-major texels.   Output: the mean of the covered source area for each texel and channel, |error| <= 1/2.
void box_filter(const Texel* src, int src_width, int src_height, Texel* dst, int dst_width, int dst_height);

// Loads each file once a kind (color or not), and warns once a file that cannot be used.
class TextureLoader {
 public:
  TextureLoader(PathFinder& finder, SceneData& scene, Messages& messages)
      : finder_(finder), scene_(scene), messages_(messages) {}

  // Index of a new TextureUse, or -1 where the file is missing or broken. Looks in mtl_file's folder, then in obj_folder.
  // A map_d with an alpha channel in its file is read from that channel.
  int32_t use(MtlMap slot, const MtlTexture& texture, const std::string& mtl_file, const std::string& obj_folder);

 private:
  struct Loaded {
    int32_t texture = -1;
    bool has_alpha = false, gray = false;
  };
  Loaded load(const std::string& path, bool color, const std::string& mtl_file, const MtlTexture& texture);

  PathFinder& finder_;
  SceneData& scene_;
  Messages& messages_;
  std::map<std::pair<std::string, bool>, Loaded> loaded_;  // by path and kind
  std::map<std::string, bool> missing_;                    // names already warned about
};

}  // namespace spanray
