// What takes many paths to see.
#include <cstdio>

#include "support/path_room.h"

namespace spanray {
namespace {

using ReferencePathsMany = ReferencePathsRoom;

TEST_F(ReferencePathsMany, NextEventRouletteAndBranchingChangeNoExpectation) { expect_agreement(20000, 0.05); }

// The error over 1, 4, ... 256 viewing rays: 1/sqrt(N), and the standard error that is reported is true.
TEST_F(ReferencePathsMany, ConvergesAsTheSquareRoot) {
  const Scene scene = room();
  Settings settings = scene.settings();
  settings.width = settings.height = 24;
  PathOptions options;
  options.seed = 1000;
  const Camera camera = camera_at(eye_, {0, -0.4, -1}, 60);
  PathSums truth;
  ASSERT_TRUE(trace_paths(scene, camera, settings, options, 4096, truth));
  double sx = 0, sy = 0, sxx = 0, sxy = 0, count = 0;
  for (const uint32_t paths : {1u, 4u, 16u, 64u, 256u}) {
    double square = 0;
    const int runs = paths == 1 ? 16 : 4;
    for (int run = 0; run < runs; ++run) {
      options.seed = static_cast<uint64_t>(run);
      PathSums sums;
      ASSERT_TRUE(trace_paths(scene, camera, settings, options, paths, sums));
      for (size_t i = 0; i < sums.square.size(); ++i) square += std::pow(sums.luminance(i) - truth.luminance(i), 2) / runs;
      if (paths == 256) {
        EXPECT_NEAR(sums.noise() / (truth.noise() * 4), 1, 0.1) << "16 times the paths, a quarter of the error";
      }
    }
    const double rmse = std::sqrt(square / static_cast<double>(truth.square.size())), x = std::log(paths), y = std::log(rmse);
    std::printf("%4u viewing rays: RMSE %.5f W/(m^2 sr), times sqrt(N) %.5f\n", paths, rmse, rmse * std::sqrt(paths));
    sx += x, sy += y, sxx += x * x, sxy += x * y, ++count;
  }
  const double slope = (count * sxy - sx * sy) / (count * sxx - sx * sx);
  std::printf("slope %.4f\n", slope);
  EXPECT_NEAR(slope, -0.5, 0.05);
}

}  // namespace
}  // namespace spanray
