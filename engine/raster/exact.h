// What primary rays see of exact primitives: found by the exact ray through each sample, within bounds on the screen. Both
// visibility engines call this after their triangles, so that they show the same.
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

// A plane as one eye sees it. Its depth (near / t) is linear on the screen, up to rounding.
struct PlaneOnScreen {
  double height = 0;            // height_over() of the eye: 0 hides it
  double depth0 = 0, dx = 0, dy = 0;
  double margin = 0;            // far more than rounding moves that depth within the picture
  double depth(double x, double y) const { return depth0 + dx * x + dy * y; }
};

// The spheres that each tile of a picture may show, nearest first; and all planes.
struct ExactBins {
  std::vector<PixelBox> box;            // by sphere: all pixels that it may cover; within the picture
  std::vector<float> depth;             // by sphere: no less than that of any of its points
  std::vector<uint32_t> start, sphere;  // by tile: prefix sums, size tiles + 1; indices into SceneData::spheres
  std::vector<PlaneOnScreen> plane;     // by plane
  size_t memory_bytes() const {
    return plane.capacity() * sizeof(PlaneOnScreen) + box.capacity() * sizeof(PixelBox) + depth.capacity() * sizeof(float) +
           (start.capacity() + sphere.capacity()) * sizeof(uint32_t);
  }
};
void bin_exact(const Frame& frame, ExactBins& bins);

// What a rectangle of pixels within one tile sees so far, row by row.
struct ExactTarget {
  PixelBox pixels;
  int stride = 0;
  uint32_t* primitive = nullptr;
  float* depth = nullptr;  // of the rasterizer; kUnknownDepth: that of `primitive`, which is computed where it is needed
};
inline constexpr float kUnknownDepth = std::numeric_limits<float>::quiet_NaN();

// Draws the exact primitives of a tile over what is seen through `place` (frame/samples.h).
// Input:    triangles, drawn before; Settings::culling applies.
// Output:   how many samples passed.
// Contract: one is seen where the exact primary ray meets it beyond the near plane, and nearer, as depth in float, than
//           all else there: ties go to the lowest id, and planes to the triangles that lie in them. No bound on the screen loses a hit.
uint64_t draw_exact(const Frame& frame, const ExactBins& bins, int tile, int place, const ExactTarget& target);

// The rasterizer's depth of a primitive (raster/depth_plane.h; exact ones: near / t) at a picture position; 0 of kNoPrimitive.
float depth_at(const Frame& frame, uint32_t primitive, double x, double y);

}  // namespace spanray
