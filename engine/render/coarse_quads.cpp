#include "render/coarse_quads.h"

#include <algorithm>

#include "render/tile.h"

namespace spanray {
namespace {

constexpr uint32_t kNoSlot = 0xffffffffu;

bool share_vertex(const Triangle& a, const Triangle& b) {
  return std::any_of(a.vertex, a.vertex + 3, [&](uint32_t v) { return std::find(b.vertex, b.vertex + 3, v) != b.vertex + 3; });
}

bool all_equal(const uint32_t (&p)[4]) { return p[0] == p[1] && p[0] == p[2] && p[0] == p[3]; }

// Least weight of a triangle's corners where the primary ray through (x, y) meets its plane: below zero outside. In double.
// Source: Olano and Greer 1997 (shade/resolve-inl.h).
double least_weight(const Frame& frame, uint32_t primitive, double x, double y) {
  const PrimaryRays& p = frame.primary;
  const glm::dvec3 d = p.corner + p.step_x * x + p.step_y * y;
  glm::dvec3 v[3];
  for (int i = 0; i < 3; ++i) {
    const float* at = frame.scene->vertices[frame.scene->triangles[primitive].vertex[i]].position;
    v[i] = glm::dvec3(at[0], at[1], at[2]) - p.eye;
  }
  const double e[3] = {dot3(d, cross3(v[1], v[2])), dot3(d, cross3(v[2], v[0])), dot3(d, cross3(v[0], v[1]))};
  const double sum = e[0] + e[1] + e[2];
  return std::min({e[0] / sum, e[1] / sum, e[2] / sum});
}

// Of what the pixels see, the triangle that the middle is in, or nearest to.
uint32_t choose_primitive(const Frame& frame, const Quad& quad, uint32_t first_pixel) {
  if (all_equal(quad.primitive)) return quad.primitive[0];
  const double x = (first_pixel & 0xffff) + 1.0, y = (first_pixel >> 16) + 1.0;
  uint32_t best = quad.primitive[0];
  double most = least_weight(frame, best, x, y);
  for (int k = 1; k < 4; ++k)
    if (const double w = least_weight(frame, quad.primitive[k], x, y); w > most) most = w, best = quad.primitive[k];
  return best;
}

// By pixel of the chunk, row by row: the slot that is all of it, or kNoSlot where samples see different surfaces, or layers.
void find_whole_slots(const Chunk& chunk, const TileWorker& w, Level& level) {
  const bool samples = !level.place.empty();
  level.whole_slot.assign(static_cast<size_t>(chunk.pixels()), kNoSlot);
  const auto of_slot = [&](size_t slot) -> uint32_t& {
    if (samples) return level.whole_slot[level.parent[slot]];
    const uint32_t at = w.pixel_order.pixel()[slot];
    return level.whole_slot[(at >> 16) * static_cast<uint32_t>(chunk.columns) + (at & 0xffff)];
  };
  for (size_t slot = 0; slot < static_cast<size_t>(level.slots); ++slot)
    if (!samples || level.weight[0][slot] == 1) of_slot(slot) = static_cast<uint32_t>(slot);
  for (const int32_t slot : w.fragment_slot) of_slot(static_cast<size_t>(slot)) = kNoSlot;
}

}  // namespace

bool is_one_surface(const Frame& frame, const uint32_t (&primitive)[4]) {
  if (std::find(primitive, primitive + 4, kNoPrimitive) != primitive + 4) return false;
  if (all_equal(primitive)) return true;
  if (frame.settings.shading == Shading::kFlat) return false;  // each face has a light of its own
  if (std::any_of(primitive, primitive + 4, [&](uint32_t p) { return !frame.scene->is_triangle(p); })) return false;
  const Triangle& first = frame.scene->triangles[primitive[0]];
  return std::all_of(primitive + 1, primitive + 4, [&](uint32_t p) {
    const Triangle& other = frame.scene->triangles[p];
    return material_of(first) == material_of(other) && share_vertex(first, other);
  });
}

void find_quads(const Frame& frame, const Chunk& chunk, const TileWorker& w, Level& level) {
  const size_t slots = static_cast<size_t>(level.slots);
  level.quads.clear();
  level.shading_place.assign(slots, 0);
  if (!level.place.empty()) std::copy_n(level.place.data(), slots, level.shading_place.data());
  find_whole_slots(chunk, w, level);
  for (int y = 0; y + 1 < chunk.y1 - chunk.y0; y += 2)
    for (int x = 0; x + 1 < chunk.columns; x += 2) {
      const uint32_t *const row = level.whole_slot.data() + y * chunk.columns + x, *const below = row + chunk.columns;
      Quad quad = {{row[0], row[1], below[0], below[1]}, {}};
      if (std::find(quad.slot, quad.slot + 4, kNoSlot) != quad.slot + 4) continue;
      for (int k = 0; k < 4; ++k) quad.primitive[k] = level.primitive[quad.slot[k]];
      if (!is_one_surface(frame, quad.primitive)) continue;
      const uint32_t shaded = quad.slot[0];
      for (const uint32_t slot : quad.slot) level.primitive[slot] = kNoPrimitive;
      level.primitive[shaded] = choose_primitive(frame, quad, level.pixel[shaded]);
      level.shading_place[shaded] = kQuadPlace;
      level.quads.push_back(quad);
    }
}

void spread_quads(Level& level) {
  for (const Quad& quad : level.quads)
    for (int k = 0; k < 4; ++k) {
      const uint32_t slot = quad.slot[k], shaded = quad.slot[0];
      for (auto& channel : level.radiance) channel[slot] = channel[shaded];
      level.opaque_t[slot] = level.opaque_t[shaded];
      level.primitive[slot] = quad.primitive[k];
    }
}

}  // namespace spanray
