#include "scenes.h"

#include <filesystem>

#include "core/atomic_file.h"
#include "textures.h"

namespace spanray::assets {

std::map<std::string, SceneFiles> make_scenes() {
  return {{"cornell", make_cornell()}, {"spheres", make_spheres()}, {"columns", make_columns()}, {"gauze", make_gauze()}, {"glass", make_glass()}, {"hall", make_hall()},
          {"molecule", make_molecule()}, {"orrery", make_orrery()}, {"dahlia", make_dahlia()}, {"henge", make_henge()}};
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
          {"textures/hall_ashlar.png", ashlar_color(512)},
          {"textures/hall_ashlar_height.png", ashlar_height(512)},
          {"textures/hall_brick.png", hall_brick_color(512)},
          {"textures/hall_brick_height.png", hall_brick_height(512)},
          {"textures/hall_coffer.png", coffer_color(256)},
          {"textures/hall_floor.png", hall_floor_color(1024)},
          {"textures/hall_lattice.png", lattice_mask(256)},
          {"textures/hall_relief_sun.png", relief_sun_color(512)},
          {"textures/hall_relief_sun_height.png", relief_sun_height(512)},
          {"textures/hall_relief_vine.png", relief_vine_color(512)},
          {"textures/hall_relief_vine_height.png", relief_vine_height(512)},
          {"textures/hall_rose.png", marble_color(512, {0.66, 0.43, 0.36}, {0.86, 0.74, 0.66}, 211)},
          {"textures/hall_stone.png", cut_stone_color(256)},
          {"textures/hall_verde.png", marble_color(256, {0.10, 0.17, 0.14}, {0.38, 0.46, 0.40}, 231)},
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

namespace {

Result<void> write_scene(const std::string& path, const SceneFiles& scene) {
  for (const auto& [extension, text] : {std::pair{".obj", scene.mesh.text()}, {".mtl", scene.mtl}, {".toml", scene.toml}}) {
    if (auto written = write_file_atomic(path + extension, text); !written) return written;
  }
  return {};
}

Result<void> make_folders(const std::string& folder) {
  std::error_code failed;
  std::filesystem::create_directories(folder + "/textures", failed);
  if (failed) return Error{"cannot make this folder: " + failed.message(), folder + "/textures"};
  return {};
}

Result<void> write_textures(const std::string& folder, const std::string& needed_by) {
  for (const auto& [name, picture] : make_textures()) {
    if (!needed_by.empty() && needed_by.find(name) == std::string::npos) continue;
    if (auto written = write_picture(folder + "/" + name, picture); !written) return written;
  }
  return {};
}

}  // namespace

Result<void> write_assets(const std::string& folder) {
  if (auto made = make_folders(folder); !made) return made;
  for (const auto& [name, scene] : make_scenes()) {
    if (auto written = write_scene(folder + "/" + name, scene); !written) return written;
  }
  return write_textures(folder, "");
}

Result<void> write_hall(const std::string& folder, double triangles) {
  if (auto made = make_folders(folder); !made) return made;
  const SceneFiles hall = make_hall(triangles);
  if (auto written = write_scene(folder + "/hall", hall); !written) return written;
  return write_textures(folder, hall.mtl);
}

}  // namespace spanray::assets
