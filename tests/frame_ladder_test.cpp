#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

#include "core/atomic_file.h"
#include "frame/ladder.h"
#include "frame/tiles.h"
#include "spanray/stats.h"

namespace spanray {
namespace {

namespace fs = std::filesystem;

class LadderFile : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "spanray-ladder-XXXXXX").string();
    ASSERT_NE(nullptr, mkdtemp(name.data()));
    folder_ = name;
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string read(const std::string& name) const {
    std::ifstream file(path(name));
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }
  void write(const std::string& name, const std::string& text) const { std::ofstream(path(name)) << text; }
  fs::path folder_;
};

// 130 x 70: tiles of full, partial and two-pixel width.
Ladder make_ladder(int width = 130, int height = 70) {
  std::mt19937_64 rng(7);
  Ladder ladder;
  ladder.begin(width, height);
  ladder.set(Rung::kScene, rng());
  ladder.set(Rung::kVertices, rng());
  for (int r = static_cast<int>(Rung::kIds); r < kRungCount; ++r)
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) ladder.mix(static_cast<Rung>(r), x, y, rng());
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) ladder.set_primitive(x, y, static_cast<uint32_t>(x * y));
  return ladder;
}

TEST(Ladder, EqualLaddersHaveNoDifference) {
  const Ladder::Difference d = Ladder::first_difference(make_ladder(), make_ladder());
  EXPECT_FALSE(d.found);
  EXPECT_EQ("no difference", d.to_string());
}

TEST(Ladder, EachRungsDifferenceIsFoundAtItsPixel) {
  for (int r = static_cast<int>(Rung::kIds); r < kRungCount; ++r) {
    Ladder b = make_ladder();
    b.mix(static_cast<Rung>(r), 128, 65, 1);
    b.set_primitive(128, 65, 5);
    const Ladder::Difference d = Ladder::first_difference(make_ladder(), b);
    EXPECT_TRUE(d.found);
    EXPECT_EQ(r, static_cast<int>(d.rung));
    EXPECT_EQ(5, d.tile);  // 3 x 2 tiles
    EXPECT_EQ(128, d.x);
    EXPECT_EQ(65, d.y);
    EXPECT_EQ(128u * 65u, d.primitive_a);
    EXPECT_EQ(5u, d.primitive_b);
  }
}

TEST(Ladder, FirstMeansRungThenTileThenPixel) {
  Ladder b = make_ladder();
  b.mix(Rung::kBytes, 0, 0, 1);
  b.mix(Rung::kSurfaces, 70, 69, 1);  // tile 4
  b.mix(Rung::kSurfaces, 65, 69, 1);  // tile 4, earlier in its row
  b.mix(Rung::kSurfaces, 129, 0, 1);  // tile 2
  Ladder::Difference d = Ladder::first_difference(make_ladder(), b);
  EXPECT_EQ(Rung::kSurfaces, d.rung);
  EXPECT_EQ(2, d.tile);
  EXPECT_EQ(129, d.x);
  b.set(Rung::kVertices, 1);
  d = Ladder::first_difference(make_ladder(), b);
  EXPECT_EQ(Rung::kVertices, d.rung);
  EXPECT_EQ(-1, d.tile);
  EXPECT_EQ("stage vertices", d.to_string());
}

TEST(Ladder, OtherSizesDifferAtTheScene) {
  const Ladder::Difference d = Ladder::first_difference(make_ladder(), make_ladder(70, 130));
  EXPECT_TRUE(d.found);
  EXPECT_EQ(Rung::kScene, d.rung);
}

TEST(Ladder, MixingDependsOnOrder) {
  Ladder a, b;
  a.begin(1, 1), b.begin(1, 1);
  a.mix(Rung::kRadiance, 0, 0, 1), a.mix(Rung::kRadiance, 0, 0, 2);
  b.mix(Rung::kRadiance, 0, 0, 2), b.mix(Rung::kRadiance, 0, 0, 1);
  EXPECT_TRUE(Ladder::first_difference(a, b).found);
}

TEST_F(LadderFile, RoundTripKeepsHashesAndFindsDifferences) {
  Ladder a = make_ladder();
  ASSERT_TRUE(a.write_json(path("a.json")));
  Result<Ladder> read_back = Ladder::read_json(path("a.json"));
  ASSERT_TRUE(read_back) << read_back.error().to_string();
  for (int r = 0; r < kRungCount; ++r) EXPECT_EQ(a.hash(static_cast<Rung>(r)), read_back.value().hash(static_cast<Rung>(r)));
  EXPECT_FALSE(Ladder::first_difference(a, read_back.value()).found);
  a.mix(Rung::kShadowBits, 3, 4, 9);
  const Ladder::Difference d = Ladder::first_difference(a, read_back.value());
  EXPECT_EQ("stage shadow_bits, tile 0, pixel 3,4, primitive 12", d.to_string());
}

