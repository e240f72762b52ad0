// A tree with two levels: one tree for each instanced part, in the part's own space, and one over all places where it stands.
// Hits are decided on the triangles of the scene as ever; only boxes are met in part space.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/parallel.h"
#include "ray/bvh.h"
#include "ray/bvh_data.h"
#include "ray/triangle_test.h"

namespace spanray {

// A float that is less than x by a few units in its last place; -infinity below the range of floats.
[[gnu::always_inline]] inline float float_below(double x) {
  const float f = static_cast<float>(std::clamp(x, -static_cast<double>(kLargestT), static_cast<double>(kLargestT)));
  return f - (std::fabs(f) * 0x1p-22f + 0x1p-140f);
}
[[gnu::always_inline]] inline float float_above(double x) { return -float_below(-x); }

// Nodes as elsewhere, the first is the root, but every leaf is one thing with a box of its own: kLeafBit | its number. Vertices of a part's triangles
// stand in the scene, far from each other, so a ray asks for as few as it can.
using SingleTree = AlignedBuffer<BvhNode>;

// Where a part stands. A ray goes into part space as part_from_world * (origin - offset), part_from_world * direction.
//
// No hit is lost. With A = part_from_world and M, b the map that the scene's vertices went through, all as stored; omax the largest
// coordinate of a ray's origin; |A| etc. elementwise:
// * A ray that hit_triangle() accepts at t passes, at some t' <= t, a point q of the triangle of the scene within 2^-11 of the triangle's extent
//   and 2^-47 of (omax + what coordinates the triangle has) along each axis (its contract).
// * q = M p + b + r for a point p of the triangle of the part: r is what rounding to float did to vertices, |r_j| <= 2^-24 of the largest
//   |coordinate j|, and rounding in double, less than 2^-50 (|M| |p| + |b|).
// * So A (o + t' d - b) is p but for |A M - I| |p|, which is measured, and for |A| times those distances. Computing the ray's origin and direction
//   in double adds less than |A| 2^-48 (omax + |b| + |q|).
// * The triangle's extent is at most |M| times that in part space (largest row sums). Boxes of triangles are grown by `stretch` * kPartMargin of that, which is twice
//   what is needed. All else is `slack`, by which boxes grow as a ray meets them, along each axis of the part.
// slab() then rounds as it does elsewhere. What `slack` is made of is rounded up by far more than rounding in double.
//
// No touch of a sphere of radius R is lost (ray/sweep.cpp). When first_contact() accepts, its center c = s + t m is within R + e of a point q as
// above, e < 2^-44 (R + |v - s|) with v the corner of the triangle that is farthest from s. Along axis k of the part, |A_k (q - c)| <= |A_k| (R + e), A_k
// the row, in the Euclidean norm: boxes grow by |A_k| R and by `slack`. What remains is |A_k| e, and the rounding of A (s - b) and of A m. Leaves of parts hold their
// triangles whole, so what kSlack is taken of, the largest coordinate of a box seen from the center, has v in it: as |A| |M| <= 16, |A_k| e is below half of it. A (s - b)
// is a point of the part plus what is seen from the center: of the former `slack` holds 2^-32, of the latter kSlack is 2^-38, both far more than rounding takes.
struct PlacedPart {
  double part_from_world[3][3];
  double offset[3];
  double slack[3];            // along each axis of the part
  double slack_of_origin[3];  // times omax
  uint32_t first;             // triangle of the scene
  uint32_t part;              // index into InstanceTrees::parts
};

struct InstanceTrees {
  std::vector<SingleTree> parts;   // leaves: triangles, numbered within their part: i of a place is triangle first + i of the scene
  std::vector<PlacedPart> placed;
  SingleTree top;                  // leaves: indices into `placed`; boxes are those of the scene's triangles
  float bounds_min[3], bounds_max[3];
  size_t triangles = 0;          // of all places
  std::vector<TriangleRange> ranges;  // of the scene's triangles, ascending: no other tree needs to hold them
  size_t memory_bytes() const;
};

// The instances of a scene for which a tree of their part is to be used, among the triangles that a tree with this mask and value holds;
// nullptr if there are none. kAuto: those that are worth it (docs/decisions/0016-instances.md). However they are asked for, instances so stretched
// or so far out that boxes would have to grow much stay out. The bytes depend on the scene only, never on threads.
std::shared_ptr<const InstanceTrees> build_instances(const SceneData& scene, const uint32_t* material_flags, uint32_t mask, uint32_t value,
                                                     Parallel& parallel, TreeQuality quality, InstanceUse use);

}  // namespace spanray
