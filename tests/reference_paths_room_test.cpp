// How paths are traced changes their noise, never what they find.
#include "support/path_room.h"

namespace spanray {
namespace {

TEST_F(ReferencePathsRoom, NextEventRouletteAndBranchingChangeNoExpectation) { expect_agreement(2000, 0.2); }

TEST_F(ReferencePathsRoom, ThreadsAndStepsChangeNoBitButTheSeedDoes) {
  const Scene scene = room();
  Settings settings = scene.settings();
  settings.width = 50, settings.height = 41;
  const Camera camera = camera_at(eye_, {0, -0.4, -1}, 60);
  PathOptions options;
  options.threads = 1;
  PathSums one, steps, other;
  ASSERT_TRUE(trace_paths(scene, camera, settings, options, 6, one));
  options.threads = 3;
  for (const uint32_t until : {1u, 1u, 4u, 6u}) ASSERT_TRUE(trace_paths(scene, camera, settings, options, until, steps));
  EXPECT_EQ(one.radiance, steps.radiance);
  EXPECT_EQ(one.square, steps.square);
  PathControl control;
  double last = 0;
  control.progress = [&](double fraction) {
    EXPECT_GT(fraction, last);
    last = fraction;
  };
  control.go_on = [](const PathSums& sums) { return sums.paths < 3; };
  options.seed = uint64_t{1} << 40;
  ASSERT_TRUE(trace_paths(scene, camera, settings, options, 6, other, control));
  EXPECT_EQ(other.paths, 3u);
  EXPECT_NEAR(last, 0.5, 1e-9);
  size_t equal = 0;
  for (size_t i = 0; i < one.square.size(); ++i) equal += one.radiance[3 * i] / 6 == other.radiance[3 * i] / 3;
  EXPECT_LT(equal, one.square.size() / 20);
  settings.width = 51;
  EXPECT_FALSE(trace_paths(scene, camera, settings, options, 7, other)) << "sums of another size";
}

}  // namespace
}  // namespace spanray