TEST_F(LadderFile, ADifferenceBeyondThe16BitsKeptIsStillFound) {
  Ladder a;
  a.begin(64, 64);
  ASSERT_TRUE(a.write_json(path("a.json")));
  std::string text = read("a.json");
  const std::string key = "\"radiance\"";
  const size_t rung = text.find(key);
  ASSERT_NE(std::string::npos, rung);
  // The hash of tile 0 only; all pixels stay.
  const size_t tiles = text.find("\"tiles\"", rung);
  const size_t hash = text.find("\"hash\": \"", tiles) + 9;
  text[hash] = text[hash] == '0' ? '1' : '0';
  write("b.json", text);
  Result<Ladder> b = Ladder::read_json(path("b.json"));
  ASSERT_TRUE(b) << b.error().to_string();
  const Ladder::Difference d = Ladder::first_difference(a, b.value());
  EXPECT_TRUE(d.found);
  EXPECT_EQ(Rung::kRadiance, d.rung);
  EXPECT_EQ(0, d.tile);
  EXPECT_EQ(-1, d.x);
}

TEST_F(LadderFile, BadFilesAreRefusedWithTheirCause) {
  ASSERT_TRUE(make_ladder().write_json(path("good.json")));
  const std::string good = read("good.json");
  const auto replaced = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    const size_t at = text.find(from);
    EXPECT_NE(std::string::npos, at) << from;
    return text.replace(at, from.size(), to);
  };
  const struct { std::string text, cause; } cases[] = {
      {"", "JSON"},
      {"[]", "numeric_contract"},
      {"{\"numeric_contract\": \"1\"}", "numeric_contract"},
      {good.substr(0, good.size() / 2), "JSON"},
      {replaced("\"numeric_contract\": " + std::to_string(kNumericContract), "\"numeric_contract\": 99"), "numeric contract 99"},
      {replaced("\"width\": 130", "\"width\": 0"), "width"},
      {replaced("\"width\": 130", "\"width\": -5"), "width"},
      {replaced("\"width\": 130", "\"width\": 16384"), "too short"},
      {replaced("\"width\": 130", "\"width\": 129"), "pixels"},
      {replaced("\"tile_size\": 64", "\"tile_size\": 32"), "tile_size"},
      {replaced("\"surfaces\"", "\"sufraces\""), "surfaces"},
      {replaced("\"tile\": 1,", "\"tile\": 2,"), "order"},
      {replaced("\"pixels\": \"", "\"pixels\": \"g"), "pixels"},
      {replaced("\"primitives\"", "\"primitivs\""), "primitives"},
  };
  int n = 0;
  for (const auto& c : cases) {
    const std::string name = "bad" + std::to_string(n++) + ".json";
    write(name, c.text);
    const Result<Ladder> result = Ladder::read_json(path(name));
    ASSERT_FALSE(result) << n;
    EXPECT_NE(std::string::npos, result.error().to_string().find(c.cause)) << result.error().to_string();
    EXPECT_NE(std::string::npos, result.error().to_string().find(name));
  }
  EXPECT_FALSE(Ladder::read_json(path("missing.json")));
  EXPECT_FALSE(Ladder::read_json(folder_.string()));
}

TEST_F(LadderFile, AtomicWritesLeaveNothingHalfDone) {
  ASSERT_TRUE(write_file_atomic(path("f"), "first"));
  ASSERT_TRUE(write_file_atomic(path("f"), "second"));
  EXPECT_EQ("second", read("f"));
  EXPECT_FALSE(write_file_atomic(path("missing/f"), "x"));
  EXPECT_FALSE(write_file_atomic("", "x"));
  fs::create_directory(path("folder"));
  const Result<void> folder = write_file_atomic(path("folder"), "x");
  ASSERT_FALSE(folder);
  EXPECT_NE(std::string::npos, folder.error().to_string().find("folder"));
  EXPECT_TRUE(check_writable(path("new")));
  EXPECT_FALSE(fs::exists(path("new")));
  size_t files = 0;
  for ([[maybe_unused]] const auto& entry : fs::directory_iterator(folder_)) ++files;
  EXPECT_EQ(2u, files);  // f and folder, no temporary
}

}  // namespace
}  // namespace spanray
