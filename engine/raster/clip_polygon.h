// Clipping of one triangle in homogeneous pixels, and the cutting of the snapped polygon into triangles again.
#pragma once
#include <cstdint>

namespace spanray {

struct HomogeneousPoint { double x, y, w; };  // pixel = (x / w, y / w)
struct SnappedPoint {
  int32_t x_24_8, y_24_8;
  bool operator==(const SnappedPoint&) const = default;
};
inline constexpr int kMaxClipVertices = 8;  // 3, and one more for each of 5 planes

// The part of a triangle with w >= near_plane > 0 and |pixel| <= kGuardBandPixels, snapped. All numbers finite. Returns the number
// of corners, 0 or 3 to kMaxClipVertices. Two triangles that share an edge (positions of equal bits) get identical points on it.
int clip_to_guard_band(const HomogeneousPoint triangle[3], double near_plane, SnappedPoint out[kMaxClipVertices]);

// Cuts a polygon into at most n - 2 triangles of nonzero area that cover it, indices into `polygon`. They do not overlap if
// the polygon is simple, whether convex or not (snapping may dent it). Returns their number, or kCrossesItself: no cut is right
// then, as snapping has moved one edge across another (see inside_runs).
inline constexpr int kCrossesItself = -1;
int triangulate(const SnappedPoint* polygon, int n, uint8_t out[kMaxClipVertices - 2][3]);

// The points (x, y_24_8) with begin <= x < end, in 24.8.
struct RowRun { int32_t begin, end; };

// The points of row y_24_8 around which a polygon of 3 to kMaxClipVertices corners, whatever its edges cross, winds in the sense
// of its area; on edges by the top-left rule. Writes the runs from left to right and returns their number.
int inside_runs(const SnappedPoint* polygon, int n, int32_t y_24_8, RowRun out[kMaxClipVertices / 2]);

// The triangle that covers of all points of whole 24.8 units just those of a run, not empty, of row y_24_8.
void triangle_of_run(const RowRun& run, int32_t y_24_8, SnappedPoint out[3]);

}  // namespace spanray
