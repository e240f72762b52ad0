// One ray against the tree: lanes are the eight children of a node or the eight triangles of a leaf. Included once a target.
// Source:   Ize 2013, "Robust BVH Ray Traversal"; Wald, Benthin, Boulos 2008, "Getting Rid of Packets".
// Contract: lanes only cull, and conservatively; hit_triangle() of ray/triangle_test.h decides.
#if defined(SPANRAY_TRAVERSE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_TRAVERSE_INL_H_
#undef SPANRAY_TRAVERSE_INL_H_
#else
#define SPANRAY_TRAVERSE_INL_H_
#endif

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "ray/bvh_data.h"
#include "ray/triangle_test.h"
#include "simd/lanes8-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {

// A ray with what the lanes need of it.
struct LaneRay {
  TraceRay exact;
  uint32_t from;  // the triangle that it leaves, or kNoPrimitive
  float shear_x, shear_y;
  float edge_slope, edge_offset;  // an edge function in lanes is off by at most slope * (sum of |x| + |y|) + offset
  int near_row[3], far_row[3];    // rows of BvhNode::bounds
  HWY_INLINE float near_origin(int k) const { return exact.origin[k]; }
  HWY_INLINE float far_origin(int k) const { return exact.origin[k]; }
  HWY_INLINE float inv_near(int k) const { return exact.inv_near[k]; }
  HWY_INLINE float inv_far(int k) const { return exact.inv_far[k]; }
};

// Which of kLanes8 boxes a ray meets in [0, limit], and where it enters them: the arithmetic of slab(), on the sides that it enters and leaves by.
// ray: origins to meet these from, and reciprocals: near_origin, far_origin, inv_near, inv_far.
struct ChildLanes { Mask8 meets; F8 near; };
template <class Ray> HWY_INLINE ChildLanes box_between(const F8 (&near_side)[3], const F8 (&far_side)[3], const Ray& ray, float limit) {
  F8 near = f8(0.0f), far = f8(limit);
  for (int k = 0; k < 3; ++k) {
    near = cull_max((near_side[k] - f8(ray.near_origin(k))) * f8(ray.inv_near(k)), near);
    far = cull_min((far_side[k] - f8(ray.far_origin(k))) * f8(ray.inv_far(k)), far);
  }
  return {near <= far, near};
}

// Of the children of a node, those from `first` on.
template <class Ray> HWY_INLINE ChildLanes box_children(const BvhNode& node, int first, const Ray& ray, float limit) {
  F8 near_side[3], far_side[3];
  for (int k = 0; k < 3; ++k)
    near_side[k] = F8::load(node.bounds[ray.near_row[k]] + first), far_side[k] = F8::load(node.bounds[ray.far_row[k]] + first);
  return box_between(near_side, far_side, ray, limit);
}

// Where a ray surely passes inside a triangle whose vertices are all in front of it, bounds on t in float order most hits: t is the mean of
// the vertices', weighted by the edge functions. With these off by at most `error` each, the errors of the weights sum up to 6 error / |det|
// at most, and move t by no more than that share of what the vertices' t differ by. Roundings are less than 2^-19 of the greatest t.
// F: lanes; same: a number in all of them. t: of the vertices, from first to last.
template <class F> struct BoundsOnT { F low, high, size; };  // size: |det|
inline constexpr float kLeastSureSize = 0x1p-100f;  // of det: above, it has the precision of normal floats
template <class F, F (*same)(float)>
HWY_INLINE BoundsOnT<F> bounds_on_t(F edge_u, F edge_v, F edge_w, const F (&t)[3], F error, F first, F last, F reach) {
  const F det = edge_u + edge_v + edge_w, one_by_det = same(1.0f) / det;
  const F middle = edge_u * one_by_det * t[0] + edge_v * one_by_det * t[1] + edge_w * one_by_det * t[2];
  const F off = same(6.1f) * error * (last - first) * abs_(one_by_det) + (same(0x1p-18f) * reach + same(0x1p-120f));
  return {middle - off, middle + off, abs_(det)};
}

