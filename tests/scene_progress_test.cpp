// Loading reports how far it is, and stops when it is told to.
#include <gtest/gtest.h>

#include <algorithm>

#include "support/scene_files.h"
#include "support/small_scene.h"

namespace spanray {
namespace {

// A mesh of n small triangles with a material.
std::string write_triangles(const TempFolder& folder, int n) {
  std::string text = "mtllib room.mtl\nusemtl red\n";
  for (int i = 0; i < n; ++i) {
    const std::string x = std::to_string(i);
    text += "v " + x + " 0 0\nv " + x + " 1 0\nv " + x + " 0 1\nf -3 -2 -1\n";
  }
  return folder.write("many.obj", text);
}

TEST(SceneProgress, NamesEveryStageWithAGrowingFraction) {
  TempFolder folder;
  write_small_scene(folder);
  const std::string path = write_triangles(folder, 20000);
  std::vector<std::pair<std::string, double>> reports;
  LoadOptions options;
  options.progress = [&](const char* stage, double fraction) { return reports.emplace_back(stage, fraction), true; };
  const Loaded with = must_load(path, options), without = must_load(path);
  EXPECT_EQ(without.scene().hash, with.scene().hash) << "who watches changes nothing";
  for (size_t i = 0; i < reports.size(); ++i) {
    EXPECT_TRUE(reports[i].second >= 0 && reports[i].second <= 1) << reports[i].first << " " << reports[i].second;
    if (i == 0 || reports[i].first != reports[i - 1].first) continue;
    EXPECT_GE(reports[i].second, reports[i - 1].second) << reports[i].first;
  }
  for (const char* stage : {"reading the mesh", "decoding textures", "smoothing normals", "cutting polygons", "merging vertices"})
    EXPECT_TRUE(std::any_of(reports.begin(), reports.end(), [&](const auto& r) { return r.first == stage; })) << stage;
}

TEST(SceneProgress, StopsAtEachReportWithAnError) {
  TempFolder folder;
  write_small_scene(folder);
  const std::string path = write_triangles(folder, 20000);
  int total = 0;
  LoadOptions counting;
  counting.progress = [&](const char*, double) { return ++total, true; };
  must_load(path, counting);
  ASSERT_GT(total, 8);
  for (int stop_at = 1; stop_at <= total; ++stop_at) {
    int calls = 0;
    LoadOptions options;
    options.progress = [&](const char*, double) { return ++calls < stop_at; };
    EXPECT_NE(std::string::npos, must_fail(path, options).to_string().find("loading was stopped")) << stop_at;
    EXPECT_EQ(stop_at, calls) << "nobody is asked again";
  }
}

}  // namespace
}  // namespace spanray
