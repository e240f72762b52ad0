// Every file of tests/hostile through its loader: exactly the outcome that expectations.txt gives, soon, and never a crash.
#include <gtest/gtest.h>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

#include "codec/decode.h"
#include "frame/ladder.h"
#include "image/pfm.h"
#include "spanray/stats.h"
#include "support/expectations.h"
#include "support/scene_files.h"
#include "support/scene_invariants.h"

namespace spanray {
namespace {

namespace fs = std::filesystem;

constexpr double kMostSeconds = 5;  // of processor time a file: a thousand times what most need, with sanitizers
const std::string kFolder = SPANRAY_SOURCE_DIR "/tests/hostile/";

const std::vector<Expectation>& expectations() {
  static const std::vector<Expectation> list = read_expectations(kFolder + "expectations.txt");
  return list;
}

std::string kind_of(const Expectation& e) { return e.file.substr(0, e.file.find('/')); }

class Stopwatch {
 public:
  double seconds() const { return static_cast<double>(std::clock() - start_) / CLOCKS_PER_SEC; }

 private:
  std::clock_t start_ = std::clock();
};

// The scene to load for a file: itself, or for an MTL file the sound OBJ that names it. Everything of support/ is beside it.
std::string stage(const Expectation& e, const TempFolder& folder) {
  for (const auto& entry : fs::directory_iterator(kFolder + "support")) fs::copy(entry.path(), folder.path());
  const std::string name = fs::path(e.file).filename().string();
  fs::copy(kFolder + e.file, folder.file(name));
  if (kind_of(e) != "mtl") return folder.file(name);
  return folder.write("probe.obj", "mtllib " + name + "\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 1\nvn 0 0 1\nusemtl m\n"
                                   "f 1/1/1 2/2/1 3/1/1 4/2/1\n");
}

int count_of(const Loaded& l, const std::string& what) {
  const SceneData& s = l.scene();
  const std::map<std::string, size_t> counts = {
      {"triangles", s.triangles.size()}, {"vertices", s.vertices.size()}, {"materials", s.materials.size()},
      {"textures", s.textures.size()},   {"lights", s.lights.size()},     {"cameras", s.cameras.size()},
      {"messages", l.loaded.messages.size()}};
  const auto it = counts.find(what);
  return it == counts.end() ? -1 : static_cast<int>(it->second);
}

void check_error(const Expectation& e, const Error& error, const std::string& path) {
  EXPECT_EQ(e.outcome, "fails") << error.to_string();
  EXPECT_EQ(error.line, e.line) << error.to_string();
  EXPECT_NE(error.to_string().find(e.says), std::string::npos) << error.to_string();
  EXPECT_EQ(fs::path(error.file).parent_path(), fs::path(path).parent_path()) << error.to_string();
  EXPECT_FALSE(e.says.empty()) << "the expectation must name a cause";
  EXPECT_LT(error.message.size(), 400u);
}

void check_scene(const Expectation& e) {
  const TempFolder folder;
  const std::string path = stage(e, folder);
  Result<LoadedScene> result = load_scene(path);
  if (!result) return check_error(e, result.error(), path);
  const Loaded l{result.value()};
  EXPECT_EQ(e.outcome, "loads") << l.all_messages();
  EXPECT_TRUE(e.counts.count("triangles")) << "an expectation says how many triangles";
  for (const auto& [what, count] : e.counts) EXPECT_EQ(count_of(l, what), count) << what << "\n" << l.all_messages();
  EXPECT_TRUE(e.says.empty() || l.count({e.says.c_str()}) >= 1) << e.says << "\n" << l.all_messages();
  EXPECT_EQ(broken_promise(l.scene()), "");
  for (const std::string& message : l.loaded.messages) {
    EXPECT_LT(message.size(), 600u);
    for (const char c : message) ASSERT_TRUE(static_cast<unsigned char>(c) >= 32 && c != 127) << "a control character: " << message;
  }
  // Nothing to complain about means nothing but notes: a warning must be expected.
  EXPECT_TRUE(!e.says.empty() || l.count({"warning"}) == 0) << l.all_messages();
}

void check_picture(const Expectation& e) {
  const std::string path = kFolder + e.file;
  const Result<RawImage> result = decode_image_file(path);
  if (!result) return check_error(e, result.error(), path);
  const RawImage& i = result.value();
  EXPECT_EQ(e.outcome, "picture");
  EXPECT_EQ(std::to_string(i.width) + "x" + std::to_string(i.height) + "x" + std::to_string(i.channels) + "x" + std::to_string(i.bits), e.size);
  ASSERT_EQ(i.samples.size(), static_cast<size_t>(i.width) * static_cast<size_t>(i.height) * static_cast<size_t>(i.channels));
  EXPECT_TRUE(i.bits == 16 || *std::max_element(i.samples.begin(), i.samples.end()) <= 255);
}

// What was read, and its size in words.
template <class T> void check_compared_as(const Expectation& e, const std::string& path, const Result<T>& read, const std::string& size) {
  if (!read) return check_error(e, read.error(), path);
  EXPECT_EQ(e.outcome, "picture");
  EXPECT_EQ(size, e.size);
}

// The ladders of the corpus say contract 1, whatever it has become since.
std::string under_this_contract(const Expectation& e, const TempFolder& folder) {
  std::ifstream file(kFolder + e.file, std::ios::binary);
  std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  const std::string contract = "\"numeric_contract\": ", one = contract + "1,";
  const size_t at = text.find(one);
  if (at != std::string::npos) text.replace(at, one.size(), contract + std::to_string(kNumericContract) + ",");
  return folder.write(fs::path(e.file).filename().string(), text);
}

void check_compared(const Expectation& e) {
  const TempFolder folder;
  const std::string path = under_this_contract(e, folder);
  const auto size = [](int width, int height) { return std::to_string(width) + "x" + std::to_string(height); };
  if (path.ends_with(".pfm")) {
    const Result<FloatImage> image = read_pfm(path);
    return check_compared_as(e, path, image, image ? size(image.value().width, image.value().height) : "");
  }
  const Result<Ladder> ladder = Ladder::read_json(path);
  check_compared_as(e, path, ladder, ladder ? size(ladder.value().width(), ladder.value().height()) : "");
}

void check_all(const std::set<std::string>& kinds, void (*check)(const Expectation&)) {
  int files = 0;
  for (const Expectation& e : expectations()) {
    if (!kinds.count(kind_of(e))) continue;
    SCOPED_TRACE(e.file);
    const Stopwatch watch;
    check(e);
    EXPECT_LT(watch.seconds(), kMostSeconds);
    ++files;
  }
  EXPECT_GT(files, 0);
}

TEST(HostileFiles, ObjFilesGiveWhatTheyMust) { check_all({"obj"}, check_scene); }
TEST(HostileFiles, MtlFilesGiveWhatTheyMust) { check_all({"mtl"}, check_scene); }
TEST(HostileFiles, SceneFilesGiveWhatTheyMust) { check_all({"toml"}, check_scene); }
TEST(HostileFiles, PicturesGiveWhatTheyMust) { check_all({"png", "jpeg"}, check_picture); }
TEST(HostileFiles, LaddersAndFloatMapsGiveWhatTheyMust) { check_all({"compare"}, check_compared); }

TEST(HostileFiles, EveryFileIsExpectedOnceAndEveryExpectationHasItsFile) {
  std::set<std::string> expected;
  for (const Expectation& e : expectations()) {
    EXPECT_TRUE(expected.insert(e.file).second) << e.file << " twice";
    EXPECT_TRUE(fs::is_regular_file(kFolder + e.file)) << e.file;
  }
  EXPECT_GE(expected.size(), 150u);
  for (const char* kind : {"obj", "mtl", "toml", "png", "jpeg", "compare"})
    for (const auto& entry : fs::directory_iterator(kFolder + kind))
      EXPECT_TRUE(expected.count(kind + std::string("/") + entry.path().filename().string())) << entry.path() << " is not expected";
}

}  // namespace
}  // namespace spanray