// Triangles that might be hit at no more than limit: all that hit_triangle() would accept, and few others. Of these, `sure` are those
// that it accepts. Any hit: at less than the limit: the ray passes inside by more than the error of the edge functions, every vertex is in
// front of the origin and nearer than the limit also after rounding (t lies between those of the vertices, whose numbers here are at most
// 10 roundings too small). Closest hit: with low <= t <= high. kBehind, for any hit: also where vertices are behind the origin or
// beyond the limit, by bounds on t, which take a division. With 0 < low the hit is in front by far more than hit_triangle() asks for:
// its errors, of doubles, are less than a millionth of those here.
struct Candidates { uint32_t maybe, sure; };
struct CandidateDistances { alignas(32) float low[kBvhWidth], high[kBvhWidth]; };
template <class Visitor, bool kEarlyOut = true, bool kBehind = false>
HWY_INLINE Candidates candidates(const TriangleBlock& block, const LaneRay& ray, float limit, CandidateDistances& distances) {
  const int kx = ray.exact.kx, ky = ray.exact.ky, kz = ray.exact.kz;
  const F8 ox = f8(ray.exact.origin[kx]), oy = f8(ray.exact.origin[ky]), oz = f8(ray.exact.origin[kz]);
  const F8 shear_x = f8(ray.shear_x), shear_y = f8(ray.shear_y), inv_z = f8(ray.exact.inv_near[kz]);
  Candidates found{0, 0};
  for (int s = 0; s < kBvhWidth; s += kLanes8) {
    F8 x[3], y[3], t[3];
    for (int v = 0; v < 3; ++v) {
      const F8 z = F8::load(block.vertex[v][kz] + s) - oz;
      x[v] = cull_neg_mul_add(shear_x, z, F8::load(block.vertex[v][kx] + s) - ox);
      y[v] = cull_neg_mul_add(shear_y, z, F8::load(block.vertex[v][ky] + s) - oy);
      t[v] = z * inv_z;  // the bits of slab(): the least of the three is where the box begins along kz
    }
    const F8 edge_u = cull_neg_mul_add(x[1], y[2], x[2] * y[1]);
    const F8 edge_v = cull_neg_mul_add(x[2], y[0], x[0] * y[2]);
    const F8 edge_w = cull_neg_mul_add(x[0], y[1], x[1] * y[0]);
    const F8 sum = abs_(x[0]) + abs_(y[0]) + (abs_(x[1]) + abs_(y[1])) + (abs_(x[2]) + abs_(y[2]));
    const F8 error = cull_mul_add(f8(ray.edge_slope), sum, f8(ray.edge_offset));
    const F8 least = cull_min(cull_min(edge_u, edge_v), edge_w), greatest = cull_max(cull_max(edge_u, edge_v), edge_w);
    const F8 first = cull_min(cull_min(t[0], t[1]), t[2]), last = cull_max(cull_max(t[0], t[1]), t[2]);
    const Mask8 miss = ((least < -error) & (greatest > error)) | (first > f8(limit)) | (last < f8(0.0f));
    const uint32_t maybe = ~to_bits(miss) & ((1u << kLanes8) - 1);
    found.maybe |= maybe << s;
    if (!(Visitor::kAny || Visitor::kClosest) || (kEarlyOut && maybe == 0)) continue;
    Mask8 inside = (least > error) | (greatest < -error);
    if constexpr (!kBehind) inside = inside & (first > f8(0.0f));
    if constexpr (kBehind) {
      const BoundsOnT<F8> bounds = bounds_on_t<F8, f8>(edge_u, edge_v, edge_w, t, error, first, last, cull_max(last, -first));
      inside = inside & (bounds.size > f8(kLeastSureSize)) & (bounds.low > f8(0.0f)) & (bounds.high < f8(limit));
      found.sure |= (to_bits(inside) & maybe) << s;
    } else if constexpr (Visitor::kAny) {
      found.sure |= (to_bits(inside & (last * f8(1 + 0x1p-20f) < f8(limit))) & maybe) << s;
    } else {
      const BoundsOnT<F8> bounds = bounds_on_t<F8, f8>(edge_u, edge_v, edge_w, t, error, first, last, last);
      found.sure |= (to_bits(inside & (bounds.size > f8(kLeastSureSize))) & maybe) << s;
      bounds.low.store(distances.low + s), bounds.high.store(distances.high + s);
    }
  }
  return found;
}

inline constexpr uint32_t kNothing = ~0u;  // no child

// What is still to be visited: two arrays, since a pair that is written by halves and read whole would stall. A push may write kBvhWidth
// entries past the last that counts.
struct Stack {
  float near[kBvhStackSize + kBvhWidth];
  uint32_t child[kBvhStackSize + kBvhWidth];
  int top = 0;

  // The children of a node that the ray meets, in no order and without distances: one is returned, the others wait.
  // kNothing if there are none.
  template <class Ray> HWY_INLINE uint32_t push_any(const BvhNode& node, const Ray& ray, float limit) {
    const int bottom = top;
    for (int s = 0; s < kBvhWidth; s += kLanes8)
      top += store_chosen(node.child + s, box_children(node, s, ray, limit).meets, child + top);
    return top > bottom ? child[--top] : kNothing;
  }

  // The same, but the nearest is returned, and the others are popped nearest first.
  template <class Ray> HWY_INLINE uint32_t push_sorted(const BvhNode& node, const Ray& ray, float limit) {
    alignas(32) float entry[kBvhWidth];
    uint32_t bits = 0;
    for (int s = 0; s < kBvhWidth; s += kLanes8) {
      const ChildLanes box = box_children(node, s, ray, limit);
      box.near.store(entry + s);
      bits |= to_bits(box.meets) << s;
    }
    if (bits == 0) return kNothing;
    int nearest = std::countr_zero(bits);
    bits &= bits - 1;
    if (bits == 0) return node.child[nearest];
    const int bottom = top;
    do {
      int c = std::countr_zero(bits);
      bits &= bits - 1;
      const bool swap = entry[c] < entry[nearest];
      const int far = swap ? nearest : c;
      nearest = swap ? c : nearest;
      int at = top++;
      for (; at > bottom && near[at - 1] < entry[far]; --at) near[at] = near[at - 1], child[at] = child[at - 1];
      near[at] = entry[far], child[at] = node.child[far];
    } while (bits != 0);
    return node.child[nearest];
  }
};

