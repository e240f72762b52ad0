#include "scenes.h"

#include <filesystem>

#include "core/atomic_file.h"
#include "textures.h"

namespace spanray::assets {

std::map<std::string, SceneFiles> make_scenes() {
  return {{"cornell", make_cornell()}, {"spheres", make_spheres()}, {"columns", make_columns()}, {"gauze", make_gauze()}, {"glass", make_glass()}};
}

std::map<std::string, Picture> make_textures() {
  return {{"textures/brick.png", brick_color(512)},
          {"textures/brick_height.png", brick_height(512)},
          {"textures/ceramic.png", ceramic_color(512, 256)},
          {"textures/chessboard.png", chessboard_color(512)},
          {"textures/foliage.png", foliage_color(256)},
          {"textures/foliage_height.png", foliage_height(256)},
          {"textures/gauze.png", gauze_color(128)},
          {"textures/globe.png", globe_color(512, 256)},
          {"textures/ironwork.png", ironwork_mask(512)},
          {"textures/leaf.png", leaf_color(128)},
          {"textures/leaf_mask.png", leaf_mask(128)},
          {"textures/limestone.png", limestone_color(256)},
          {"textures/limestone_height.png", limestone_height(256)},
          {"textures/marble_red.png", marble_color(256, {0.50, 0.20, 0.16}, {0.88, 0.76, 0.68}, 11)},
          {"textures/marble_white.png", marble_color(256, {0.90, 0.89, 0.86}, {0.44, 0.45, 0.49}, 21)},
          {"textures/plank.png", plank_color(256, 256)},
          {"textures/plank_height.png", plank_height(256, 256)},
          {"textures/ripple_height.png", ripple_height(256)},
          {"textures/slab.png", slab_color(512)},
          {"textures/slab_height.png", slab_height(256)},
          {"textures/terrazzo.png", terrazzo_color(256)}};
}

Result<void> write_assets(const std::string& folder) {
  std::error_code failed;
  std::filesystem::create_directories(folder + "/textures", failed);
  if (failed) return Error{"cannot make this folder: " + failed.message(), folder + "/textures"};
  for (const auto& [name, scene] : make_scenes()) {
    const std::string path = folder + "/" + name;
    for (const auto& [extension, text] : {std::pair{".obj", scene.mesh.text()}, {".mtl", scene.mtl}, {".toml", scene.toml}}) {
      if (auto written = write_file_atomic(path + extension, text); !written) return written;
    }
  }
  for (const auto& [name, picture] : make_textures()) {
    if (auto written = write_picture(folder + "/" + name, picture); !written) return written;
  }
  return {};
}

}  // namespace spanray::assets
