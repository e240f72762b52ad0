// For each pixel the least and the greatest color that a renderer of the same model may give it
// (docs/decisions/0013-ambiguity-mask.md).
#pragma once
#include <cstdint>
#include <vector>

namespace spanray {

// sRGB codes, not rounded, 0 to 255: 3 floats a pixel (R, G, B), row-major, top row first. least <= greatest.
struct AmbiguityMask {
  int width = 0, height = 0;
  std::vector<float> least, greatest;  // 3 * width * height
  // Pixels whose mirrors spread so far that what they show was not enumerated: left open upward. Files do not keep it.
  uint64_t open = 0;
};

// The errors that a mask allows for. The defaults are bounds that are published: of this renderer's numerical contract, and of
// what the specifications of graphics interfaces ask of others.
struct AmbiguityBounds {
  double pixels = 1.0 / 256;  // how far vertices move, in x and in y: 24.8 fixed point (Direct3D 11.3, 3.2.4.1), contract 8
  double texels = 1.5 / 256;  // coordinates 1/256 (hard case I1), weights of texels 1/512 (D3D 11.3, 7.18.8; contract 13)
  double levels = 1.0 / 128;          // level of detail and its weight (D3D 11.3, 7.18.8: 8 bits of fraction)
  bool any_opengl_footprint = false;  // all footprints between the bounds of OpenGL 4.6, 8.14.1, instead of the exact length
  double depth = 1.0 / (1 << 20);     // relative; contract 10 says 1.6e-7
  double position = 1.0 / (1 << 20);  // of points where rays start, relative to the coordinates that they are computed from
  double codes = 1;                   // shading in float and the step to bytes (D3D 11.3, 3.2.3.6: 0.6 for the step alone)
};

}  // namespace spanray