HWY_INLINE TriangleView triangle_of(const TriangleBlock& block, int lane) { return {&block.vertex[0][0][lane], 3 * kBvhWidth, kBvhWidth}; }
// place: among the triangles of all blocks.
HWY_INLINE TriangleView triangle_at(const Bvh::Data& data, uint32_t place) {
  return triangle_of(data.blocks[place / kBvhWidth], static_cast<int>(place % kBvhWidth));
}

// Tests triangles that candidates() found; first: the place of the block's first among those of all blocks. True if the visitor wants to end.
template <class Visitor>
HWY_INLINE bool visit_candidates(const TriangleBlock& block, uint32_t first, const Candidates& found, const CandidateDistances& t_of, const LaneRay& ray,
                                 Visitor& visitor) {
  uint32_t rest = found.maybe;
  if constexpr (Visitor::kAny) {
    rest &= ~words_equal(block.primitive, ray.from);
    const auto any_of = [&](uint32_t sure) HWY_ATTR {
      for (uint32_t bits = sure & rest; bits != 0; bits &= bits - 1)
        if (visitor.certain(block.primitive[std::countr_zero(bits)])) return true;
      rest &= ~sure;
      return false;
    };
    if (any_of(found.sure)) return true;
    if (rest == 0) return false;
    CandidateDistances unused;
    if (any_of(candidates<Visitor, false, true>(block, ray, visitor.limit, unused).sure)) return true;
  }
  for (uint32_t bits = rest; bits != 0; bits &= bits - 1) {
    const int lane = std::countr_zero(bits);
    if (block.primitive[lane] == ray.from) continue;
    [[maybe_unused]] const uint32_t place = first + static_cast<uint32_t>(lane);
    if constexpr (Visitor::kClosest) {
      if ((found.sure >> lane & 1u) != 0) {
        if (t_of.low[lane] > visitor.limit) continue;
        if (t_of.high[lane] < visitor.low) {
          visitor.sure(t_of.low[lane], t_of.high[lane], block.primitive[lane], place);
          continue;
        }
      }
    }
    const TriangleView triangle = triangle_of(block, lane);
    double t;
    if (!hit_triangle(ray.exact, triangle, t)) continue;
    if constexpr (Visitor::kClosest) visitor.hit(t, block.primitive[lane], place);
    else if (visitor.takes(triangle) && visitor.hit(t, block.primitive[lane])) return true;
  }
  return false;
}

// Tests the triangles of a leaf; true if the visitor wants to end.
template <class Visitor>
HWY_INLINE bool visit_leaf(const Bvh::Data& data, uint32_t child, const LaneRay& ray, Visitor& visitor) {
  const TriangleBlock& block = data.blocks[leaf_block(child)];
  CandidateDistances t_of;
  Candidates found = candidates<Visitor>(block, ray, visitor.limit, t_of);
  const uint32_t used = leaf_lanes(child);
  found.maybe &= used, found.sure &= used;
  return visit_candidates(block, leaf_block(child) * kBvhWidth, found, t_of, ray, visitor);
}

// Goes down from `start` to the leaves that the ray may meet at no more than visitor.limit: near first, but for kAny in no order. visit(child) is
// called for each; it returns true to end, and so does this.
template <class Visitor, class Ray, class Visit>
HWY_INLINE bool descend_to_leaves(const AlignedBuffer<BvhNode>& nodes, uint32_t start, const Ray& ray, const Visitor& visitor, const Visit& visit) {
  Stack stack;
  uint32_t child = start;
  for (;;) {
    if ((child & kLeafBit) == 0) {
      const BvhNode& node = nodes[child];
      child = Visitor::kAny ? stack.push_any(node, ray, visitor.limit) : stack.push_sorted(node, ray, visitor.limit);
      if (child != kNothing) continue;
    } else if (visit(child)) {
      return true;
    }
    do {
      if (stack.top == 0) return false;
      --stack.top;
    } while (!Visitor::kAny && stack.near[stack.top] > visitor.limit);
    child = stack.child[stack.top];
  }
}

// Visits what the ray may hit in the subtree or leaf `start`, entered at `near`. visitor.hit(t, primitive) is called for every hit found,
// visitor.certain(primitive) where kAny needs no t; both return true to end.
template <class Visitor>
HWY_INLINE void traverse(const Bvh::Data& data, uint32_t start, float near, const LaneRay& ray, Visitor& visitor) {
  if (!Visitor::kAny && near > visitor.limit) return;
  descend_to_leaves(data.nodes, start, ray, visitor, [&](uint32_t leaf) HWY_ATTR { return visit_leaf(data, leaf, ray, visitor); });
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_TRAVERSE_INL_H_
