#pragma once
#include "frame/frame.h"
#include "simd/isa.h"

namespace spanray {

using RasterizeTileFn = void (*)(const Frame& frame, const TileBins& bins, int tile, TileHits& out, int place);
using RasterizeTranslucentFn = void (*)(const Frame& frame, const TileBins& bins, int tile, const TileHits& opaque,
                                        FragmentList& out, int place);
extern const RasterizeTileFn kRasterizeTile[kIsaCount];
extern const RasterizeTranslucentFn kRasterizeTranslucent[kIsaCount];

}  // namespace spanray
