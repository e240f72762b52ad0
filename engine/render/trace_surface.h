// What one surface of a traced pixel gets: resolved, then one light after the other, by the stage functions on a batch of one.
#pragma once
#include "ray/bvh.h"
#include "render/trace_pixel.h"
#include "shade/light.h"
#include "shade/surface.h"

namespace spanray {

// Kernels may write whole vectors past the one entry that counts.
inline constexpr size_t kLanePadding = 64;

// Radiance of a batch of one.
struct Radiance {
  AlignedBuffer<float> channel[3];
  float* pointer[3];
  Radiance() {
    for (int c = 0; c < 3; ++c) {
      channel[c].assign(kLanePadding, 0.0f);
      pointer[c] = channel[c].data();
    }
  }
  void get(float (&to)[3]) const { for (int c = 0; c < 3; ++c) to[c] = channel[c][0]; }
};

// hits: one, or none (the trace is then not valid). surface: of the hit.
SurfaceTrace trace_surface(const Frame& frame, const Bvh& opaque, const HitBatch& hits, SurfaceBatch& surface);

}  // namespace spanray
