// What `render`, `info` and `why` give: pictures, hashes, statistics, ladders.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/hash.h"
#include "simd/isa.h"
#include "spanray/image.h"
#include "spanray/stats.h"
#include "support/program.h"
#include "support/small_scene.h"

namespace spanray {
namespace {

using Json = nlohmann::json;

class ProgramRender : public ::testing::Test {
 protected:
  void SetUp() override { scene_ = write_small_scene(folder_); }
  Ran run(std::vector<std::string> arguments) { return run_program(std::move(arguments), folder_.path()); }
  // render with a camera and a size, and what else is asked for; it must succeed.
  Ran render(std::vector<std::string> more, const std::string& size = "96x64") {
    std::vector<std::string> arguments = {"render", scene_, "--camera", kSmallSceneCamera, "--size", size};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Ran ran = run(arguments);
    EXPECT_EQ(0, ran.code) << ran.error;
    return ran;
  }
  TempFolder folder_;
  std::string scene_;
};

TEST_F(ProgramRender, WritesThePictureWhoseHashItPrints) {
  const Ran ran = render({"--out", "a.png", "--hash"});
  Result<Image> image = read_png(folder_.file("a.png"));
  ASSERT_TRUE(image) << image.error().to_string();
  EXPECT_EQ(96, image.value().width);
  EXPECT_EQ(64, image.value().height);
  EXPECT_EQ(hash_text(hash_image(image.value())) + "\n", ran.out);
  size_t colors = 0;
  for (size_t i = 4; i < image.value().rgba.size(); i += 4)
    colors += std::memcmp(&image.value().rgba[i], &image.value().rgba[i - 4], 4) != 0;
  EXPECT_GT(colors, 500u) << "nearly blank";
}

TEST_F(ProgramRender, SaysWhereThePictureCameFrom) {
  render({"--out", "a.png", "--shading", "flat"});
  const std::string bytes = read_text(folder_.file("a.png"));
  for (const char* word : {"numeric_contract", "scene_hash", "shading=flat", "camera"})
    EXPECT_NE(std::string::npos, bytes.find(word)) << word;
}

TEST_F(ProgramRender, TheRecordedCameraRepeatsThePictureWithUpAndNear) {
  folder_.write("tilted.toml",
                "obj = \"room.obj\"\n[[camera]]\nname = \"tilted\"\neye = [0.5, 1.5, 4.5]\ntarget = [0.0, 0.6, 0.1]\nup = [0.3, 1.0, 0.1]\n"
                "near = 2.5\n[[camera]]\nname = \"other\"\neye = [0.5, 1.5, 4.5]\ntarget = [0.0, 0.6, 0.0]\nfov_y = 50\nnear = 3\n");
  const auto hash_of = [&](const std::string& camera, const std::string& stats = "s.json") {
    const Ran ran = run({"render", "tilted.toml", "--size", "64x48", "--hash", "--camera", camera, "--stats", stats});
    EXPECT_EQ(0, ran.code) << ran.error;
    return ran.out;
  };
  const std::string tilted = hash_of("tilted", "tilted.json"), other = hash_of("other", "other.json");
  EXPECT_NE(tilted, other);
  const auto recorded = [&](const char* stats) { return Json::parse(read_text(folder_.file(stats)))["camera"].get<std::string>(); };
  EXPECT_EQ("0.5,1.5,4.5,0,0.6,0.1,45,0.3,1,0.1,2.5", recorded("tilted.json"));
  EXPECT_EQ(tilted, hash_of(recorded("tilted.json")));
  EXPECT_EQ(other, hash_of(recorded("other.json")));
  EXPECT_EQ(tilted, hash_of("0.5,1.5,4.5,0,0.6,0.1,45")) << "up and near are those of the scene's first camera";
  EXPECT_NE(tilted, hash_of("0.5,1.5,4.5,0,0.6,0.1,45,0,1,0")) << "up";
  EXPECT_NE(tilted, hash_of("0.5,1.5,4.5,0,0.6,0.1,45,0.3,1,0.1,4.5")) << "near";
}

TEST_F(ProgramRender, HashesDoNotDependOnThreadsOrInstructionSets) {
  for (const char* shading : {"flat", "gouraud", "phong"}) {
    const std::string expected = render({"--hash", "--ids-hash", "--shading", shading}).out;
    EXPECT_EQ(34u, expected.size()) << expected;
    for (const Isa isa : {Isa::kScalar, Isa::kSse4, Isa::kAvx2, Isa::kAvx512}) {
      if (!isa_supported(isa)) continue;
      for (const char* threads : {"1", "3"})
        EXPECT_EQ(expected, render({"--hash", "--ids-hash", "--shading", shading, "--isa", std::string(isa_name(isa)), "--threads", threads}).out)
            << isa_name(isa) << ", " << threads << " threads";
    }
  }
}

TEST_F(ProgramRender, EverySettingReachesThePicture) {
  const std::string expected = render({"--hash"}).out;
  for (const std::vector<std::string>& change :
       {std::vector<std::string>{"--shadows", "none"}, {"--reflections", "none"}, {"--max-bounces", "0"}, {"--shading", "flat"},
        {"--transparency", "none"}, {"--transparency", "screen-door"}, {"--culling", "back"}})
    EXPECT_NE(expected, render({"--hash", change[0], change[1]}).out) << change[0] << " " << change[1];
}

TEST_F(ProgramRender, StatisticsHaveEveryFieldOfTheDesign) {
  render({"--stats", "s.json", "--frames", "3", "--warmup", "1", "--out", "a.png"});
  const Json stats = Json::parse(read_text(folder_.file("s.json")), nullptr, false);
  ASSERT_TRUE(stats.is_object());
  for (const char* group : {"median_ms", "p95_ms"})
    for (const char* stage : {"transform", "clip", "bin", "raster", "shade", "shadow_rays", "bounce_rays", "composite", "encode", "frame", "bvh_build"}) {
      ASSERT_TRUE(stats[group][stage].is_number()) << group << " " << stage;
      EXPECT_GE(stats[group][stage].get<double>(), 0);
    }
  EXPECT_GT(stats["median_ms"]["frame"].get<double>(), 0);
  EXPECT_GT(stats["median_ms"]["bvh_build"].get<double>(), 0) << "built in the warm-up, still shown";
  EXPECT_LE(stats["median_ms"]["frame"].get<double>(), stats["p95_ms"]["frame"].get<double>());
  EXPECT_TRUE(stats["counts"].is_object());
  EXPECT_FALSE(stats["counts"].empty());
  EXPECT_GT(stats["memory_bytes"].get<uint64_t>(), 0u);
  EXPECT_TRUE(stats["isa"].is_string());
  EXPECT_GE(stats["threads"].get<int>(), 1);
  EXPECT_TRUE(stats["compiler"].is_string());
  EXPECT_EQ(kNumericContract, stats["numeric_contract"].get<int>());
  EXPECT_EQ(hash_text(hash_image(read_png(folder_.file("a.png")).value())), stats["hash"].get<std::string>());
  EXPECT_EQ(16u, stats["scene_hash"].get<std::string>().size());
  EXPECT_EQ(Json({96, 64}), stats["size"]);
  EXPECT_EQ(3, stats["frames"].get<int>());
  ASSERT_TRUE(stats["plan"].is_array());
  ASSERT_FALSE(stats["plan"].empty());
  for (const Json& line : stats["plan"]) {
    EXPECT_TRUE(line["stage"].is_string() && line["needed"].is_boolean() && line["reason"].is_string());
    EXPECT_NE("", line["reason"].get<std::string>());
  }
}

TEST_F(ProgramRender, StatisticsSayHowFullVectorsAre) {
  const auto lanes_of = [&](const char* isa) {
    return Json::parse(render({"--stats", "-", "--reflections", "none", "--isa", isa}).out, nullptr, false);
  };
  const Json scalar = lanes_of("scalar"), best = lanes_of("auto");
  ASSERT_TRUE(scalar.is_object() && best.is_object());
  for (const Json* stats : {&scalar, &best}) {
    const Json& lanes = (*stats)["lane_occupancy"];
    const auto used = [&](const char* kernel) { return lanes[kernel]["used"].get<uint64_t>(); };
    for (const char* kernel : {"raster_walkers", "raster_packets", "planes", "surfaces"}) {
      const uint64_t computed = lanes[kernel]["computed"].get<uint64_t>();
      EXPECT_LE(used(kernel), computed) << kernel;
      EXPECT_DOUBLE_EQ(computed > 0 ? static_cast<double>(used(kernel)) / static_cast<double>(computed) : 0, lanes[kernel]["share"].get<double>());
    }
    const Json& counts = (*stats)["counts"];
    EXPECT_EQ(counts["surfaces_shaded"].get<uint64_t>() + counts["fragments_translucent"].get<uint64_t>(), used("surfaces"));
    EXPECT_LE(used("raster_walkers"), counts["samples_passed"].get<uint64_t>());
    EXPECT_GE(used("raster_walkers") + used("raster_packets"), counts["samples_passed"].get<uint64_t>());
    EXPECT_GT(used("planes"), 0u);
  }
  // One lane is full, and what is of use does not depend on how many there are.
  for (const char* kernel : {"planes", "surfaces"}) {
    EXPECT_EQ(1, scalar["lane_occupancy"][kernel]["share"].get<double>()) << kernel;
    EXPECT_EQ(scalar["lane_occupancy"][kernel]["used"], best["lane_occupancy"][kernel]["used"]) << kernel;
  }
}

TEST_F(ProgramRender, StatisticsOnStandardOutputAreOneObject) {
  const Ran ran = render({"--stats", "-"});
  EXPECT_TRUE(Json::parse(ran.out, nullptr, false).is_object()) << ran.out;
}

TEST_F(ProgramRender, TheSmallestPicture) {
  const Ran ran = render({"--out", "a.png", "--hash", "--visibility", "ray"}, "1x1");
  Result<Image> image = read_png(folder_.file("a.png"));
  ASSERT_TRUE(image);
  EXPECT_EQ(4u, image.value().rgba.size());
  EXPECT_EQ(17u, ran.out.size());
}

TEST_F(ProgramRender, RadianceAndDepthArePortableFloatMaps) {
  render({"--radiance", "r.pfm", "--depth", "d.pfm"});
  const std::string radiance = read_text(folder_.file("r.pfm")), depth = read_text(folder_.file("d.pfm"));
  EXPECT_EQ("PF\n96 64\n", radiance.substr(0, 9));
  EXPECT_EQ("Pf\n96 64\n", depth.substr(0, 9));
  EXPECT_GE(radiance.size(), 96u * 64 * 12);
  EXPECT_GE(depth.size(), 96u * 64 * 4);
}

TEST_F(ProgramRender, LaddersOfEqualRunsAgreeAndOthersNameTheFirstStage) {
  render({"--ladder", "a.json", "--threads", "1", "--isa", "scalar"});
  render({"--ladder", "b.json", "--threads", "2"});
  const Ran equal = run({"compare", "a.json", "b.json"});
  EXPECT_EQ(0, equal.code) << equal.out << equal.error;
  render({"--ladder", "c.json", "--shadows", "none"});
  const Ran other = run({"compare", "a.json", "c.json"});
  EXPECT_EQ(1, other.code);
  EXPECT_NE(std::string::npos, other.out.find("shadow_bits")) << other.out;
  EXPECT_NE(std::string::npos, other.out.find("pixel")) << other.out;
  EXPECT_NE(std::string::npos, other.out.find("primitive")) << other.out;
}

TEST_F(ProgramRender, InfoCountsTheSceneAndGivesAReasonForEachStage) {
  const Ran text = run({"info", scene_});
  EXPECT_EQ(0, text.code) << text.error;
  EXPECT_NE(std::string::npos, text.out.find("triangles    10"));
  const Ran json = run({"info", scene_, "--json"});
  const Json info = Json::parse(json.out, nullptr, false);
  ASSERT_TRUE(info.is_object()) << json.out;
  EXPECT_EQ(10, info["triangles"].get<int>());
  EXPECT_EQ(16u, info["scene_hash"].get<std::string>().size());
  EXPECT_EQ(-2, info["bounds"]["min"][0].get<double>());
  EXPECT_FALSE(info["messages"].empty()) << "a bare OBJ says which camera and light it got";
  for (const Json& line : info["plan"]) EXPECT_NE("", line["reason"].get<std::string>());
  // What the command line switches off shows in the plan.
  const Json without = Json::parse(run({"info", scene_, "--json", "--shadows", "none", "--reflections", "none"}).out, nullptr, false);
  EXPECT_NE(info["plan"], without["plan"]);
}

TEST_F(ProgramRender, WhyDerivesThePixelsOfThePicture) {
  // Floor, mirror, glass, red, background, at the border; each derivation ends in the bytes of the picture.
  for (const char* visibility : {"raster", "ray"})
    for (const char* shading : {"flat", "gouraud", "phong"})
      for (const char* pixel : {"48,60", "48,20", "30,40", "60,36", "0,0", "95,63"}) {
        const Ran ran = run({"why", scene_, pixel, "--camera", kSmallSceneCamera, "--size", "96x64", "--visibility", visibility, "--shading", shading});
        EXPECT_EQ(0, ran.code) << pixel << " " << ran.error << ran.out;
        EXPECT_NE(std::string::npos, ran.out.find("equal to the derivation, bit for bit")) << ran.out;
      }
  // The same with several samples: edges of the pyramid, of the glass and of the mirror among them.
  int several = 0;
  for (const char* visibility : {"raster", "ray"})
    for (const char* mode : {"multisample", "supersample"})
      for (const char* pixel : {"48,60", "48,20", "30,40", "60,36", "57,30", "55,34", "40,31", "33,44", "0,0", "95,63"}) {
        const Ran ran = run({"why", scene_, pixel, "--camera", kSmallSceneCamera, "--size", "96x64", "--visibility", visibility, "--samples", "4", "--antialiasing", mode});
        EXPECT_EQ(0, ran.code) << pixel << " " << ran.error << ran.out;
        EXPECT_NE(std::string::npos, ran.out.find("equal to the derivation, bit for bit")) << ran.out;
        several += ran.out.find("seen by 1 of 4") != std::string::npos;
      }
  EXPECT_GT(several, 20);
  // Squares of 2 x 2 pixels that are shaded once: floor, mirror and pyramid; edges and what lies behind the glass by
  // themselves.
  int squares = 0;
  for (const char* visibility : {"raster", "ray"})
    for (const char* pixel : {"48,60", "48,20", "30,40", "60,36", "57,30", "33,44", "11,61", "0,0", "95,63"}) {
      const Ran ran = run({"why", scene_, pixel, "--camera", kSmallSceneCamera, "--size", "96x64", "--visibility", visibility,
                           "--shading-rate", "2x2"});
      EXPECT_EQ(0, ran.code) << pixel << " " << ran.error << ran.out;
      EXPECT_NE(std::string::npos, ran.out.find("equal to the derivation, bit for bit")) << ran.out;
      squares += ran.out.find("shaded once for 2x2 pixels") != std::string::npos;
    }
  EXPECT_GE(squares, 6);
  EXPECT_LT(squares, 16);
  // Shadow rays that start above coarse triangles.
  int lifted = 0;
  for (const char* pixel : {"30,40", "40,24", "20,30", "50,36", "66,40", "80,30", "28,20", "44,44"}) {
    const Ran ran = run({"why", SPANRAY_SOURCE_DIR "/assets/columns.toml", pixel, "--size", "96x64", "--shadow-terminator", "lifted"});
    EXPECT_EQ(0, ran.code) << pixel << " " << ran.error << ran.out;
    EXPECT_NE(std::string::npos, ran.out.find("equal to the derivation, bit for bit")) << ran.out;
    lifted += ran.out.find("shadow ray origin, lifted") != std::string::npos;
  }
  EXPECT_GE(lifted, 1);
  const Ran outside = run({"why", scene_, "96,0", "--size", "96x64"});
  EXPECT_EQ(2, outside.code);
  EXPECT_NE(std::string::npos, outside.error.find("96x64"));
}

TEST_F(ProgramRender, WhyNamesTheStepsOfEachPixel) {
  const auto expect = [&](const char* pixel, const std::vector<std::string>& words, const char* camera = kSmallSceneCamera) {
    const std::string text = run({"why", scene_, pixel, "--camera", camera, "--size", "96x64"}).out;
    for (const std::string& word : words) EXPECT_NE(std::string::npos, text.find(word)) << pixel << ": " << word << "\n" << text;
  };
  expect("48,16", {"material                 1 'mirror'", "mirror ray, bounce 1", "bounce 1 comes back"});
  expect("36,40", {"material                 0 'floor'", "translucent layer 1 of 1", "material                 2 'glass'", "they let through"});
  expect("58,33", {"material                 3 'red'", "barycentrics", "light 0, point", "irradiance, facing it"});
  expect("90,5", {"background"});
  // The floor behind the pyramid, which keeps the light of a lamp in front from it.
  scene_ = folder_.write("lamp.toml", "obj = \"room.obj\"\n[[light]]\nkind = \"point\"\nposition = [0.6, 1.9, 3.0]\nintensity = [9.0, 9.0, 9.0]\n");
  expect("48,32", {"material                 0 'floor'", "nearest on the way", "lit                    0"}, "2.5,3,0,0.7,0,-1.2,40");
}

}  // namespace
}  // namespace spanray
