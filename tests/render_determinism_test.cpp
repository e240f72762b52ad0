// The determinism matrix within one build: every instruction set x 1, 2, 7 threads (7: with the slowly built tree) x a poisoned floating-point
// control register give the bytes of tests/golden. `script/test --matrix` runs it in every build. SPANRAY_UPDATE_GOLDEN=1 rewrites the goldens:
// that is a new numeric contract (CHANGELOG.md).
#include <gtest/gtest.h>
#include <xmmintrin.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "core/hash.h"
#include "frame/ladder.h"
#include "image/metrics.h"
#include "simd/isa.h"
#include "spanray/render.h"
#include "support/golden_frames.h"

namespace spanray {
namespace {

const std::string kSource = SPANRAY_SOURCE_DIR;
const std::string kGoldenDir = kSource + "/tests/golden/";

struct Hashes {
  std::string size, color, ids, depth;
  bool operator==(const Hashes& o) const { return size == o.size && color == o.color && ids == o.ids && depth == o.depth; }
};
std::ostream& operator<<(std::ostream& out, const Hashes& h) {
  return out << h.size << " color " << h.color << " ids " << h.ids << " depth " << h.depth;
}

// name size color ids depth, a line each; # starts a comment.
std::map<std::string, Hashes> read_goldens() {
  std::map<std::string, Hashes> goldens;
  std::ifstream in(kGoldenDir + "frames.txt");
  for (std::string line; std::getline(in, line);) {
    std::istringstream fields(line);
    std::string name;
    Hashes h;
    if (line.starts_with("#") || !(fields >> name >> h.size >> h.color >> h.ids >> h.depth)) continue;
    goldens[name] = h;
  }
  return goldens;
}

struct Rendered {
  Framebuffer frame;
  Ladder ladder;
  Hashes hashes;
};

void render(const GoldenFrame& golden, const Scene& scene, Isa isa, int threads, Rendered& out) {
  Settings settings = golden.settings;
  settings.isa = isa;
  settings.threads = threads;
  settings.tree = threads == 7 ? TreeQuality::kHigh : TreeQuality::kFast;
  settings.light_grids = threads == 1 ? LightGridUse::kNever : LightGridUse::kAlways;
  Renderer renderer;
  FrameRequest request;
  request.depth = request.primitive = true;
  request.ladder = &out.ladder;
  const Result<FrameStats> stats = renderer.render(scene, scene.cameras()[golden.camera], settings, out.frame, request);
  ASSERT_TRUE(stats) << stats.error().to_string();
  ASSERT_EQ(stats.value().threads, threads);
  const Framebuffer& f = out.frame;
  out.hashes = {std::to_string(settings.width) + "x" + std::to_string(settings.height), hash_text(hash_image(f.color)),
                hash_text(Hash().add(f.primitive.data(), f.primitive.size() * 4).value()),
                hash_text(Hash().add(f.depth.data(), f.depth.size() * 4).value())};
}

// The picture's hash where nothing else is asked for: stages then leave out what nobody reads.
std::string hash_of_color_alone(const GoldenFrame& golden, const Scene& scene, Isa isa) {
  Settings settings = golden.settings;
  settings.isa = isa;
  settings.threads = 2;
  Framebuffer frame;
  const Result<FrameStats> stats = Renderer().render(scene, scene.cameras()[golden.camera], settings, frame);
  return stats ? hash_text(hash_image(frame.color)) : stats.error().to_string();
}

std::string failure_folder() {
  const char* folder = std::getenv("SPANRAY_FAILURES");
  const std::string path = folder != nullptr ? folder : "golden-failures";
  std::filesystem::create_directories(path);
  return path + "/";
}

// Expected, actual and difference pictures, for a person to look at.
std::string write_pictures(const std::string& name, const Image& expected, const Image& actual) {
  const std::string base = failure_folder() + name;
  (void)write_png(base + "-expected.png", expected);
  (void)write_png(base + "-actual.png", actual);
  if (expected.width == actual.width && expected.height == actual.height)
    (void)write_png(base + "-difference.png", difference_picture(expected, actual));
  return "pictures: " + base + "-{expected,actual,difference}.png";
}

class Golden : public testing::TestWithParam<GoldenFrame> {};

TEST_P(Golden, R17_OneHash) {
  const GoldenFrame& golden = GetParam();
  const Result<LoadedScene> loaded = load_scene(kSource + "/assets/" + golden.scene);
  ASSERT_TRUE(loaded) << loaded.error().to_string();
  const Scene& scene = loaded.value().scene;
  ASSERT_LT(golden.camera, scene.cameras().size());

  Rendered first;
  ASSERT_NO_FATAL_FAILURE(render(golden, scene, Isa::kScalar, 1, first));
  for (int isa = 0; isa < kIsaCount; ++isa) {
    const Isa set = static_cast<Isa>(isa + 1);
    if (!isa_supported(set)) continue;
    EXPECT_EQ(hash_of_color_alone(golden, scene, set), first.hashes.color) << golden.name << ": " << isa_name(set) << ", nothing but color";
    for (const int threads : {1, 2, 7}) {
      // A host linked with -ffast-math: flush to zero, denormals are zero, round up.
      const bool poison = threads == 2;
      const unsigned saved = _mm_getcsr();
      if (poison) _mm_setcsr(saved | 0x8040u | 0x4000u);
      Rendered other;
      render(golden, scene, set, threads, other);
      const unsigned after = _mm_getcsr();
      _mm_setcsr(saved);
      if (poison) {
        EXPECT_EQ(after & 0xe040u, 0xc040u) << "the host's control register was not restored";
      }
      if (HasFatalFailure()) return;
      EXPECT_TRUE(other.hashes == first.hashes)
          << golden.name << ": " << isa_name(set) << ", " << threads << " threads" << (poison ? ", poisoned MXCSR" : "") << "\n  "
          << other.hashes << "\n  differs from scalar, 1 thread\n  " << first.hashes << "\n  first difference: "
          << Ladder::first_difference(first.ladder, other.ladder).to_string() << "\n  "
          << write_pictures(golden.name, first.frame.color, other.frame.color);
    }
  }
  if (std::getenv("SPANRAY_UPDATE_GOLDEN") != nullptr) {
    ASSERT_TRUE(write_png(kGoldenDir + golden.name + ".png", first.frame.color));
    std::ofstream out(kGoldenDir + "frames.txt." + golden.name);  // script/update-golden puts them together
    out << golden.name << " " << first.hashes.size << " " << first.hashes.color << " " << first.hashes.ids << " "
        << first.hashes.depth << "\n";
    return;
  }
  const auto goldens = read_goldens();
  const auto it = goldens.find(golden.name);
  ASSERT_NE(it, goldens.end()) << golden.name << " has no line in tests/golden/frames.txt";
  if (first.hashes == it->second) return;
  const Result<Image> expected = read_png(kGoldenDir + golden.name + ".png");
  ADD_FAILURE() << golden.name << "\n  " << first.hashes << "\n  differs from tests/golden/frames.txt\n  " << it->second << "\n  "
                << (expected ? write_pictures(golden.name, expected.value(), first.frame.color) : expected.error().to_string());
}

INSTANTIATE_TEST_SUITE_P(Frames, Golden, testing::ValuesIn(golden_frames()),
                         [](const testing::TestParamInfo<GoldenFrame>& frame) { return frame.param.name; });

// Each line of frames.txt belongs to a frame: a stale line would look like coverage.
TEST(GoldenList, HasNoStaleLines) {
  const auto frames = golden_frames();
  for (const auto& [name, hashes] : read_goldens())
    EXPECT_TRUE(std::any_of(frames.begin(), frames.end(), [&n = name](const GoldenFrame& f) { return f.name == n; })) << name;
}

}  // namespace
}  // namespace spanray
