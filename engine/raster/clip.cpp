// Triangles -> screen triangles: drops, culls, clips, and sets up depth.
#include <algorithm>

#include "raster/clip_kernel.h"
#include "raster/clip_polygon.h"
#include "raster/depth_plane.h"
#include "raster/fixed_point.h"
#include "raster/raster.h"

namespace spanray {
namespace {

// The number of chunks bounds the memory of per-tile lists; their limits depend on the scene alone.
constexpr size_t kMinChunk = 4096, kMaxChunks = 128;
static_assert(kMinChunk % kClusterTriangles == 0);

// One triangle after the other, whatever it needs.
class TriangleClipper {
 public:
  TriangleClipper(const Frame& frame, const ScreenVertices& vertices, BinChunk& chunk, FrameCounts& counts)
      : frame_(frame), vertices_(vertices), chunk_(chunk), counts_(counts) {}

  void process(uint32_t primitive) {
    const Triangle& t = frame_.scene->triangles[primitive];
    uint16_t all = 0xffff, any = 0;
    for (const uint32_t v : t.vertex) {
      const uint16_t code = vertices_.outcode[v];
      all = static_cast<uint16_t>(all & code);
      any = static_cast<uint16_t>(any | code);
    }
    ++counts_.triangles_in;
    if (any & kOutInvalid) {
      ++counts_.triangles_invalid;
      return;
    }
    if (all != 0) {
      ++counts_.triangles_outside;
      return;
    }
    if (is_back_face(t)) {
      ++counts_.triangles_back_face;
      return;
    }
    const size_t drawn_before = chunk_.triangles.size();
    if (any & kOutClipMask) {
      ++counts_.triangles_clipped;
      emit_clipped(t, primitive);
    } else {
      SnappedPoint p[3];
      for (int i = 0; i < 3; ++i) p[i] = {vertices_.x_24_8[t.vertex[i]], vertices_.y_24_8[t.vertex[i]]};
      emit(p, setup(t, primitive));
    }
    ++(chunk_.triangles.size() > drawn_before ? counts_.triangles_drawn : counts_.triangles_empty);
  }

 private:
  // Edge-on triangles are no front faces: a ray misses them.
  bool is_back_face(const Triangle& t) const {
    return frame_.settings.culling == Culling::kBack && !(facing(*frame_.scene, t, frame_.primary.eye) > 0);
  }

  void emit_clipped(const Triangle& t, uint32_t primitive) {
    HomogeneousPoint corner[3];
    for (int i = 0; i < 3; ++i) corner[i] = {vertices_.x[t.vertex[i]], vertices_.y[t.vertex[i]], vertices_.w[t.vertex[i]]};
    SnappedPoint polygon[kMaxClipVertices];
    const int n = clip_to_guard_band(corner, frame_.primary.near_plane, polygon);
    if (n == 0) return;
    uint8_t piece[kMaxClipVertices - 2][3];
    const int pieces = triangulate(polygon, n, piece);
    const ScreenTriangle original = setup(t, primitive);
    if (pieces == kCrossesItself) emit_rows(polygon, n, original);
    for (int i = 0; i < pieces; ++i) {
      const SnappedPoint p[3] = {polygon[piece[i][0]], polygon[piece[i][1]], polygon[piece[i][2]]};
      emit(p, original);
    }
  }

  // A triangle for every run of samples inside. Rare: snapping moves one of the polygon's edges across another.
  void emit_rows(const SnappedPoint* polygon, int n, const ScreenTriangle& original) {
    int32_t top = polygon[0].y_24_8, bottom = top;
    for (int i = 1; i < n; ++i) top = std::min(top, polygon[i].y_24_8), bottom = std::max(bottom, polygon[i].y_24_8);
    const SamplePlaces& s = frame_.places;
    for (int place = s.first(); place < s.end(); ++place) {  // each has its own row (tests/raster_samples_test.cpp)
      const int32_t dy = s.offset_y_24_8[place];
      const int end = std::min(first_center(bottom - dy), frame_.grid.height);
      for (int row = std::max(first_center(top - dy), 0); row < end; ++row)
        emit_row(polygon, n, row * kSubpixels + kSubpixels / 2 + dy, kSubpixels / 2 + s.offset_x_24_8[place], original);
    }
  }

