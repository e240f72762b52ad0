// One tile, from visibility to bytes: the loop of DESIGN 1. Everything a tile makes lives in the worker that makes it.
#pragma once
#include <memory>
#include <vector>

#include "frame/frame.h"
#include "raster/exact.h"
#include "ray/bvh.h"
#include "ray/light_grid.h"
#include "render/coarse_quads.h"
#include "render/pixel_order.h"
#include "render/stage_clock.h"
#include "render/tile_samples.h"
#include "shade/direct.h"
#include "shade/light.h"
#include "shade/surface.h"
#include "spanray/render.h"

namespace spanray {

// Rows of pixels shaded at once, at the most: their surfaces fit the second-level cache.
inline constexpr int kChunkRows = kCellSize;

// The part of a tile that is shaded at once.
struct Chunk {
  int tile, x0, columns, y0, y1;
  int pixels() const { return columns * (y1 - y0); }
};

// What a set of rays of one kind sees and sends back: level 0 are primary rays, level k the rays of the k-th bounce.
// A *slot* is one ray of the level: at level 0 a pixel of the chunk, in the order of TileWorker::pixel_order, or with several samples
// a pixel what find_sample_slots (render/tile_samples.h) makes of them.
struct Level {
  RayBatch rays;                       // levels above 0, and level 0 when visibility is by rays
  AlignedBuffer<uint32_t> pixel;       // by slot
  AlignedBuffer<uint32_t> place;       // by slot of level 0, with several samples a pixel; else empty
  AlignedBuffer<uint32_t> primitive;   // by slot: opaque hit
  AlignedBuffer<float> radiance[3];    // by slot
  AlignedBuffer<float> opaque_t;       // by slot: infinity for misses
  AlignedBuffer<float> transmittance;  // by slot, of the translucent layers; only if the frame has some
  AlignedBuffer<uint32_t> parent;      // by slot: slot of the level before, or with several samples pixel of the chunk
  AlignedBuffer<float> weight[3];      // by slot: what its radiance is multiplied by there
  HitBatch hits;                       // the slots that hit, compacted
  AlignedBuffer<uint32_t> slot_of_hit;
  SurfaceBatch surfaces;
  // At shading rate 2x2 (render/coarse_quads.h), else empty: of level 0.
  std::vector<Quad> quads;
  AlignedBuffer<uint32_t> shading_place;  // by slot: where in its pixel it is shaded
  AlignedBuffer<uint32_t> whole_slot;     // by pixel of the chunk
  int slots = 0;

  void resize(int n, bool translucents);
  size_t memory_bytes() const;
};

struct TileWorker {
  TileHits visible;
  std::unique_ptr<SampleHits> samples;  // only with several a pixel
  FragmentList fragments, chunk_fragments;
  std::vector<std::unique_ptr<Level>> levels;
  // Scratch of one batch being lit.
  RayBatch shadow_rays;
  AlignedBuffer<uint32_t> surface_of_ray, occluded, lit;
  AlignedBuffer<float> radiance[3];
  HitBatch fragment_hits;
  AlignedBuffer<int32_t> fragment_slot;
  SurfaceBatch fragment_surfaces;
  PixelOrder pixel_order;                         // of a chunk's pixels; with one sample a pixel, of the slots of level 0
  AlignedBuffer<float> row_radiance[3], row_t;    // results of level 0 row by row, where they are asked for
  AlignedBuffer<uint32_t> row_primitive, encoded, encoded_hits;
  FrameCounts counts;
  StageClock clock;
  size_t memory_bytes() const;
};

// What all tiles of a frame read, and where they write: each pixel belongs to one tile, each tile to one task.
struct FrameJob {
  const Frame& frame;
  const TileBins* bins = nullptr;  // visibility by rasterization
  const Bvh* opaque = nullptr;     // shadow, bounce and primary rays
  const Bvh* translucent = nullptr;
  Framebuffer& out;
  const FrameRequest& request;
  const ExactBins* exact = nullptr;  // only if the scene has exact primitives
  const LightGrids* grids = nullptr;  // for shadow rays; nullptr: none

  // For arrays besides the bytes of the picture.
  bool asks_for_more() const {
    return request.radiance || request.depth || request.primitive || request.normal || request.uv || request.ladder != nullptr;
  }
  // Whether the radiance of level 0 stays with the hits (TileWorker::radiance), since it only becomes bytes: these are brought to
  // the slots.
  bool keeps_radiance_of_hits() const {
    const PlanFlags& plan = frame.plan;
    return !asks_for_more() && frame.places.count == 1 && !plan.translucents && !plan.bounces && !plan.coarse_quads &&
           !can_shade_direct(frame);
  }
};

// Finished pixels of a chunk, row by row: level 0 itself, or what resolve_samples made of it.
struct ChunkPixels {
  const float* radiance[3];
  const float* opaque_t;
  const uint32_t* primitive;
};

// The steps of render_tile before anything is shaded, for `why`: a tile's visibility, then level 0 of a chunk.
void see_tile(const FrameJob& job, int tile, TileWorker& worker);
void start_chunk(const FrameJob& job, const Chunk& chunk, TileWorker& worker, Level& level);

void render_tile(const FrameJob& job, int tile, TileWorker& worker);

}  // namespace spanray
