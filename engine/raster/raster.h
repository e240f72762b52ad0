// Visibility engine 1: the stages from world vertices to what each pixel of a tile sees. Called by render/ in this order.
#pragma once
#include "frame/frame.h"
#include "raster/clusters.h"

namespace spanray {

// Vertices -> homogeneous pixels, snapped positions, outcodes. Parallel. With `fates`: only blocks of vertices that kept
// clusters use; what stands for the others is anything.
void transform_vertices(const Frame& frame, ScreenVertices& out, const ClusterFates* fates = nullptr);

// Triangles -> screen triangles, in chunks, in order of primitives: drops invalid ones, culls (outside, back faces, no area
// after snapping), clips in double with canonical edges, sets up the depth plane. Parallel. Fills chunk.triangles and counts.
// With `fates`: looks only at clusters that are kept, and counts the others' triangles.
void clip_triangles(const Frame& frame, const ScreenVertices& vertices, TileBins& bins, FrameCounts& counts,
                    const ClusterFates* fates = nullptr);

// Screen triangles -> lists by tile. Parallel. Conservative: a listed triangle need not cover a pixel of the tile.
void bin_triangles(const Frame& frame, TileBins& bins);

// Opaque and masked triangles of one tile -> nearest primitive and depth of each pixel, seen at one place of it
// (frame/samples.h; 0: the center). Called from a task.
void rasterize_tile(const Frame& frame, const TileBins& bins, int tile, TileHits& out, int place = 0);

// Appends every fragment of translucent triangles that is not behind the opaque depth (>= passes) of the same place: primitive by
// primitive in their order, the pixels of one in an order that differs between instruction sets (composite() takes any).
void rasterize_translucent(const Frame& frame, const TileBins& bins, int tile, const TileHits& opaque, FragmentList& out,
                           int place = 0);

}  // namespace spanray
