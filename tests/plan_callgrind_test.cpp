// What a scene does not need costs no instructions: callgrind counts those of Renderer::render, with a technique left to the plan
// and with the same technique switched off by hand. They agree within 0.1 %. Valgrind knows no AVX-512: avx2.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "math/elementary.h"
#include "scene/scene_builder.h"
#include "spanray/render.h"

namespace spanray {
namespace {

// A ball of `bands` x 2 bands quads, radius 1, matte or (for the counter-check) mirroring.
Scene ball(bool mirror) {
  constexpr int kBands = 16;
  const auto corner = [](int i, int j) {
    double st, ct, sp, cp;
    sin_cos(kPi * i / kBands, &st, &ct);
    sin_cos(kPi * j / kBands, &sp, &cp);
    const float p[3] = {static_cast<float>(st * cp), static_cast<float>(ct), static_cast<float>(-st * sp)};
    return Vertex{{p[0], p[1], p[2]}, {p[0], p[1], p[2]}, {static_cast<float>(j), static_cast<float>(i)}};
  };
  std::vector<SoupTriangle> soup;
  for (int i = 0; i < kBands; ++i)
    for (int j = 0; j < 2 * kBands; ++j) {
      soup.push_back({{corner(i, j), corner(i + 1, j), corner(i + 1, j + 1)}, 0});
      soup.push_back({{corner(i, j), corner(i + 1, j + 1), corner(i, j + 1)}, 0});
    }
  Material material;
  if (mirror) material.mirror[0] = material.mirror[1] = material.mirror[2] = 0.5f;
  auto data = std::make_shared<SceneData>(make_test_scene(soup, {material}));
  Light light;
  light.position[1] = light.position[2] = 4;
  light.intensity[0] = light.intensity[1] = light.intensity[2] = 40;
  data->lights.push_back(light);
  hash_scene(*data);
  return Scene(data);
}

// Renders one frame with the named techniques off: "", "reflections", "textures", "bump", "transparency", ... ; a leading '+': mirror ball.
int child(std::string variant) {
  const bool mirror = variant.starts_with("+");
  if (mirror) variant.erase(0, 1);
  Settings s;
  s.width = 160, s.height = 120, s.threads = 1, s.isa = Isa::kAvx2;
  if (variant == "reflections") s.reflections = Reflections::kNone;
  if (variant == "textures") s.textures = false;
  if (variant == "bump") s.bump = false;
  if (variant == "transparency") s.transparency = Transparency::kNone;
  const Scene scene = ball(mirror);
  Renderer renderer;
  Framebuffer out;
  const auto stats = renderer.render(scene, scene.cameras()[0], s, out);
  if (!stats) std::fprintf(stderr, "%s\n", stats.error().to_string().c_str());
  return stats ? 0 : 1;
}

// Instructions inside Renderer::render of a child process with this variant.
uint64_t instructions(const std::string& variant) {
  const std::string out = testing::TempDir() + "callgrind." + std::to_string(getpid()) + "." + variant;
  const std::string self = std::filesystem::read_symlink("/proc/self/exe");
  const std::string command = "valgrind --tool=callgrind --callgrind-out-file='" + out +
                              "' --toggle-collect='spanray::Renderer::render*' '" + self + "' --child=" + variant + " 2>'" + out + ".log'";
  const int status = std::system(command.c_str());
  uint64_t count = 0;
  std::ifstream in(out);
  for (std::string line; std::getline(in, line);)
    if (line.starts_with("totals:") || line.starts_with("summary:")) count = std::strtoull(line.c_str() + line.find(':') + 1, nullptr, 10);
  std::ifstream log(out + ".log");
  EXPECT_EQ(status, 0) << std::string(std::istreambuf_iterator<char>(log), {});
  std::filesystem::remove(out), std::filesystem::remove(out + ".log");
  return count;
}

bool can_run() { return std::system("valgrind --version > /dev/null 2>&1") == 0 && __builtin_cpu_supports("avx2"); }

TEST(PlanCallgrind, LeftOutIsLeftOut) {
  if (!can_run()) GTEST_SKIP() << "needs valgrind and avx2";
  const uint64_t planned = instructions("all");
  ASSERT_GT(planned, 1000000u) << "nothing was counted";
  for (const char* off : {"reflections", "textures", "bump", "transparency"}) {
    const uint64_t by_hand = instructions(off);
    const double ratio = static_cast<double>(planned) / static_cast<double>(by_hand);
    std::printf("%s: %llu planned, %llu off by hand, ratio %.6f\n", off, static_cast<unsigned long long>(planned),
                static_cast<unsigned long long>(by_hand), ratio);
    EXPECT_NEAR(ratio, 1.0, 0.001) << off;
  }
}

// The measure can tell a technique that is needed.
TEST(PlanCallgrind, NeededIsCounted) {
  if (!can_run()) GTEST_SKIP() << "needs valgrind and avx2";
  EXPECT_GT(static_cast<double>(instructions("+all")), 1.01 * static_cast<double>(instructions("+reflections")));
}

}  // namespace
}  // namespace spanray

int main(int argc, char** argv) {
  const std::string option = argc == 2 ? argv[1] : "";
  if (option.starts_with("--child=")) return spanray::child(option.substr(8));
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
