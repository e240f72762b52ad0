// What a frame cost and did.
#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace spanray {

inline constexpr int kNumericContract = 4;

// Milliseconds. Stages inside tiles are thread time divided by the number of threads; frame is wall time without file output.
// bvh_build: of the trees in use. It is part of the frame only where motion asked for them (counts: bvh_rebuilds), not of the first.
// light_grid_build: of the light grids in use; part of no frame.
struct StageTimes {
  double pose = 0, bvh_refit = 0, transform = 0, clip = 0, bin = 0, raster = 0, shade = 0, shadow_rays = 0, bounce_rays = 0, composite = 0,
         encode = 0, frame = 0, bvh_build = 0, light_grid_build = 0;
};

// How full the vectors of a kernel were: lanes computed in the frame, and those of use. Depends on the instruction set.
//   raster_walkers  triangles wider than a few pixels: samples that passed the depth test
//   raster_packets  tiny triangles, one a lane: samples inside
//   planes          what a triangle sets up for the pixels that see it in a cell of 16 x 16
//   surfaces        hits of every kind that are shaded
struct LaneOccupancy {
  std::string kernel;
  uint64_t computed = 0, used = 0;
};

struct FrameStats {
  StageTimes ms;
  std::vector<std::pair<std::string, uint64_t>> counts;  // name, value
  std::vector<LaneOccupancy> lanes;
  uint64_t memory_bytes = 0;                             // of the renderer's own buffers, scene not included
  std::string isa;
  int threads = 0;
  std::vector<std::string> warnings;                     // counted warnings, e.g. dropped triangles
};

// One line of the plan: a stage, whether this scene and these settings need it, and why.
struct PlanLine {
  std::string stage;
  bool needed = false;
  std::string reason;
};

}  // namespace spanray