  // first: of the picture's samples in that row, 24.8.
  void emit_row(const SnappedPoint* polygon, int n, int32_t y, int32_t first, const ScreenTriangle& original) {
    static_assert(2 * kMaxImageSide <= kGuardBandPixels);  // triangle_of_run doubles the width
    const int32_t last = first + (frame_.grid.width - 1) * kSubpixels;
    RowRun run[kMaxClipVertices / 2];
    const int runs = inside_runs(polygon, n, y, run);
    for (int i = 0; i < runs; ++i) {
      const RowRun seen{std::max(run[i].begin, first), std::min(run[i].end, last + 1)};
      if (seen.begin >= seen.end) continue;
      SnappedPoint p[3];
      triangle_of_run(seen, y, p);
      emit(p, original);
    }
  }

  // Pixels of the picture whose samples the bounding box may meet (exact with one a pixel): columns [x0, x1), rows [y0, y1).
  struct PixelBox { int x0, x1, y0, y1; };
  PixelBox pixels_of(const SnappedPoint p[3]) const {
    const auto [x_min, x_max] = std::minmax({p[0].x_24_8, p[1].x_24_8, p[2].x_24_8});
    const auto [y_min, y_max] = std::minmax({p[0].y_24_8, p[1].y_24_8, p[2].y_24_8});
    const SamplePlaces& s = frame_.places;
    return {std::max(first_center(x_min - s.right), 0), std::min(first_center(x_max - s.left), frame_.grid.width),
            std::max(first_center(y_min - s.bottom), 0), std::min(first_center(y_max - s.top), frame_.grid.height)};
  }

  // All of a screen triangle but its corners.
  ScreenTriangle setup(const Triangle& t, uint32_t primitive) const {
    const double view_depth[3] = {vertices_.w[t.vertex[0]], vertices_.w[t.vertex[1]], vertices_.w[t.vertex[2]]};
    const DepthPlane plane = make_depth_plane(frame_, t, view_depth);
    ScreenTriangle s;
    s.primitive = primitive;
    s.flags = flags_of(frame_, primitive);
    s.depth_min = plane.min, s.depth_max = plane.max;
    s.depth0 = plane.depth0, s.depth_dx = plane.dx, s.depth_dy = plane.dy;
    return s;
  }

  // Appends the piece unless it has no area or no sample.
  void emit(const SnappedPoint p[3], ScreenTriangle s) {
    const PixelBox box = pixels_of(p);
    const int64_t area = int64_t{p[1].x_24_8 - p[0].x_24_8} * (p[2].y_24_8 - p[0].y_24_8) -
                         int64_t{p[2].x_24_8 - p[0].x_24_8} * (p[1].y_24_8 - p[0].y_24_8);
    if (box.x0 >= box.x1 || box.y0 >= box.y1 || area == 0) return;
    for (int i = 0; i < 3; ++i) s.x_24_8[i] = p[i].x_24_8, s.y_24_8[i] = p[i].y_24_8;
    const auto tile_of = [](int pixel) { return static_cast<uint32_t>(pixel / kTileSize); };
    chunk_.triangles.push_back(s);
    chunk_.tile_box.push_back(pack_tile_box(tile_of(box.x0), tile_of(box.x1 - 1), tile_of(box.y0), tile_of(box.y1 - 1)));
    chunk_.has_translucent |= (s.flags & kMaterialTranslucent) != 0;
  }

  const Frame& frame_;
  const ScreenVertices& vertices_;
  BinChunk& chunk_;
  FrameCounts& counts_;
};

}  // namespace

void clip_triangle(const Frame& frame, const ScreenVertices& vertices, uint32_t primitive, BinChunk& chunk, FrameCounts& counts) {
  TriangleClipper(frame, vertices, chunk, counts).process(primitive);
}

void clip_triangles(const Frame& frame, const ScreenVertices& vertices, TileBins& bins, FrameCounts& counts,
                    const ClusterFates* fates) {
  const size_t n = frame.scene->triangles.size();
  const size_t share = (n + kMaxChunks - 1) / kMaxChunks;
  const size_t chunk_size = std::max(kMinChunk, (share + kClusterTriangles - 1) / kClusterTriangles * kClusterTriangles);
  bins.grid = frame.grid;
  bins.chunks.resize((n + chunk_size - 1) / chunk_size);
  std::vector<FrameCounts> chunk_counts(bins.chunks.size());
  frame.parallel->for_each(bins.chunks.size(), [&](size_t i, int) {
    BinChunk& chunk = bins.chunks[i];
    chunk.triangles.clear(), chunk.tile_box.clear();
    chunk.has_translucent = false;
    kClipRange[isa_index(frame.isa)](frame, vertices, static_cast<uint32_t>(i * chunk_size),
                                     static_cast<uint32_t>(std::min(n, (i + 1) * chunk_size)),
                                     fates == nullptr ? nullptr : fates->fate.data(), chunk, chunk_counts[i]);
  });
  for (const FrameCounts& c : chunk_counts) counts.add(c);
}

}  // namespace spanray
