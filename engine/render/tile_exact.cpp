#include "render/tile_exact.h"

namespace spanray {

uint64_t rasterize_exact(const Frame& frame, const ExactBins& bins, int tile, int place, TileHits& visible) {
  const TileGrid& grid = frame.grid;
  const PixelBox all{grid.x0(tile), grid.y0(tile), grid.x1(tile), grid.y1(tile)};
  return draw_exact(frame, bins, tile, place, {all, kTileSize, visible.primitive, visible.depth});
}

void add_exact(const FrameJob& job, const Chunk& chunk, int place, TileWorker& w, uint32_t* primitive) {
  w.row_t.assign(static_cast<size_t>(chunk.pixels()), kUnknownDepth);
  const PixelBox pixels{chunk.x0, chunk.y0, chunk.x0 + chunk.columns, chunk.y1};
  draw_exact(job.frame, *job.exact, chunk.tile, place, {pixels, chunk.columns, primitive, w.row_t.data()});
}

void add_exact(const FrameJob& job, const Chunk& chunk, TileWorker& w, Level& level) {
  w.row_primitive.resize(static_cast<size_t>(chunk.pixels()));
  w.pixel_order.to_rows(level.primitive.data(), chunk.columns, w.row_primitive.data());
  add_exact(job, chunk, 0, w, w.row_primitive.data());
  w.pixel_order.from_rows(w.row_primitive.data(), chunk.columns, level.primitive.data());
}

}  // namespace spanray
