// The shipped scenes are what the generator writes, and the meshes are what a renderer may expect.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <map>
#include <set>
#include <sstream>

#include "codec/decode.h"
#include "core/read_file.h"
#include "scenes.h"

namespace spanray::assets {
namespace {

namespace fs = std::filesystem;
const std::string kFolder = std::string(SPANRAY_SOURCE_DIR) + "/assets/";

const std::map<std::string, SceneFiles>& scenes() {
  static const auto made = make_scenes();
  return made;
}

const std::map<std::string, Picture>& textures() {
  static const auto made = make_textures();
  return made;
}

std::string text_of(const std::string& path) {
  const auto text = read_file(path);
  return text ? text.value() : text.error().to_string();
}

// Line by line, so that a failure names the first line that differs instead of printing megabytes.
void expect_same_text(const std::string& path, const std::string& made) {
  std::istringstream a(text_of(path)), b(made);
  std::string line_a, line_b;
  for (int line = 1;; ++line) {
    const bool more_a = static_cast<bool>(std::getline(a, line_a)), more_b = static_cast<bool>(std::getline(b, line_b));
    ASSERT_EQ(more_a, more_b) << path << ":" << line << ": one ends here";
    if (!more_a) return;
    ASSERT_EQ(line_a, line_b) << path << ":" << line;
  }
}

TEST(AssetsGenerator, CommittedScenesAreWhatItWrites) {
  for (const auto& [name, scene] : scenes()) {
    expect_same_text(kFolder + name + ".obj", scene.mesh.text());
    expect_same_text(kFolder + name + ".mtl", scene.mtl);
    expect_same_text(kFolder + name + ".toml", scene.toml);
  }
}

void expect_same_picture(const std::string& path, const Picture& picture) {
  const auto file = decode_image_file(path);
  ASSERT_TRUE(static_cast<bool>(file)) << file.error().to_string();
  EXPECT_EQ(file.value().width, picture.width) << path;
  EXPECT_EQ(file.value().height, picture.height) << path;
  EXPECT_EQ(file.value().channels, picture.channels) << path;
  EXPECT_EQ(file.value().bits, picture.bits) << path;
  EXPECT_TRUE(file.value().samples == picture.samples) << path << ": other pixels";
}

TEST(AssetsGenerator, CommittedTexturesAreWhatItWrites) {
  for (const auto& [name, picture] : textures()) expect_same_picture(kFolder + name, picture);
}

TEST(AssetsGenerator, WrittenPicturesReadBackExactly) {
  const fs::path temp = fs::temp_directory_path() / ("spanray_assets_" + std::to_string(getpid()));
  fs::create_directories(temp);
  const std::string path = (temp / "again.png").string();
  for (const char* name : {"textures/leaf.png", "textures/leaf_mask.png", "textures/limestone_height.png"}) {  // RGB, 8 and 16 bits of gray
    ASSERT_TRUE(static_cast<bool>(write_picture(path, textures().at(name))));
    expect_same_picture(path, textures().at(name));
  }
  fs::remove_all(temp);
}

TEST(AssetsGenerator, NothingElseIsShippedAndAllStaysUnderTwentyMebibytes) {
  std::set<std::string> known;
  for (const auto& [name, scene] : scenes()) known.insert({name + ".obj", name + ".mtl", name + ".toml"});
  for (const auto& [name, picture] : textures()) known.insert(name);
  uintmax_t bytes = 0;
  for (const auto& entry : fs::recursive_directory_iterator(kFolder)) {
    const std::string name = fs::relative(entry.path(), kFolder).generic_string();
    if (entry.is_directory() || name.rfind("generator/", 0) == 0 || name == "CMakeLists.txt") continue;
    EXPECT_TRUE(known.count(name)) << name;
    bytes += entry.file_size();
  }
  EXPECT_LT(bytes, 20u << 20);
}

TEST(AssetsGenerator, EveryNamedTextureAndMaterialExists) {
  for (const auto& [name, scene] : scenes()) {
    std::set<std::string> materials;
    std::istringstream lines(scene.mtl);
    for (std::string line; std::getline(lines, line);) {
      const std::string last = line.substr(line.rfind(' ') + 1);
      if (line.rfind("newmtl ", 0) == 0) materials.insert(last);
      EXPECT_TRUE(line.rfind("map_", 0) != 0 || textures().count(last)) << name << ": " << line;
    }
    for (const auto& object : scene.mesh.objects()) EXPECT_TRUE(materials.count(object.material)) << name << ": " << object.material;
    const bool copies = scene.toml.find("[[instance]]") != std::string::npos;  // of few triangles
    EXPECT_GE(scene.mesh.triangle_count(), copies ? 200u : 2000u) << name;
    EXPECT_LE(scene.mesh.triangle_count(), 150000u) << name;
  }
}

// Counter-clockwise seen from the side that the normals point to: in every face, at every corner. The normals of implicit surfaces
// are those of the field, which turns faster than the grid can follow where a neck is thin: one face in fifty may differ.
TEST(AssetsGenerator, FacesAgreeWithTheirNormals) {
  for (const auto& [name, scene] : scenes()) {
    for (const auto& object : scene.mesh.objects()) {
      ASSERT_FALSE(object.ends.empty()) << name << "/" << object.name;
      const bool implicit = object.name == "flame" || object.name == "gyroid";
      size_t turned_away = 0;
      for (const auto& face : object.faces()) {
        glm::dvec3 area{0, 0, 0};
        for (size_t i = 1; i + 1 < face.size(); ++i) {
          area = area + cross3(scene.mesh.position(face[i]) - scene.mesh.position(face[0]), scene.mesh.position(face[i + 1]) - scene.mesh.position(face[0]));
        }
        ASSERT_GT(length3(area), 1e-8) << name << "/" << object.name << ": no area";
        const glm::dvec3 n = normalize3(area, glm::dvec3{0, 0, 0});
        bool agrees = true;
        for (const auto& corner : face) {
          const glm::dvec3 normal = scene.mesh.normal(corner);
          ASSERT_NEAR(length3(normal), 1, 1e-3) << name << "/" << object.name;
          agrees &= dot3(n, normal) > 0.3;
        }
        turned_away += !agrees;
        ASSERT_TRUE(agrees || implicit) << name << "/" << object.name;
      }
      EXPECT_LE(turned_away * 50, object.ends.size()) << name << "/" << object.name;
    }
  }
}

// Solids are closed and turned outward: each edge is used once in each direction, and the volume is positive. Sheets are listed.
TEST(AssetsGenerator, SolidsAreClosedAndOutward) {
  static const std::set<std::string> kSheets = {
      "back", "ceiling", "floor", "left", "right", "shell", "backdrop", "mirror_glass", "arch_across", "archivolt", "bay", "court",
      "door_ring", "door_wall", "water", "back_wall", "curtain_gathered", "curtain_hanging", "gate_iron", "gate_ring", "gate_wall", "leaves",
      "right_wall", "disc", "pane", "walls", "pavement",
      // The hall: walls that end in other walls, rings sunk into them, hollows, cloth, masks, panes.
      "arcade_left", "arcade_right", "archivolt_left", "archivolt_right", "aisle_arch_left", "aisle_arch_right", "window_wall", "window_ring",
      "relief", "niche_wall", "niche_arch", "niche", "brick_wall", "entrance", "entrance_ring", "entrance_left", "entrance_right",
      "entrance_left_ring", "entrance_right_ring", "apse_arch", "apse_arch_ring", "apse", "garden", "vault_coffers", "vault_panels",
      "vault_rosettes", "vault_bands", "vault_ribs", "lattice", "gate", "rail_iron", "half_curtain", "case_glass"};
  for (const auto& [name, scene] : scenes()) {
    for (const auto& object : scene.mesh.objects()) {
      std::string kind = object.name;
      while (!kind.empty() && (kind.back() == '_' || (kind.back() >= '0' && kind.back() <= '9'))) kind.pop_back();
      if (kSheets.count(kind)) continue;
      std::map<std::pair<int, int>, int> edges;
      double volume = 0;
      for (const auto& face : object.faces()) {
        for (size_t i = 0; i < face.size(); ++i) ++edges[{face[i][0], face[(i + 1) % face.size()][0]}];
        for (size_t i = 1; i + 1 < face.size(); ++i) {
          volume += dot3(scene.mesh.position(face[0]), cross3(scene.mesh.position(face[i]), scene.mesh.position(face[i + 1])));
        }
      }
      int open = 0;
      for (const auto& [edge, uses] : edges) {
        const auto back = edges.find({edge.second, edge.first});
        open += uses != 1 || back == edges.end() || back->second != 1;
      }
      EXPECT_EQ(open, 0) << name << "/" << object.name << ": edges without exactly one partner, of " << edges.size();
      EXPECT_GT(volume, 0) << name << "/" << object.name;
    }
  }
}

}  // namespace
}  // namespace spanray::assets
