#include "raster/clip_polygon.h"

#include <algorithm>

#include "raster/fixed_point.h"

namespace spanray {
namespace {

enum Plane { kNear, kLeft, kRight, kTop, kBottom, kPlaneCount };

struct Polygon {
  HomogeneousPoint point[kMaxClipVertices];
  int size = 0;
  void add(const HomogeneousPoint& p) { point[size++] = p; }
};

// Signed distance, up to scale; inside is >= 0. Its sign is exact: guard * w is, and a difference of doubles is zero only if they
// are equal. So it agrees with the comparisons of the transform kernel.
double distance(Plane plane, const HomogeneousPoint& p, double near_plane) {
  const double guard = p.w * kGuardBandPixels;
  switch (plane) {
    case kNear: return p.w - near_plane;
    case kLeft: return p.x + guard;
    case kRight: return guard - p.x;
    case kTop: return p.y + guard;
    default: return guard - p.y;
  }
}

// The point on `plane` between a and b, which lie on different sides. Swapping a and b negates numerators and denominator exactly,
// so both triangles at an edge get the same bits; both products have one sign, so nothing cancels that the inputs do not cancel.
HomogeneousPoint intersect(Plane plane, const HomogeneousPoint& a, double da, const HomogeneousPoint& b, double db,
                           double near_plane) {
  const double scale = db - da;
  HomogeneousPoint p{(a.x * db - b.x * da) / scale, (a.y * db - b.y * da) / scale, (a.w * db - b.w * da) / scale};
  switch (plane) {  // onto the plane, exactly
    case kNear: p.w = near_plane; break;
    case kLeft: p.x = -p.w * kGuardBandPixels; break;
    case kRight: p.x = p.w * kGuardBandPixels; break;
    case kTop: p.y = -p.w * kGuardBandPixels; break;
    default: p.y = p.w * kGuardBandPixels; break;
  }
  return p;
}

Polygon clip(const Polygon& in, Plane plane, double near_plane) {
  Polygon out;
  for (int i = 0; i < in.size; ++i) {
    const HomogeneousPoint &a = in.point[i], &b = in.point[i + 1 == in.size ? 0 : i + 1];
    const double da = distance(plane, a, near_plane), db = distance(plane, b, near_plane);
    const bool a_inside = da >= 0, b_inside = db >= 0;
    if (a_inside && out.size < kMaxClipVertices) out.add(a);
    if (a_inside != b_inside && out.size < kMaxClipVertices) out.add(intersect(plane, a, da, b, db, near_plane));
  }
  return out;
}

// Twice the signed area; exact: coordinates fit 25 bits.
int64_t area2(const SnappedPoint& a, const SnappedPoint& b, const SnappedPoint& c) {
  return int64_t{b.x_24_8 - a.x_24_8} * (c.y_24_8 - a.y_24_8) - int64_t{c.x_24_8 - a.x_24_8} * (b.y_24_8 - a.y_24_8);
}

// Twice the signed area, positive if the inside lies to the right of edges that go up (y points down).
int64_t area2_of(const SnappedPoint* polygon, int n) {
  int64_t sum = 0;
  for (int i = 2; i < n; ++i) sum += area2(polygon[0], polygon[i - 1], polygon[i]);
  return sum;
}

int64_t ceil_divide(int64_t a, int64_t b) { return a / b + (a % b > 0); }  // b > 0

// What is left of a polygon while its ears are cut off.
struct Rest {
  const SnappedPoint* polygon;
  uint8_t index[kMaxClipVertices];
  int size;

