// Where in a pixel it is looked at: the samples of anti-aliasing.
#pragma once
#include <cstdint>

namespace spanray {

inline constexpr int kMaxSamples = 16;
inline constexpr int kQuadPlace = 1 + kMaxSamples;  // the middle of a square of 2 x 2 pixels, seen from its upper left one
inline constexpr int kPlaceMask = 31;  // an index that was masked by it may be read

// A *place* is a position within a pixel: place 0 is the center, place 1 + s is sample s. One sample a pixel: only place 0.
// Source:   the standard multisample patterns of the Direct3D 11.3 functional specification, 19.2.4.1. Sample 0 is the one nearest
//           the center (of equally near ones the first).
// Contract: offsets are whole sixteenths of a pixel, so whole 24.8 units: coverage at a sample is that of the triangle moved
//           by the negated offset at the center, exactly.
struct SamplePlaces {
  int count = 1;                                    // samples a pixel: 1, 4, 8 or 16
  int32_t offset_x_24_8[1 + kMaxSamples] = {};      // from the center, y down
  int32_t offset_y_24_8[1 + kMaxSamples] = {};
  double x[1 + kPlaceMask] = {0.5};                 // from the pixel's upper left corner, in pixels
  double y[1 + kPlaceMask] = {0.5};
  int32_t left = 0, right = 0, top = 0, bottom = 0;  // least and greatest offset of any sample
  double spacing = 1;                               // side of the square that a sample stands for, in pixels

  int first() const { return count == 1 ? 0 : 1; }  // samples are places [first(), end())
  int end() const { return first() + count; }
};

// count: one of kSampleCounts (spanray/settings.h).
SamplePlaces make_sample_places(int count);

}  // namespace spanray
