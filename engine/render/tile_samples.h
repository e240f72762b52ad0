// More than one sample a pixel: from what each of them sees to what is shaded, and back to pixels (docs/decisions/0007-samples.md).
// Nothing here runs, and nothing is allocated, with one.
#pragma once
#include <vector>

#include "frame/frame.h"
#include "frame/ladder.h"

namespace spanray {

struct Chunk;
struct FrameJob;
struct Level;
struct TileWorker;

// From one sample of a tile to the next, a cache line beyond its end: the samples of a pixel then lie in different sets of the cache.
inline constexpr int kSamplePlane = kTilePixels + 16;

// What the samples of a tile see, and the pixels of a chunk that come of it.
struct SampleHits {
  AlignedBuffer<uint32_t> primitive;      // sample by sample (kSamplePlane), row-major kTileSize x kTileSize
  FragmentList fragments[kMaxSamples];    // translucent, by sample: of the tile if it was rasterized, else of the chunk
  // Of a chunk, by pixel and sample: entries [start[i], start[i + 1]) of `fragment`, i = pixel * samples + sample, ascending.
  std::vector<uint32_t> start;
  AlignedBuffer<uint32_t> fragment;       // primitives
  RayBatch rays;                          // of one sample, where visibility is by rays
  AlignedBuffer<uint32_t> traced;
  // Resolved pixels of a chunk. primitive and t: those of sample 0, the one nearest the center.
  AlignedBuffer<float> radiance[3], front_t;
  AlignedBuffer<uint32_t> front;

  size_t memory_bytes() const;
};

// Primary rays of the engine that traces, rounded to float. Shading does not use them: it takes the exact ones.
void make_primary_batch(const Frame& frame, const uint32_t* pixel, int count, int place, RayBatch& rays);

// Translucent layers of primary rays (make_primary_batch), those left out that lie behind what `opaque`, by ray, names:
// visibility must be decided before pixels or samples are grouped, as the rasterizer does.
void trace_layers(const FrameJob& job, const RayBatch& rays, const uint32_t* opaque, FragmentList& out);

// Rasterizes a tile once a sample.
void rasterize_samples(const FrameJob& job, int tile, TileWorker& worker);

// Level 0 of a chunk: a slot for each surface, with its layers, that distinct samples of a pixel see (supersampling: for each
// sample), weighted by their number; parent: the pixel in the chunk. The slots of a pixel follow each other, first that of sample 0.
// Translucent fragments of the slots: worker.chunk_fragments, fragment_slot.
// Contract: a slot is shaded at the center if all samples see it, else at its sample nearest the center (of equally near ones the
//           first). Triangles are convex: what all samples see covers the center, so no attribute is extrapolated.
void find_sample_slots(const FrameJob& job, const Chunk& chunk, TileWorker& worker, Level& level);

// Weighted sums, in linear light: level 0 -> worker.samples.
void resolve_samples(const Chunk& chunk, const Level& level, TileWorker& worker);

// True for the slot of level 0 that sample 0 sees, or any where there is one sample a pixel.
bool is_front_slot(const Level& level, uint32_t slot);

}  // namespace spanray
