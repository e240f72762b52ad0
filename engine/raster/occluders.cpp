#include "raster/occluders.h"

#include <algorithm>
#include <cmath>

#include "raster/depth_plane.h"
#include "raster/fixed_point.h"

namespace spanray {
namespace {

constexpr int64_t kBlock_24_8 = int64_t{OccluderDepths::kBlock} * kSubpixels;

int64_t floor_divide(int64_t a, int64_t b) { return a / b - (a % b < 0); }  // b > 0

// The corners, snapped as the transform kernel does it; false if the triangle needs clipping or is not finite.
bool snap(const Frame& frame, const Triangle& t, int64_t x[3], int64_t y[3], double w[3]) {
  const PrimaryRays& primary = frame.primary;
  for (int i = 0; i < 3; ++i) {
    const float* const p = frame.scene->vertices[t.vertex[i]].position;
    const glm::dvec3 v = glm::dvec3(p[0], p[1], p[2]) - primary.eye;
    const double px = dot3(primary.pixel_row_x, v), py = dot3(primary.pixel_row_y, v);
    w[i] = dot3(primary.forward, v);
    const double guard = w[i] * kGuardBandPixels;
    if (!(w[i] >= primary.near_plane && std::fabs(px) <= guard && std::fabs(py) <= guard && std::isfinite(guard))) return false;
    x[i] = snap_24_8(px / w[i]), y[i] = snap_24_8(py / w[i]);
  }
  return true;
}

// The columns of blocks of one row, all of whose points lie strictly inside of a triangle: exact integers.
class RowOfBlocks {
 public:
  RowOfBlocks(const int64_t x[3], const int64_t y[3]) : x_(x), y_(y) {
    sign_ = (x[1] - x[0]) * (y[2] - y[0]) < (x[2] - x[0]) * (y[1] - y[0]) ? -1 : 1;
  }
  void clip(int row, int64_t& first, int64_t& last) const {
    const int64_t top = row * kBlock_24_8, bottom = top + kBlock_24_8;
    for (int a = 0; a < 3; ++a) {
      const int b = a == 2 ? 0 : a + 1;
      const int64_t dx = (x_[b] - x_[a]) * sign_, dy = (y_[b] - y_[a]) * sign_;
      // dx (y - y_a) - dy (x - x_a) >= 1 at the corner that lies farthest outside.
      const int64_t room = dx * ((dx > 0 ? top : bottom) - y_[a]) - 1;
      if (dy > 0)
        last = std::min(last, floor_divide(x_[a] + floor_divide(room, dy), kBlock_24_8) - 1);
      else if (dy < 0)
        first = std::max(first, -floor_divide(floor_divide(room, -dy) - x_[a], kBlock_24_8));
      else if (room < 0)
        last = first - 1;
    }
  }

 private:
  const int64_t *x_, *y_;
  int64_t sign_;
};

// A lower bound of all depths that the triangle has in a block, in double with a margin above what the walkers' arithmetic is
// off.
class BlockDepth {
 public:
  BlockDepth(const DepthPlane& plane, const Frame& frame) : plane_(plane) {
    margin_ =
        (std::fabs(plane.depth0) + std::fabs(plane.dx) * frame.grid.width + std::fabs(plane.dy) * frame.grid.height) * 0x1p-40;
  }
  float at(int64_t column, int row) const {
    constexpr int kBlock = OccluderDepths::kBlock;
    const double x = static_cast<double>(plane_.dx > 0 ? column * kBlock : (column + 1) * kBlock);
    const double y = plane_.dy > 0 ? row * kBlock : (row + 1) * kBlock;
    const double farthest = plane_.depth0 + plane_.dx * x + plane_.dy * y - margin_;
    return static_cast<float>(std::clamp(farthest, double{plane_.min}, double{plane_.max}) * (1 - 0x1p-20));
  }

 private:
  const DepthPlane& plane_;
  double margin_;
};

void draw(const Frame& frame, const Triangle& t, OccluderDepths& out) {
  int64_t x[3], y[3];
  double w[3];
  if (!snap(frame, t, x, y, w)) return;
  const DepthPlane plane = make_depth_plane(frame, t, w);
  const RowOfBlocks blocks(x, y);
  const BlockDepth depth(plane, frame);
  const auto [low, high] = std::minmax({y[0], y[1], y[2]});
  const int end = static_cast<int>(std::min<int64_t>(out.rows, floor_divide(high, kBlock_24_8)));
  for (int row = static_cast<int>(std::max<int64_t>(0, floor_divide(low, kBlock_24_8))); row < end; ++row) {
    int64_t first = 0, last = out.columns - 1;
    blocks.clip(row, first, last);
    for (int64_t column = first; column <= last; ++column) {
      float& stored = out.depth[static_cast<size_t>(row * out.columns + column)];
      stored = std::max(stored, depth.at(column, row));
      out.any = true;
    }
  }
}

}  // namespace

void draw_occluders(const Frame& frame, const std::vector<uint32_t>& large, OccluderDepths& out) {
  constexpr int kBlock = OccluderDepths::kBlock;
  out.columns = (frame.grid.width + kBlock - 1) / kBlock, out.rows = (frame.grid.height + kBlock - 1) / kBlock;
  out.any = false;
  out.depth.assign(static_cast<size_t>(out.columns * out.rows), 0.0f);
  for (const uint32_t primitive : large) {
    const Triangle& t = frame.scene->triangles[primitive];
    if ((flags_of(frame, primitive) & (kMaterialMasked | kMaterialTranslucent)) != 0) continue;
    if (frame.settings.culling == Culling::kBack && !(facing(*frame.scene, t, frame.primary.eye) > 0)) continue;
    draw(frame, t, out);
  }
}

}  // namespace spanray
