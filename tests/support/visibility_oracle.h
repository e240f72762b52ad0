// The visibility buffer of a whole frame, one pixel after the other, in order of primitives: slow, obvious, without lanes, tiles or
// bins. Vertices, clipping and depth planes are the engine's (each has its own test); all else is not.
#pragma once
#include <algorithm>

#include "raster/clip_polygon.h"
#include "raster/depth_plane.h"
#include "support/coverage_oracle.h"
#include "support/raster_front_end.h"

namespace spanray {

// DESIGN 3, rule 10: double, rounded once, then clamped.
inline float oracle_depth(const DepthPlane& plane, int x, int y) {
  const double depth = (plane.depth0 + (y + 0.5) * plane.dy) + (x + 0.5) * plane.dx;
  const float rounded = static_cast<float>(depth);
  return std::min(rounded > plane.min ? rounded : plane.min, plane.max);
}

inline void oracle_draw(const Frame& frame, const SnappedPoint p[3], const DepthPlane& plane, uint32_t primitive, Picture& out) {
  const int32_t xs[3] = {p[0].x_24_8, p[1].x_24_8, p[2].x_24_8}, ys[3] = {p[0].y_24_8, p[1].y_24_8, p[2].y_24_8};
  const auto [x_min, x_max] = std::minmax({xs[0], xs[1], xs[2]});
  const auto [y_min, y_max] = std::minmax({ys[0], ys[1], ys[2]});
  const bool masked = (flags_of(frame, primitive) & kMaterialMasked) != 0;
  for (int y = std::max(0, y_min / 256 - 1); y <= std::min(out.height - 1, y_max / 256 + 1); ++y)
    for (int x = std::max(0, x_min / 256 - 1); x <= std::min(out.width - 1, x_max / 256 + 1); ++x) {
      if (!oracle_covers(xs, ys, x, y)) continue;
      const float depth = oracle_depth(plane, x, y);
      const size_t i = static_cast<size_t>(y * out.width + x);
      if (!(depth > out.depth[i])) continue;  // equal depth stays with the lower id
      if (masked && (frame.accept_row(frame, primitive, x, y, 1, 0) & 1) == 0) continue;
      out.depth[i] = depth;
      out.primitive[i] = primitive;
    }
}

// A polygon that crosses itself, row by row.
inline void oracle_draw_rows(const Frame& frame, const SnappedPoint* polygon, int n, const DepthPlane& plane,
                             uint32_t primitive, Picture& out) {
  for (int y = 0; y < out.height; ++y) {
    RowRun run[kMaxClipVertices / 2];
    const int runs = inside_runs(polygon, n, y * 256 + 128, run);
    for (int i = 0; i < runs; ++i) {
      SnappedPoint p[3];
      triangle_of_run(run[i], y * 256 + 128, p);
      oracle_draw(frame, p, plane, primitive, out);
    }
  }
}

inline Picture oracle_picture(const Frame& frame, const ScreenVertices& v) {
  Picture out{frame.grid.width, frame.grid.height, {}, {}};
  out.primitive.assign(static_cast<size_t>(out.width * out.height), kNoPrimitive);
  out.depth.assign(out.primitive.size(), 0.0f);
  const SceneData& scene = *frame.scene;
  for (uint32_t primitive = 0; primitive < scene.triangles.size(); ++primitive) {
    const Triangle& t = scene.triangles[primitive];
    if (flags_of(frame, primitive) & kMaterialTranslucent) continue;
    if (frame.settings.culling == Culling::kBack && !(facing(scene, t, frame.primary.eye) > 0)) continue;
    uint16_t any = 0;
    HomogeneousPoint corner[3];
    SnappedPoint polygon[kMaxClipVertices];
    double view_depth[3];
    for (int i = 0; i < 3; ++i) {
      const uint32_t k = t.vertex[i];
      any = static_cast<uint16_t>(any | v.outcode[k]);
      corner[i] = {v.x[k], v.y[k], v.w[k]};
      polygon[i] = {v.x_24_8[k], v.y_24_8[k]};
      view_depth[i] = v.w[k];
    }
    if (any & kOutInvalid) continue;
    uint8_t piece[kMaxClipVertices - 2][3] = {{0, 1, 2}};
    int pieces = 1, size = 3;
    if (any & kOutClipMask) {
      const int n = clip_to_guard_band(corner, frame.primary.near_plane, polygon);
      pieces = n == 0 ? 0 : triangulate(polygon, n, piece);
      size = n;
    }
    const DepthPlane plane = make_depth_plane(frame, t, view_depth);
    if (pieces == kCrossesItself) oracle_draw_rows(frame, polygon, size, plane, primitive, out);
    for (int i = 0; i < pieces; ++i) {
      const SnappedPoint p[3] = {polygon[piece[i][0]], polygon[piece[i][1]], polygon[piece[i][2]]};
      oracle_draw(frame, p, plane, primitive, out);
    }
  }
  return out;
}

}  // namespace spanray
