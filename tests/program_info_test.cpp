// What `info`, `why` and the statistics of `render` say of instances, spheres and planes.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "support/program.h"
#include "support/temp_folder.h"

namespace spanray {
namespace {

using Json = nlohmann::ordered_json;

class ProgramInfo : public ::testing::Test {
 protected:
  Ran run(std::vector<std::string> arguments) { return run_program(std::move(arguments), folder_.path()); }
  TempFolder folder_;
  const std::string henge_ = SPANRAY_SOURCE_DIR "/assets/henge.toml", cornell_ = SPANRAY_SOURCE_DIR "/assets/cornell.toml";
};

TEST_F(ProgramInfo, CountsCopiesAndExactPrimitives) {
  const Ran text = run({"info", henge_});
  EXPECT_EQ(0, text.code) << text.error;
  EXPECT_NE(std::string::npos,
            text.out.find("instances    14 copies of 1 part, 2632 triangles; rays: one tree over all copies, 0.1 MB\n"))
      << text.out;
  EXPECT_NE(std::string::npos, text.out.find("spheres      3\nplanes       2\n")) << text.out;
  EXPECT_NE(std::string::npos, text.out.find("2 planes: exact rays up to the horizon")) << text.out;
  const Json json = Json::parse(run({"info", henge_, "--json"}).out, nullptr, false);
  EXPECT_EQ(Json::parse(R"({"parts": 1, "places": 14, "triangles": 2632})"), json["instances"]);
  EXPECT_EQ(1, json["bvh_levels"].get<int>());
  EXPECT_EQ(0, json["bvh_instances"].get<int>());
  EXPECT_GT(json["bvh_bytes"].get<int>(), 100'000);
  EXPECT_EQ(3, json["spheres"].get<int>());
  EXPECT_EQ(2, json["planes"].get<int>());
  const Ran no_rays = run({"info", henge_, "--shadows", "none", "--reflections", "none"});
  EXPECT_NE(std::string::npos, no_rays.out.find("2632 triangles; no ray is traced\n")) << no_rays.out;
  const Ran plain = run({"info", cornell_});
  for (const char* word : {"instances", "spheres ", "planes "})
    EXPECT_EQ(std::string::npos, plain.out.find(word)) << word << plain.out;
}

TEST_F(ProgramInfo, StatisticsSayWhichTreesAFrameHad) {
  const int bytes = Json::parse(run({"info", henge_, "--json"}).out, nullptr, false)["bvh_bytes"].get<int>();
  const auto trees = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments = {"render", henge_, "--size", "64x36", "--stats", "-"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Ran ran = run(arguments);
    const Json stats = Json::parse(ran.out, nullptr, false);
    EXPECT_TRUE(stats.is_object()) << ran.out << ran.error;
    std::vector<int> got;
    for (const char* what : {"bvh_levels", "bvh_instances", "bvh_bytes"})
      got.push_back(stats.is_object() ? stats["counts"][what].get<int>() : -1);
    return got;
  };
  EXPECT_EQ((std::vector<int>{1, 0, bytes}), trees({}));
  EXPECT_EQ((std::vector<int>{0, 0, 0}), trees({"--shadows", "none", "--reflections", "none"}));
}

TEST_F(ProgramInfo, WhyShowsThePlane) {
  const Ran why = run({"why", henge_, "10,170", "--size", "320x180"});
  EXPECT_EQ(0, why.code) << why.error;
  EXPECT_NE(std::string::npos, why.out.find("plane: point")) << why.out;
  EXPECT_NE(std::string::npos, why.out.find("'sand'")) << why.out;
  EXPECT_NE(std::string::npos, why.out.find("equal to the derivation, bit for bit")) << why.out;
  for (const std::vector<std::string>& refused :
       {std::vector<std::string>{"report", henge_, "--out", "r"},
        {"reference", henge_, "--size", "8x8", "--out", "a.png", "--mask", "m.pfm"}}) {
    const Ran ran = run(refused);
    EXPECT_EQ(1, ran.code);
    EXPECT_NE(std::string::npos, ran.error.find("planes")) << ran.error;
  }
}

}  // namespace
}  // namespace spanray