  const SnappedPoint& at(int i) const { return polygon[index[(i + size) % size]]; }
  void remove(int i) {
    --size;
    for (; i < size; ++i) index[i] = index[i + 1];
  }
  bool is_ear(int i, int64_t orientation) const {
    const SnappedPoint &a = at(i - 1), &b = at(i), &c = at(i + 1);
    if ((area2(a, b, c) > 0) != (orientation > 0)) return false;
    for (int k = 0; k < size; ++k) {
      const SnappedPoint& p = at(k);
      if (p == a || p == b || p == c) continue;
      const int64_t e0 = area2(a, b, p), e1 = area2(b, c, p), e2 = area2(c, a, p);
      if (orientation > 0 ? (e0 >= 0 && e1 >= 0 && e2 >= 0) : (e0 <= 0 && e1 <= 0 && e2 <= 0)) return false;
    }
    return true;
  }
};

}  // namespace

// Source:   Sutherland and Hodgman 1974, "Reentrant Polygon Clipping".
// Contract: every plane is applied, in one order, to every triangle that needs clipping at all, and each step is symmetric in the
//           end points of an edge. So what happens to an edge is a function of its two end points, whatever triangle it is in;
//           edges without a point outside stay as they are, as in triangles that are not clipped.
int clip_to_guard_band(const HomogeneousPoint triangle[3], double near_plane, SnappedPoint out[kMaxClipVertices]) {
  Polygon polygon;
  for (int i = 0; i < 3; ++i) polygon.add(triangle[i]);
  for (int plane = 0; plane < kPlaneCount; ++plane) polygon = clip(polygon, static_cast<Plane>(plane), near_plane);
  if (polygon.size < 3) return 0;
  for (int i = 0; i < polygon.size; ++i) {
    const HomogeneousPoint& p = polygon.point[i];
    out[i] = {snap_24_8(p.x / p.w), snap_24_8(p.y / p.w)};
  }
  return polygon.size;
}

// Source:   ear clipping (Meisters 1975, "Polygons Have Ears"), in exact integers. A fan would overlap itself where snapping has
//           dented the polygon, and draw over a neighbour.
int triangulate(const SnappedPoint* polygon, int size, uint8_t out[kMaxClipVertices - 2][3]) {
  const int n = std::min(size, kMaxClipVertices);
  Rest rest{polygon, {}, n};
  for (int i = 0; i < n; ++i) rest.index[i] = static_cast<uint8_t>(i);
  const int64_t orientation = area2_of(polygon, n);
  int count = 0;
  while (rest.size >= 3) {
    int flat = -1, ear = -1;
    for (int i = 0; i < rest.size && flat < 0; ++i) {
      if (area2(rest.at(i - 1), rest.at(i), rest.at(i + 1)) == 0) flat = i;
      else if (ear < 0 && rest.is_ear(i, orientation)) ear = i;
    }
    if (flat < 0 && ear < 0) return kCrossesItself;
    const int cut = flat >= 0 ? flat : ear;
    if (flat < 0) {
      for (int k = 0; k < 3; ++k) out[count][k] = rest.index[(cut + k - 1 + rest.size) % rest.size];
      ++count;
    }
    rest.remove(cut);
  }
  return count;
}

// Source:   the nonzero winding number rule (PostScript Language Reference), for one sign only. The windings of neighbours add up,
//           as the edge they share counts once each way: to 1 inside a mesh, to 0 or 1 at the near plane, whose edges are nobody
//           else's. Where a polygon is folded it winds -1 times, so its neighbours cover that place without it.
// Contract: exact, products are below 2^50; the rule at edges is that of coverage-inl.h.
int inside_runs(const SnappedPoint* polygon, int size, int32_t y, RowRun out[kMaxClipVertices / 2]) {
  struct Crossing { int32_t x, turns; };
  const int n = std::min(size, kMaxClipVertices), sense = area2_of(polygon, n) < 0 ? -1 : 1;
  Crossing crossing[kMaxClipVertices];
  int count = 0;
  for (int i = 0; i < n; ++i) {
    const SnappedPoint &a = polygon[i], &b = polygon[i + 1 == n ? 0 : i + 1];
    const bool down = a.y_24_8 < b.y_24_8;
    const SnappedPoint &top = down ? a : b, &bottom = down ? b : a;
    if (y < top.y_24_8 || y >= bottom.y_24_8) continue;
    const int64_t moved = int64_t{y - top.y_24_8} * (bottom.x_24_8 - top.x_24_8);
    const int32_t x = top.x_24_8 + static_cast<int32_t>(ceil_divide(moved, bottom.y_24_8 - top.y_24_8));
    int k = count++;
    for (; k > 0 && crossing[k - 1].x > x; --k) crossing[k] = crossing[k - 1];
    crossing[k] = {x, down ? -sense : sense};
  }
  int runs = 0;
  for (int i = 0, winding = 0; i + 1 < count; ++i) {
    winding += crossing[i].turns;
    const RowRun run{crossing[i].x, crossing[i + 1].x};
    if (winding <= 0 || run.begin == run.end) continue;
    if (runs > 0 && out[runs - 1].end == run.begin) out[runs - 1].end = run.end;  // winds twice from here, or once again
    else out[runs++] = run;
  }
  return runs;
}

// One row high on either side: its left edge is upright, its right one crosses the row at `end`.
void triangle_of_run(const RowRun& run, int32_t y, SnappedPoint out[3]) {
  out[0] = {run.begin, y - 1}, out[1] = {run.begin, y + 1}, out[2] = {run.begin + 2 * (run.end - run.begin), y + 1};
}

}  // namespace spanray
