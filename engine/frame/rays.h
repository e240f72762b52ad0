// Rays and hits: what the two visibility engines give to shading. A hit is {ray, primitive, instance} and nothing more;
// shade/ recomputes everything else from the ray and the original triangle (DESIGN 1).
#pragma once
#include <algorithm>
#include <cstdint>

#include "core/aligned.h"
#include "math/vec.h"
#include "scene/scene_data.h"

namespace spanray {

// All primary rays of a frame, analytically, in double:
//   direction(x, y) = corner + x * step_x + y * step_y,  x, y in pixels, pixel (i, j) has its center at (i + 1/2, j + 1/2).
// Every direction has view depth 1: dot(direction, forward) = 1. So t of a primary hit is its view depth, and
// depth = near / t (reversed z: 1 at the near plane, 0 at infinity and in the background).
struct PrimaryRays {
  glm::dvec3 eye{0}, corner{0}, step_x{0}, step_y{0}, forward{0};
  double near_plane = 0.01;
  int width = 0, height = 0;
  // Homogeneous pixel position of a world point p: dot(row.xyz, p - eye) for X, Y, W; pixel = (X / W, Y / W), W = view depth.
  // The eye is subtracted first, in double: worlds far from the origin keep their digits.
  glm::dvec3 pixel_row_x{0}, pixel_row_y{0};
  float single_step_x[3] = {}, single_step_y[3] = {};  // step_x and step_y, rounded
};

// Pixels are named x | y << 16 everywhere.
inline uint32_t pack_pixel(uint32_t x, uint32_t y) { return x | (y << 16); }

// Rays of any kind but primary, as arrays. Directions need not be unit length; t counts in units of the direction.
// The differentials (Igehy 1999, "Tracing Ray Differentials") give the footprint; only bounce rays carry them.
struct RayBatch {
  AlignedBuffer<float> origin[3], direction[3];
  AlignedBuffer<float> t_max;        // a hit at exactly t_max counts; infinity for closest hits
  AlignedBuffer<uint32_t> from;      // the triangle that the ray leaves, and so never hits; empty: no ray leaves one
  AlignedBuffer<uint32_t> pixel;     // the pixel that started the ray: the screen-door mask, and where results go
  AlignedBuffer<float> origin_dx[3], origin_dy[3], direction_dx[3], direction_dy[3];  // empty without differentials
  int count = 0;
  // True for rays through one place (frame/samples.h) of `pixel`: shade/ then takes Frame::primary instead of these rounded numbers,
  // so that accept(hit) and the surfaces are those of the rasterizer, bit for bit.
  bool primary = false;
  int place = 0;

  void resize(int n, bool with_differentials) {
    count = n;
    for (int k = 0; k < 3; ++k) {
      origin[k].resize(n), direction[k].resize(n);
      if (with_differentials) origin_dx[k].resize(n), origin_dy[k].resize(n), direction_dx[k].resize(n), direction_dy[k].resize(n);
    }
    t_max.resize(n), pixel.resize(n);
  }
  size_t memory_bytes() const {
    size_t bytes = t_max.bytes() + from.bytes() + pixel.bytes();
    for (int k = 0; k < 3; ++k)
      bytes += origin[k].bytes() + direction[k].bytes() + origin_dx[k].bytes() + origin_dy[k].bytes() + direction_dx[k].bytes() +
               direction_dy[k].bytes();
    return bytes;
  }
};

// What was hit: by primary rays of the named pixels (rays == nullptr) through `place`, or by (*rays)[ray[i]].
// Entries with primitive == kNoPrimitive are misses.
struct HitBatch {
  const RayBatch* rays = nullptr;
  AlignedBuffer<uint32_t> pixel;      // of each entry
  AlignedBuffer<uint32_t> ray;        // index into rays; unused for primary rays
  AlignedBuffer<uint32_t> primitive;
  AlignedBuffer<uint32_t> instance;   // empty: all are instance 0
  AlignedBuffer<uint32_t> place;      // of primary rays in their pixels (frame/samples.h); empty: all go through the centers
  int count = 0;

  void resize(int n, bool with_ray) {
    count = n;
    pixel.resize(n), primitive.resize(n);
    if (with_ray) ray.resize(n);
  }
  // Makes misses of the entries behind the last, as far as a vector that begins before it reads. No byte of a picture depends on them.
  void pad() {
    constexpr size_t kMost = AlignedBuffer<uint32_t>::kPadding / sizeof(uint32_t);
    if (count == 0) return;
    std::fill_n(pixel.data() + count, kMost, pixel[static_cast<size_t>(count) - 1]);
    std::fill_n(primitive.data() + count, kMost, kNoPrimitive);
    if (!ray.empty()) std::fill_n(ray.data() + count, kMost, 0u);
    if (!place.empty()) std::fill_n(place.data() + count, kMost, 0u);
  }
  size_t memory_bytes() const { return pixel.bytes() + ray.bytes() + primitive.bytes() + instance.bytes() + place.bytes(); }
};

}  // namespace spanray
