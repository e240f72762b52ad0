// What the largest opaque triangles hide, in blocks of 16 x 16 pixels: clusters behind them are dropped before their vertices
// are transformed.
// Source:   Greene, Kass and Miller 1993, "Hierarchical Z-Buffer Visibility": a box whose nearest point lies behind is not seen.
// Contract: depth of a block: every fragment of its pixels that is seen lies there or nearer, at every sample. What is strictly
//           behind wins no pixel and is no layer of one, so dropping it changes nothing but counts (DESIGN 3, rule 6).
#pragma once
#include <cstdint>
#include <vector>

#include "frame/frame.h"

namespace spanray {

struct OccluderDepths {
  static constexpr int kBlock = 16;  // pixels
  int columns = 0, rows = 0;
  bool any = false;            // some block has a depth
  AlignedBuffer<float> depth;  // reversed z, row-major; 0: nothing known

  // Whether blocks of columns [x0, x1] and rows [y0, y1] all have a depth above `nearest`.
  bool hides(int x0, int x1, int y0, int y1, float nearest) const {
    for (int y = y0; y <= y1; ++y)
      for (int x = x0; x <= x1; ++x)
        if (!(depth[static_cast<size_t>(y * columns + x)] > nearest)) return false;
    return true;
  }
};

inline constexpr size_t kMostOccluders = 128;

// Draws primitives `large`, as far as they are opaque, seen from the front where back faces are culled, and need no clipping.
void draw_occluders(const Frame& frame, const std::vector<uint32_t>& large, OccluderDepths& out);

}  // namespace spanray
