// The plan of the house, enforced: who may include whom, who may know which library, and how long a file may grow (DESIGN 2, 4).
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace spanray {
namespace {

namespace fs = std::filesystem;

// Rooms of engine/ and the rooms each may include besides itself and the public headers. Stages never include each other.
const std::map<std::string, std::set<std::string>> kMayInclude = {
    {"core", {}},
    {"math", {"core", "simd"}},
    {"simd", {"core"}},
    {"codec", {"core"}},
    {"catalog", {"core", "math", "simd", "scene"}},
    {"scene", {"core", "math", "simd", "codec", "catalog"}},
    {"frame", {"core", "math", "simd", "scene"}},
    {"raster", {"core", "math", "simd", "scene", "frame"}},
    {"ray", {"core", "math", "simd", "scene", "frame"}},
    {"shade", {"core", "math", "simd", "scene", "frame", "catalog"}},
    {"image", {"core", "math", "simd", "codec", "frame"}},
    {"reference", {"core", "math", "codec", "scene", "frame"}},
    {"render", {"core", "math", "simd", "codec", "catalog", "scene", "frame", "raster", "ray", "shade", "image"}},
    {"include", {}},
};

// Libraries, told by the beginning of what is included, and the files of engine/ and demo/ that may know them.
struct Library { const char* header; const char* where; };
const Library kLibraries[] = {
    {"SDL", "^demo/"},
    {"CLI/", "^demo/"},
    {"nlohmann/", "^(demo/|engine/frame/ladder\\.cpp$)"},
    {"tiny_obj_loader", "^engine/scene/"},
    {"toml", "^engine/scene/"},
    {"tbb/", "^engine/core/parallel\\.cpp$"},
    {"oneapi/tbb/", "^engine/core/parallel\\.cpp$"},
    {"hwy/", "^engine/(simd/.*|.*_kernel\\.cpp|.*-inl\\.h)$"},
    {"png", "^engine/(codec|image)/"},
    {"jpeglib", "^engine/codec/"},
    {"jerror", "^engine/codec/"},
    {"glm/", "^(?!engine/include/)"},
};

constexpr int kWarnLines = 350, kFailLines = 400;

struct Found { std::vector<std::string> broken, long_files; int files = 0; };

bool is_source(const fs::path& path) {
  const std::string e = path.extension().string();
  return e == ".h" || e == ".cpp" || e == ".inl";
}

void check_include(const std::string& file, const std::string& room, int line, const std::string& header, Found& found) {
  const auto report = [&](const std::string& why) { found.broken.push_back(file + ":" + std::to_string(line) + ": " + header + ": " + why); };
  for (const Library& library : kLibraries) {
    if (header.rfind(library.header, 0) == 0 && !std::regex_search(file, std::regex(library.where))) report("this file may not know that library");
  }
  const std::string to = header.substr(0, header.find('/'));
  if (room.empty() || to == header || to == room || kMayInclude.count(to) == 0) return;  // demo may use every room
  if (kMayInclude.count(room) == 0) report("the test does not know room " + room);
  else if (kMayInclude.at(room).count(to) == 0) report(room + " may not include " + to);
}

Found check_tree(const fs::path& root) {
  static const std::regex kInclude("^\\s*#\\s*include\\s*[\"<]([^\">]+)[\">]");
  Found found;
  for (const char* top : {"engine", "demo"}) {
    if (!fs::exists(root / top)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
      if (!entry.is_regular_file() || !is_source(entry.path())) continue;
      const std::string file = fs::relative(entry.path(), root).generic_string();
      const std::string inside = file.substr(file.find('/') + 1);
      const std::string room = file.rfind("engine/", 0) == 0 ? inside.substr(0, inside.find('/')) : "";
      std::ifstream in(entry.path());
      int line = 0;
      for (std::string text; std::getline(in, text);) {
        std::smatch match;
        ++line;
        if (std::regex_search(text, match, kInclude)) check_include(file, room, line, match[1], found);
      }
      ++found.files;
      if (line > kWarnLines) found.long_files.push_back(file + ": " + std::to_string(line) + " lines");
      if (line > kFailLines) found.broken.push_back(file + ": " + std::to_string(line) + " lines, more than " + std::to_string(kFailLines));
    }
  }
  return found;
}

std::string joined(const std::vector<std::string>& lines) {
  std::string all;
  for (const std::string& line : lines) all += line + "\n";
  return all;
}

TEST(IncludeDirection, StagesDoNotKnowEachOtherAndLibrariesHaveOneHome) {
  const Found found = check_tree(SPANRAY_SOURCE_DIR);
  EXPECT_GT(found.files, 50) << "hardly any source file found: is " << SPANRAY_SOURCE_DIR << " the project?";
  EXPECT_TRUE(found.broken.empty()) << joined(found.broken);
  if (!found.long_files.empty()) std::printf("over %d lines:\n%s", kWarnLines, joined(found.long_files).c_str());
}

// The test itself: each planted violation is found, and alone.
class PlantedTree : public ::testing::Test {
 protected:
  void SetUp() override { root_ = fs::temp_directory_path() / ("spanray_include_" + std::to_string(getpid())); fs::remove_all(root_); }
  void TearDown() override { fs::remove_all(root_); }
  std::vector<std::string> broken(const std::string& file, const std::string& text) {
    fs::remove_all(root_);
    for (const auto& [name, content] : {std::pair<std::string, std::string>{"engine/core/good.h", "#include <vector>\n"}, {file, text}}) {
      fs::create_directories((root_ / name).parent_path());
      std::ofstream(root_ / name) << content;
    }
    return check_tree(root_).broken;
  }
  fs::path root_;
};

TEST_F(PlantedTree, AllowedIncludesPass) {
  EXPECT_TRUE(broken("engine/raster/a.cpp", "#include \"frame/frame.h\"\n#include \"a.h\"\n#include \"spanray/settings.h\"\n").empty());
  EXPECT_TRUE(broken("engine/shade/a_kernel.cpp", "#include \"hwy/highway.h\"\n#include <glm/vec3.hpp>\n").empty());
  EXPECT_TRUE(broken("demo/walk.cpp", "#include <SDL2/SDL.h>\n#include \"frame/ladder.h\"\n").empty());
  EXPECT_TRUE(broken("engine/render/a.cpp", "#include \"raster/raster.h\"\n#include \"ray/bvh.h\"\n").empty());
}

TEST_F(PlantedTree, EachViolationIsFound) {
  EXPECT_EQ(broken("engine/raster/a.cpp", "\n#include \"ray/bvh.h\"\n"), std::vector<std::string>{"engine/raster/a.cpp:2: ray/bvh.h: raster may not include ray"});
  EXPECT_EQ(broken("engine/core/a.h", "#include \"scene/scene_data.h\"\n").size(), 1u);
  EXPECT_EQ(broken("engine/scene/a.h", "# include \"frame/frame.h\"\n").size(), 1u);
  EXPECT_EQ(broken("engine/render/a.cpp", "#include <SDL2/SDL.h>\n").size(), 1u);
  EXPECT_EQ(broken("engine/render/a.cpp", "#include <SDL.h>\n").size(), 1u);
  EXPECT_EQ(broken("demo/a.cpp", "#include <tiny_obj_loader.h>\n").size(), 1u);
  EXPECT_EQ(broken("engine/frame/a.cpp", "#include <toml++/toml.h>\n").size(), 1u);
  EXPECT_EQ(broken("engine/core/other.cpp", "#include <oneapi/tbb/task_group.h>\n").size(), 1u);
  EXPECT_EQ(broken("engine/ray/trace.cpp", "#include \"hwy/highway.h\"\n").size(), 1u);
  EXPECT_EQ(broken("engine/include/spanray/a.h", "#include <glm/vec3.hpp>\n").size(), 1u);
  EXPECT_EQ(broken("engine/include/spanray/a.h", "#include \"scene/scene_data.h\"\n").size(), 1u);
  EXPECT_EQ(broken("engine/attic/a.h", "#include \"core/hash.h\"\n").size(), 1u) << "a room that the plan does not know";
  EXPECT_EQ(broken("engine/core/a.cpp", std::string(400, '\n')).size(), 0u);
  EXPECT_EQ(broken("engine/core/a.cpp", std::string(401, '\n')).size(), 1u);
}

}  // namespace
}  // namespace spanray
