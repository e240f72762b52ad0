// The space around a light in cells, each with the triangles that shadow rays from there may meet: what a tree finds again for every
// packet of rays, found once.
// Source:   Haines and Greenberg 1986, "The Light Buffer: A Shadow-Testing Accelerator".
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/aligned.h"
#include "core/parallel.h"
#include "ray/bvh.h"
#include "scene/scene_data.h"

namespace spanray {

// One light. A place x belongs to a cell by y = x - center:
//   point lights: six faces of a cube around the light. On the face of the axis k along which |y| is largest (2k, or 2k + 1 where y[k] < 0),
//                 (u, v) = (y[k + 1], y[k + 2]) / |y[k]|; its nearness to the light is 1 / |y[k]|.
//   directional:  one face, across the light: (u, v, nearness) = axis y.
// u and v are in [-1, 1], in `side` cells each. Places outside belong to the nearest cell: it has all that their rays may meet.
struct LightGrid {
  // A triangle as a face sees it: (at_u, at_v, at_1) . (u, v, 1) are three edge functions e, and a nearness n at its plane. A ray from (u, v, nearness)
  //   misses it if some e < 0 or n < nearness (1 - 2^-20), directional: nearness - 2^-20;
  //   hits it if every e > sure and n - slack > nearness (1 + 2^-20), directional: nearness + 2^-20.
  // Else hit_triangle() has to say.
  struct alignas(64) Seen {
    float at_u[4], at_v[4], at_1[4];
    float sure, slack;
    uint32_t place;      // of the triangle among those of all blocks of the tree
    uint32_t primitive;
  };
  bool directional = false;
  float center[3] = {0, 0, 0};
  float axis[3][3] = {};
  float reach = 0;                // places farther from the center along an axis ask the tree
  int side = 0;
  // Cells face by face, in squares of 8 x 8 of them, row by row (v), column by column (u). Cell c has n = first[c + 1] - first[c] entries, the
  // nearest first, none that others hide wholly. From words[3 first[c]] on, n words of each of
  //   nearness  a float, no less than that of any point of the triangle in the cell: of nearer places it stands in no ray's way
  //   box       of its part in the cell, in bytes from 0 to 255 along a side: least u, least v, 255 - greatest u, 255 - greatest v
  //   seen      which triangle
  AlignedBuffer<uint32_t> first, words;
  AlignedBuffer<Seen> seen;
  std::vector<uint32_t> touching;  // places of triangles so near to a point light that directions to them mean little: of every cell

  int faces() const { return directional ? 1 : 6; }
  size_t memory_bytes() const { return first.bytes() + words.bytes() + seen.bytes() + touching.capacity() * sizeof(uint32_t); }
};

// For every light its grid, or nullptr where the tree answers as well: it has instances, coordinates that are too large, too much around a
// light.
class LightGrids {
 public:
  LightGrids() = default;
  // bvh: of the opaque triangles, which must outlive this; material_flags as in Frame.
  LightGrids(const SceneData& scene, const uint32_t* material_flags, const Bvh& bvh, Parallel& parallel);
  const LightGrid* of(size_t light) const { return light < grids_.size() && grids_[light].side > 0 ? &grids_[light] : nullptr; }
  size_t count() const;  // lights that have one
  size_t memory_bytes() const;

 private:
  std::vector<LightGrid> grids_;
};

// trace_any() for rays to the light of a grid, which answers the same: each starts anywhere and ends at the light or before it, but
// for rounding of its direction to float. bvh: the one that the grid was made from.
void trace_to_light(const Frame& frame, const Bvh& bvh, const LightGrid& grid, const RayBatch& rays, uint32_t* out);

}  // namespace spanray
