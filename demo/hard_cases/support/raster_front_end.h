// Runs the raster stages over a test frame.
#pragma once
#include <memory>
#include <vector>

#include "raster/raster.h"
#include "support/test_frame.h"

namespace spanray {

struct FrontEnd {
  ScreenVertices vertices;
  TileBins bins;
  FrameCounts counts;
};

inline FrontEnd run_front_end(const Frame& frame) {
  FrontEnd f;
  transform_vertices(frame, f.vertices);
  clip_triangles(frame, f.vertices, f.bins, f.counts);
  bin_triangles(frame, f.bins);
  return f;
}

struct Picture {
  int width = 0, height = 0;
  std::vector<uint32_t> primitive;
  std::vector<float> depth;
  uint32_t id(int x, int y) const { return primitive[static_cast<size_t>(y * width + x)]; }
  float z(int x, int y) const { return depth[static_cast<size_t>(y * width + x)]; }
};

inline Picture rasterize(const Frame& frame, const TileBins& bins, int place = 0) {
  const TileGrid& grid = frame.grid;
  Picture p{grid.width, grid.height, {}, {}};
  p.primitive.resize(static_cast<size_t>(grid.width * grid.height));
  p.depth.resize(p.primitive.size());
  frame.parallel->for_each(static_cast<size_t>(grid.count()), [&](size_t i, int) {
    const int tile = static_cast<int>(i);
    const auto hits = std::make_unique<TileHits>();
    rasterize_tile(frame, bins, tile, *hits, place);
    for (int y = grid.y0(tile); y < grid.y1(tile); ++y)
      for (int x = grid.x0(tile); x < grid.x1(tile); ++x) {
        const int from = (y - grid.y0(tile)) * kTileSize + x - grid.x0(tile);
        p.primitive[static_cast<size_t>(y * p.width + x)] = hits->primitive[from];
        p.depth[static_cast<size_t>(y * p.width + x)] = hits->depth[from];
      }
  });
  return p;
}
inline Picture rasterize(const Frame& frame) { return rasterize(frame, run_front_end(frame).bins); }

// Every fragment of the translucent triangles in front of `opaque`, tile after tile.
inline FragmentList all_fragments(const Frame& frame, const TileBins& bins, int place = 0) {
  FragmentList list;
  const auto hits = std::make_unique<TileHits>();
  for (int tile = 0; tile < frame.grid.count(); ++tile) {
    rasterize_tile(frame, bins, tile, *hits, place);
    rasterize_translucent(frame, bins, tile, *hits, list, place);
  }
  return list;
}

// +1 a fragment: the scene's materials must be translucent (see translucent_material).
inline std::vector<int> count_fragments(const Frame& frame, const TileBins& bins, int place = 0) {
  std::vector<int> count(static_cast<size_t>(frame.grid.width * frame.grid.height), 0);
  for (const uint32_t pixel : all_fragments(frame, bins, place).pixel)
    ++count[static_cast<size_t>((pixel >> 16) * static_cast<uint32_t>(frame.grid.width) + (pixel & 0xffff))];
  return count;
}

inline Material translucent_material() {
  Material m;
  m.transparency = static_cast<int32_t>(MaterialTransparency::kAlpha);
  m.opacity = 0.5f;
  return m;
}

}  // namespace spanray
