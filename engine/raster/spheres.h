// What primary rays see of spheres: found by the exact ray through each sample, within bounds on the screen. Both visibility
// engines call this after their triangles, so that they show the same.
#pragma once
#include <cstdint>
#include <limits>
#include <vector>

#include "frame/frame.h"

namespace spanray {

// Pixels x0 <= x < x1, y0 <= y < y1.
struct PixelBox {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

// The spheres that each tile of a picture may show, nearest first.
struct SphereBins {
  std::vector<PixelBox> box;            // by sphere: all pixels that it may cover; within the picture
  std::vector<float> depth;             // by sphere: no less than that of any of its points
  std::vector<uint32_t> start, sphere;  // by tile: prefix sums, size tiles + 1; indices into SceneData::spheres
  size_t memory_bytes() const {
    return box.capacity() * sizeof(PixelBox) + depth.capacity() * sizeof(float) +
           (start.capacity() + sphere.capacity()) * sizeof(uint32_t);
  }
};
void bin_spheres(const Frame& frame, SphereBins& bins);

// What a rectangle of pixels within one tile sees so far, row by row.
struct SphereTarget {
  PixelBox pixels;
  int stride = 0;
  uint32_t* primitive = nullptr;
  float* depth = nullptr;  // of the rasterizer; kUnknownDepth: that of `primitive`, which is computed where it is needed
};
inline constexpr float kUnknownDepth = std::numeric_limits<float>::quiet_NaN();

// Draws the spheres of a tile over what is seen through `place` (frame/samples.h).
// Input:    triangles, drawn before; Settings::culling applies.
// Output:   how many samples passed.
// Contract: a sphere is seen where the exact primary ray meets it beyond the near plane, and nearer, as depth in float, than
//           all else there: ties go to the lowest id. No bound on the screen loses a hit.
uint64_t draw_spheres(const Frame& frame, const SphereBins& bins, int tile, int place, const SphereTarget& target);

// The rasterizer's depth of a primitive (raster/depth_plane.h; spheres: near / t) at a picture position; 0 of kNoPrimitive.
float depth_at(const Frame& frame, uint32_t primitive, double x, double y);

}  // namespace spanray
