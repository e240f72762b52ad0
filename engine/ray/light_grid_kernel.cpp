// Shadow rays in packets against the triangles in the cells of a light where they start.
// Contract: what trace_any() answers: hit_triangle() decides about triangles, and those that it would accept are in the cell.
#include <algorithm>
#include <bit>
#include <cstdint>

#include "frame/frame.h"
#include "ray/bvh_data.h"
#include "ray/light_grid_kernel.h"
#include "ray/triangle_test.h"
#include "simd/dispatch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ray/light_grid_kernel.cpp"
#include "hwy/foreach_target.h"
#include "hwy/cache_control.h"
#include "ray/packet-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {

// More triangles than these, and the tree is asked about the rays that are left.
constexpr int kMostTested = 48;

// Of the reach: all places of the scene, and a little. Rays from farther out bend more than cells are larger than they are.
constexpr float kNear = 0.5f + 0x1p-10f;

// Places so far outside the square of a directional light ask the tree: edges that have all of a face on one side say nothing there.
constexpr float kOutside = 1.5f;

// Where rays start, as the light sees it. known: the others ask the tree.
// in_cell: bytes u, v, 255 - u, 255 - v.
struct PlacesSeen { I32 face, cell, in_cell; F32 u, v, nearness, least, greatest; Mask known; };

// A column or row, and where in it, from 0 to 255.
struct PlaceAlong { I32 at, part; };
HWY_INLINE PlaceAlong place_along(F32 u, int side) {
  const float half = static_cast<float>(side) * 0.5f;
  const F32 along = clamp_(mul_add(u, f32(half), f32(half)), F32::zero(), f32(static_cast<float>(side)));
  const I32 at = min_(to_i32_small(along), i32(side - 1));
  return {at, to_i32_small(mul_add(along - to_f32(at), f32(255.0f), f32(0.5f)))};
}

// The greatest of each byte of kCount lanes.
template <int kCount, class D> HWY_INLINE uint32_t greatest_bytes(D d, hn::Vec<D> words) {
#if HWY_TARGET != HWY_SCALAR
  if constexpr (kCount > 1) {
    const hn::Half<D> half;
    const hn::Repartition<uint8_t, hn::Half<D>> bytes;
    const auto a = hn::BitCast(bytes, hn::LowerHalf(half, words)), b = hn::BitCast(bytes, hn::UpperHalf(half, words));
    return greatest_bytes<kCount / 2>(half, hn::BitCast(half, hn::Max(a, b)));
  }
#endif
  (void)d;
  return static_cast<uint32_t>(hn::GetLane(words));
}

// Words none of whose bytes is greater than that of `most`.
HWY_INLINE Mask bytes_within(I32 words, uint32_t most) {
#if HWY_TARGET == HWY_SCALAR
  const uint32_t w = static_cast<uint32_t>(hn::GetLane(words.v));
  bool within = true;
  for (int k = 0; k < 32; k += 8) within = within && (w >> k & 255u) <= (most >> k & 255u);
  return first_lanes(within ? 1 : 0);
#else
  const hn::Repartition<uint8_t, DI> bytes;
  return I32{hn::BitCast(DI(), hn::Min(hn::BitCast(bytes, words.v), hn::BitCast(bytes, i32(most).v)))} == words;
#endif
}

