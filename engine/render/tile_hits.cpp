#include "render/tile_hits.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "render/slots_kernel.h"

namespace spanray {

void compact_hits(const Frame& frame, Level& level, bool primary) {
  const size_t slots = static_cast<size_t>(level.slots);
  level.slot_of_hit.resize(slots);
  level.hits.resize(level.slots, false);
  const int hits = pick_slots(frame.isa, level.primitive.data(), level.pixel.data(), level.slots, level.slot_of_hit.data(),
                              level.hits.primitive.data(), level.hits.pixel.data());
  level.slot_of_hit.resize(static_cast<size_t>(hits));
  level.hits.resize(hits, !primary);
  if (!primary) std::copy_n(level.slot_of_hit.data(), hits, level.hits.ray.data());
  const AlignedBuffer<uint32_t>& place = level.shading_place.empty() ? level.place : level.shading_place;
  level.hits.place.resize(place.empty() ? 0 : level.slot_of_hit.size());
  for (size_t i = 0; i < level.hits.place.size(); ++i) level.hits.place[i] = place[level.slot_of_hit[i]];
  level.hits.rays = primary ? nullptr : &level.rays;
  level.hits.pad();
}

void scatter_hits(const Frame& frame, TileWorker& w, Level& level) {
  if (level.hits.count == level.slots) {  // hits are then slots
    for (int c = 0; c < 3; ++c) std::swap(level.radiance[c], w.radiance[c]);
    if (frame.plan.depths) std::copy_n(level.surfaces.t, level.slots, level.opaque_t.data());
    return;
  }
  const float* const from[4] = {w.radiance[0].data(), w.radiance[1].data(), w.radiance[2].data(), level.surfaces.t};
  float* const to[4] = {level.radiance[0].data(), level.radiance[1].data(), level.radiance[2].data(), level.opaque_t.data()};
  const float* const background = frame.scene->background;
  const float miss[4] = {background[0], background[1], background[2], std::numeric_limits<float>::infinity()};
  const int fields = frame.plan.depths ? 4 : 3;
  for (int k = 0; k < fields; ++k) spread_hits(frame.isa, level.primitive.data(), level.slots, from[k], miss[k], to[k]);
}

}  // namespace spanray