HWY_INLINE PlacesSeen see(const LightGrid& grid, const F32 (&origin)[3]) {
  F32 y[3], size[3];
  PlacesSeen p;
  p.known = first_lanes(kLanes);
  for (int k = 0; k < 3; ++k) y[k] = origin[k] - f32(grid.center[k]), size[k] = abs_(y[k]), p.known = p.known & (size[k] <= f32(grid.reach * kNear));
  if (grid.directional) {
    const auto along = [&](int r) HWY_ATTR { return mul_add(y[0], f32(grid.axis[r][0]), mul_add(y[1], f32(grid.axis[r][1]), y[2] * f32(grid.axis[r][2]))); };
    p.face = I32::zero(), p.u = along(0), p.v = along(1), p.nearness = along(2);
    p.known = p.known & (abs_(p.u) <= f32(kOutside)) & (abs_(p.v) <= f32(kOutside));
    p.least = p.nearness - f32(0x1p-20f), p.greatest = p.nearness + f32(0x1p-20f);
  } else {
    const Mask third = (size[2] > size[0]) & (size[2] > size[1]), second = and_not(third, size[1] > size[0]);
    const auto by_axis = [&](F32 a, F32 b, F32 c) HWY_ATTR { return select(third, c, select(second, b, a)); };
    const F32 inverse = f32(1.0f) / by_axis(size[0], size[1], size[2]), along = by_axis(y[0], y[1], y[2]);
    p.u = by_axis(y[1], y[2], y[0]) * inverse, p.v = by_axis(y[2], y[0], y[1]) * inverse, p.nearness = inverse;
    p.least = inverse * f32(1 - 0x1p-20f), p.greatest = inverse * f32(1 + 0x1p-20f);
    p.face = select(third, i32(4), select(second, i32(2), i32(0))) + select(along < F32::zero(), i32(1), i32(0));
  }
  const PlaceAlong column = place_along(p.u, grid.side), row = place_along(p.v, grid.side);
  const I32 square = (p.face * i32(grid.side / 8) + shift_right<3>(row.at)) * i32(grid.side / 8) + shift_right<3>(column.at);
  p.cell = shift_left<6>(square) + shift_left<3>(row.at & i32(7)) + (column.at & i32(7));
  const I32 part = column.part | shift_left<8>(row.part);
  p.in_cell = part | shift_left<16>(part ^ i32(0xffff));
  return p;
}

// Which rays may hit a triangle, which surely do, and which start surely behind its plane.
struct SeenHits { Mask maybe, sure, behind; };
HWY_INLINE SeenHits meet(const LightGrid::Seen& t, F32 u, F32 v, F32 least, F32 greatest) {
  const auto at = [&](int i) HWY_ATTR { return mul_add(u, f32(t.at_u[i]), mul_add(v, f32(t.at_v[i]), f32(t.at_1[i]))); };
  const F32 edge = cull_min(cull_min(at(0), at(1)), at(2)), near = at(3);
  const Mask behind = near - f32(t.slack) > greatest;
  return {(edge >= F32::zero()) & (near >= least), (edge > f32(t.sure)) & behind, behind};
}

// Some rays of a packet that start in one cell: its entries, those rays' box as of LightGrid::Entry, with the greatest instead of the least
// and the other way round, and what all of them are as near as.
struct Visit { uint32_t rays, begin, count, box; float least; };

class GridPackets {
 public:
  GridPackets(const Bvh::Data& data, const Batch& batch, const LightGrid& grid) : data_(data), grid_(grid), rays_(batch.rays), packet_(data, batch) {}

  // Packets from ray `first` on, kAhead at most: sets the bits of rays that something stops. What they will ask for is on its way from memory
  // before the first of them is looked at.
  HWY_INLINE void trace(int first, uint32_t* out) {
    first_ = first, visits_ = 0;
    const int packets = std::min(kAhead, (rays_.count - first + kLanes - 1) / kLanes);
    for (int j = 0; j < packets; ++j) look(j);
    for (int j = 0; j < packets; ++j) {
      test(j);
      const int at = first + j * kLanes;
      out[at / 32] |= (used_[j] & ~alive_) << (at % 32);
    }
  }

  static constexpr int kAhead = 8;

 private:
  HWY_INLINE void look(int j) {
    const int at = first_ + j * kLanes, n = std::min(rays_.count - at, kLanes);
    const RawRays raw = load_raw(rays_, at, n);
    const PlacesSeen& p = places_[j] = see(grid_, raw.origin);
    used_[j] = (1u << n) - 1;
    visits_before_[j] = visits_;
    visits_before_[j + 1] = visits_;
    by_tree_[j] = (used_[j] & ~to_bits(p.known)) != 0;
    if (by_tree_[j]) return;
    alignas(64) uint32_t cells[kLanes];
    p.cell.store(cells);
    for (uint32_t open = used_[j]; open != 0;) {
      const uint32_t cell = cells[std::countr_zero(open)];
      const Mask here = p.cell == i32(cell);
      const uint32_t rays = to_bits(here) & open;
      open &= ~rays;
      const uint32_t begin = grid_.first[cell], end = grid_.first[cell + 1];
      if (begin == end) continue;
      hwy::Prefetch(grid_.words.data() + size_t{3} * begin);
      visit_[visits_++] = {rays, begin, end - begin, greatest_bytes<kLanes>(DI(), select(here, p.in_cell, I32::zero()).v),
                           least_lane(select(here, p.least, f32(std::numeric_limits<float>::infinity())))};
    }
    visits_before_[j + 1] = visits_;
  }

  HWY_INLINE void test(int j) {
    at_ = first_ + j * kLanes, alive_ = used_[j], started_ = false, tested_ = 0;
    const PlacesSeen& p = places_[j];
    if (by_tree_[j]) return by_tree();
    for (const uint32_t place : grid_.touching) ask(place, alive_);
    const I32 from = from_lanes(rays_, at_, std::popcount(used_[j]));
    const bool one_face = all(p.face == i32(first_lane(p.face)));
    uint32_t last = ~uint32_t{0};
    for (int i = visits_before_[j]; i < visits_before_[j + 1]; ++i) {
      const Visit& visit = visit_[i];
      if ((visit.rays & alive_) == 0) continue;
      const uint32_t* const words = grid_.words.data() + size_t{3} * visit.begin;
      for (uint32_t e = 0; e < visit.count; e += kLanes) {
        const Mask near = float_from_bits(I32::load(words + e)) >= f32(visit.least);
        const Mask beside = bytes_within(I32::load(words + visit.count + e), visit.box);
        const Mask listed = first_lanes(static_cast<int>(visit.count - e));
        for (uint32_t rest = to_bits(near & beside & listed); rest != 0; rest &= rest - 1) {
          const uint32_t seen = words[2 * visit.count + e + static_cast<uint32_t>(std::countr_zero(rest))];
          if (one_face && seen == last) continue;
          last = seen;
          const LightGrid::Seen& t = grid_.seen[seen];
          const SeenHits hits = meet(t, p.u, p.v, p.least, p.greatest);
          const Mask leaving = from == i32(t.primitive);
          const uint32_t asked = alive_ & (one_face ? ~0u : visit.rays);
          const uint32_t maybe = to_bits(and_not(leaving, hits.maybe)) & asked;
          // What a triangle hides is not listed, but does not stop rays that leave the triangle.
          if ((to_bits(leaving & hits.behind) & asked) != 0) return by_tree();
          if (maybe == 0) continue;
          const uint32_t sure = maybe & to_bits(hits.sure);
          alive_ &= ~sure;
          if (maybe != sure) ask(t.place, maybe & ~sure);
          if (alive_ == 0) return;
          if (tested_ > kMostTested) return by_tree();
        }
        if (!all(near)) break;
      }
    }
  }

  HWY_INLINE void start() {
    if (!started_) packet_.start(at_), packet_.stopper = nullptr;
    started_ = true;
    packet_.alive = alive_ & packet_.p.valid;
  }

  HWY_INLINE void ask(uint32_t place, uint32_t lanes) {
    start();
    ++tested_;
    const uint32_t before = packet_.alive;
    packet_.test(data_.blocks[place / kBvhWidth], 1u << (place % kBvhWidth), lanes);
    alive_ &= ~(before & ~packet_.alive);
  }

  HWY_NOINLINE void by_tree() {
    start();
    const uint32_t before = packet_.alive;
    if (std::popcount(before) <= kFewRays || packet_.p.mixed_axes > 1) packet_.alone({0, before});
    else go_together(packet_, make_beam(packet_.p), data_.nodes.data(), 1);
    alive_ &= ~(before & ~packet_.alive);
  }

  const Bvh::Data& data_;
  const LightGrid& grid_;
  const RayBatch& rays_;
  AnyPacket packet_;
  PlacesSeen places_[kAhead];
  uint32_t used_[kAhead];
  bool by_tree_[kAhead];
  int visits_before_[kAhead + 1], visits_ = 0;
  Visit visit_[kAhead * kLanes];
  int first_ = 0;
  // Of the packet that is looked at.
  int at_ = 0, tested_ = 0;
  bool started_ = false;
  uint32_t alive_ = 0;
};

void to_light_kernel(const Frame& frame, const Bvh::Data& data, const LightGrid& grid, const RayBatch& rays, uint32_t* out) {
  std::fill_n(out, (rays.count + 31) / 32, 0u);
  const Batch batch{frame, rays, false};
  GridPackets packets(data, batch, grid);
  for (int first = 0; first < rays.count; first += kLanes * GridPackets::kAhead) packets.trace(first, out);
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace spanray {
const TraceToLightFn kTraceToLight[kIsaCount] = SPANRAY_KERNEL_TABLE(to_light_kernel);
}  // namespace spanray
#endif
