// What a primary ray sees of a triangle, as planes over the picture: attributes times 1 / depth are linear in the pixel. Planes are
// set up in double, once a triangle and cell of the picture, and kept in float, anchored near the pixels where they are used.
// Include inside a *_kernel.cpp (simd/dispatch.h), after the project headers.
#if defined(SPANRAY_PLANE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SPANRAY_PLANE_INL_H_
#undef SPANRAY_PLANE_INL_H_
#else
#define SPANRAY_PLANE_INL_H_
#endif

#include "shade/triangle_light-inl.h"
#include "shade/surface_group-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {
namespace surface_lanes {

// At pixel (x, y), (dx, dy) from the anchor, s = 1 + dx step_x + dy step_y is 1 / depth relative to the anchor's, and an attribute is
// its value at the anchor plus (dx per_x + dy per_y) / s. A vector is stored as X, Y, Z; an attribute as its value, per_x, per_y.
enum PlaneFloat : int {
  kPlaneAnchor = 0,                      // bits of the pixel: x, y
  kPlanePosition = 2, kPlaneNormal = 11,  // nine each
  kPlaneWeight = 20,                     // of corners 1 and 2: value, per_x, per_y
  kPlaneView = 26,                       // toward the eye, of depth 1
  kPlaneUv = 29,                         // fraction of u, v; per_x of both; per_y of both; whole part of u, v: eight
  kPlaneGeometric = 37,                  // unit, toward the eye; zero for a triangle without area
  kPlaneTangentU = 40, kPlaneTangentV = 43,
  kPlaneError = 46,                      // what the size of the triangle adds to position_error, and what each pixel from the anchor
  kPlaneMaterial = 49,                   // bits of the index
  kPlaneSlimness = 50,                   // the inverse of the triangle's smallest height
  kPlaneInside = 51,                     // not 0: all pixels of the cell lie inside the triangle, clear of its edges (cell_inside)
  kPlaneMapped = 52,                     // not 0: has texture coordinates
  kPlaneFloatCount = 53,
  kPlaneLight = kPlaneFloatCount  // of each light diffuse and specular, of the face, or (Gouraud) diffuse of the three corners, then specular
};
enum PlaneReal : int { kPlaneStepX = 0, kPlaneStepY = 1, kPlaneDepth = 2, kPlaneRealCount = 3 };

// position_error of a position that planes give, a + (dx per_x + dy per_y) / s: kPositionRounding |position| + kReachRounding (|dx
// per_x| + |dy per_y|) / s + what the size of the triangle adds. In 2^-24: 1 for a, 1 for each step, 2 for their products and sum, 1
// for the product with 1 / s, 1 for the last sum, where |a| <= |position| + reach; and 2 for s and 1 / s, which slide the position
// along the triangle.
inline constexpr float kPositionRounding = 0x1.01p-23f, kReachRounding = 0x1.c1p-22f;

inline constexpr int kPlaneHits = 1024;  // those of a chunk: the more, the fewer lanes are idle when planes are set up
inline constexpr int kPlaneLine = 16;  // planes side by side, whatever the instruction set

// Planes that kPlaneHits hits see: field by field in lines of kPlaneLine planes.
struct PlaneBlock {
  alignas(64) double real[kPlaneHits * kPlaneRealCount];
  alignas(64) uint32_t primitive[kPlaneHits + kPlaneLine];
  alignas(64) uint32_t cell[kPlaneHits + kPlaneLine];
  alignas(64) uint32_t plane_of_hit[kPlaneHits];
  float* single;
  int fields;  // kPlaneFloatCount and those of light
  int planes = 0;

  // spare: floats behind the planes, for the caller.
  PlaneBlock(AlignedBuffer<float>& memory, int light_fields, int spare = 0) : fields(kPlaneFloatCount + light_fields) {
    memory.resize(static_cast<size_t>(kPlaneHits) * static_cast<size_t>(fields) + static_cast<size_t>(spare));
    single = memory.data();
  }
  float* spare() { return single + static_cast<size_t>(kPlaneHits) * static_cast<size_t>(fields); }

  double* reals(int plane) { return real + plane / kPlaneLine * (kPlaneLine * kPlaneRealCount) + plane % kPlaneLine; }
  float* singles(int plane) { return single + plane / kPlaneLine * (kPlaneLine * fields) + plane % kPlaneLine; }
};

HWY_INLINE void store_plane(float* out, int field, F32 value) { value.store(out + field * kPlaneLine); }
HWY_INLINE void store_plane(float* out, int field, const V3f& v) {
  store_plane(out, field, v.x), store_plane(out, field + 1, v.y), store_plane(out, field + 2, v.z);
}

// An edge function along the primary rays: at pixel (0, 0), per pixel in x, per pixel in y.
HWY_INLINE V3d along_rays(const PrimaryRays& p, const V3d& c) {
  return {dot(broadcast(p.corner), c), dot(broadcast(p.step_x), c), dot(broadcast(p.step_y), c)};
}

struct AnchorLanes {
  I32 x, y;
  Mask covers;  // the triangle's box in the picture covers the cell
};

// The corner nearest to the eye, on the triangle's plane, of the part of the cell that the triangle's box in the picture meets; of the
// whole cell if a vertex is not in front of the eye. There s is largest, so it is at most 1 for the hits, and no digits are lost.
// Any pixel near the hits would do: only which is taken must depend on nothing but triangle and cell.
HWY_INLINE AnchorLanes choose_anchor(const PrimaryRays& p, const TriangleLanes& t, I32 cell, Mask nearer_x, Mask nearer_y) {
  const V3f forward = to_f32(broadcast(p.forward)), row_x = to_f32(broadcast(p.pixel_row_x)), row_y = to_f32(broadcast(p.pixel_row_y));
  const F32 far = f32(0x1p20f);
  F32 low_x = far, low_y = far, high_x = -far, high_y = -far;
  for (const V3d* v : {&t.v0, &t.v1, &t.v2}) {
    const V3f from_eye = to_f32(*v - broadcast(p.eye));
    const F32 depth = dot(from_eye, forward);
    const Mask front = depth > F32::zero();
    const F32 inverse = f32(1.0f) / select(front, depth, f32(1.0f));
    const F32 x = dot(from_eye, row_x) * inverse, y = dot(from_eye, row_y) * inverse;
    low_x = min_(low_x, select(front, x, -far)), high_x = max_(high_x, select(front, x, far));
    low_y = min_(low_y, select(front, y, -far)), high_y = max_(high_y, select(front, y, far));
  }
  Mask covers = first_lanes(kLanes);
  const auto corner = [&](F32 low, F32 high, I32 first, Mask nearer) HWY_ATTR {
    const I32 last = first + i32(kCellSize);
    const I32 a = floor_i32_small(clamp_(low, -far, far)), b = floor_i32_small(clamp_(high, -far, far)) + i32(1);
    covers = and_not(a > first, covers) & !(last > b);
    const I32 inside = select(nearer, b, a);
    return min_(max_(inside, first), last);
  };
  const I32 x = corner(low_x, high_x, cell & i32(0xffff), nearer_x), y = corner(low_y, high_y, shift_right_logical<16>(cell), nearer_y);
  return {x, y, covers};
}

// value + per_x dx + per_y dy of what the weights interpolate, from the same of the weights.
struct WeightPlanes {
  F64 b1, b2, b1_x, b2_x, b1_y, b2_y;
  HWY_INLINE F64 at_anchor(F64 v0, F64 d1, F64 d2) const { return v0 + b1 * d1 + b2 * d2; }
  HWY_INLINE F64 per_x(F64 d1, F64 d2) const { return b1_x * d1 + b2_x * d2; }
  HWY_INLINE F64 per_y(F64 d1, F64 d2) const { return b1_y * d1 + b2_y * d2; }
};

// Where each place of the whole cell looks at the triangle, farther from its edges than any margin of primary_point(), which then need
// not be computed: that decides nothing but time. From the anchor, an edge function times s is linear: least at a corner of the cell.
// error, reach: kPlaneError of these planes.
// Contract: conservative. No weight errs by more than kRoom / 4 where s > kLeastStep: its terms are at most 1 / kLeastStep.
HWY_INLINE Mask cell_inside(const WeightPlanes& w, const TriangleLanes& t, F64 step_x, F64 step_y, const AnchorLanes& anchor, I32 cell,
                            F32 error, F32 reach, F32 slimness) {
  constexpr double kHalf = kCellSize / 2.0, kLeastStep = 0.25, kRoom = 0x1p-16;
  const F64 x = to_f64((cell & i32(0xffff)) - anchor.x) + f64(kHalf), y = to_f64(shift_right_logical<16>(cell) - anchor.y) + f64(kHalf);
  const auto least = [&](F64 at_anchor, F64 per_x, F64 per_y) HWY_ATTR {
    return at_anchor + x * per_x + y * per_y - f64(kHalf) * (abs_(per_x) + abs_(per_y));
  };
  const F32 size = max_(max_abs(to_f32(t.v0)), max_(max_abs(to_f32(t.v1)), max_abs(to_f32(t.v2))));
  const F32 most_error = mul_add(size + size, f32(kPositionRounding), reach * f32(static_cast<float>(kCellSize / kLeastStep))) + error;
  const F64 margin = to_f64(most_error * slimness) * f64(2.0) + f64(kRoom);  // more than the margin of any pixel
  const auto clear = [&](F64 b, F64 per_x, F64 per_y) HWY_ATTR {
    const F64 above = b - margin;
    return least(above, per_x + above * step_x, per_y + above * step_y) > f64(0.0);
  };
  return (least(f64(1.0), step_x, step_y) > f64(kLeastStep)) & clear(w.b1, w.b1_x, w.b1_y) & clear(w.b2, w.b2_x, w.b2_y) &
         clear(f64(1.0) - w.b1 - w.b2, -(w.b1_x + w.b2_x), -(w.b1_y + w.b2_y)) & (most_error < f32(0x1p99f));
}

HWY_INLINE void store_attribute(float* out, int field, const WeightPlanes& w, const V3d& v0, const V3d& d1, const V3d& d2) {
  const auto component = [&](int k, F64 a, F64 b, F64 c) HWY_ATTR {
    store_plane(out, field + k, to_f32(w.at_anchor(a, b, c)));
    store_plane(out, field + 3 + k, to_f32(w.per_x(b, c)));
    store_plane(out, field + 6 + k, to_f32(w.per_y(b, c)));
  };
  component(0, v0.x, d1.x, d2.x), component(1, v0.y, d1.y, d2.y), component(2, v0.z, d1.z, d2.z);
}

// u and v: a whole part, which float holds, and what is left of it, so that repeated textures keep their digits.
HWY_INLINE void store_uv(float* out, const WeightPlanes& w, const CornerUv& c) {
  const F64 u = w.at_anchor(c.u0, c.du1, c.du2), v = w.at_anchor(c.v0, c.dv1, c.dv2);
  const SplitLanes whole_u = split(u), whole_v = split(v);
  store_plane(out, kPlaneUv, whole_u.rest), store_plane(out, kPlaneUv + 1, whole_v.rest);
  store_plane(out, kPlaneUv + 2, to_f32(w.per_x(c.du1, c.du2))), store_plane(out, kPlaneUv + 3, to_f32(w.per_x(c.dv1, c.dv2)));
  store_plane(out, kPlaneUv + 4, to_f32(w.per_y(c.du1, c.du2))), store_plane(out, kPlaneUv + 5, to_f32(w.per_y(c.dv1, c.dv2)));
  store_plane(out, kPlaneUv + 6, whole_u.whole), store_plane(out, kPlaneUv + 7, whole_v.whole);
}

HWY_INLINE int light_fields_of(const Frame& frame, int lights) { return (frame.settings.shading == Shading::kGouraud ? 6 : 2) * lights; }

HWY_INLINE light_lanes::V3 as_vec3(const V3f& v) { return {v.x, v.y, v.z}; }

// All lights at the corners of triangles, on the side that the eye sees.
HWY_INLINE void store_corner_light(const Frame& frame, float* out, const TriangleLanes& t, const V3f& geometric) {
  const SceneData& scene = *frame.scene;
  const float* vertices = reinterpret_cast<const float*>(scene.vertices.data());
  const light_lanes::CornerMaterial material = light_lanes::corner_material(scene, t.bits & i32(kTriangleMaterialMask));
  const light_lanes::Viewer eye = light_lanes::eye_of(frame);
  const V3d* const position[3] = {&t.v0, &t.v1, &t.v2};
  light_lanes::Corner corner[3];
  for (int j = 0; j < 3; ++j) {
    corner[j].position = as_vec3(to_f32(*position[j]));
    corner[j].normal = {t.vertex[j].real(vertices, 3), t.vertex[j].real(vertices, 4), t.vertex[j].real(vertices, 5)};
    corner[j].view = light_lanes::view_from(eye, corner[j].position);
  }
  const Mask front = light_lanes::normals_in_front(corner, as_vec3(geometric)), all = first_lanes(kLanes);
  int field = kPlaneLight;
  for (int i = 0; i < static_cast<int>(scene.lights.size()); ++i, field += 6)
    light_lanes::with_kind(light_of(frame, i), [&](auto kind) HWY_ATTR {
      const auto c = light_lanes::light_corners<decltype(kind)>(frame, light_lanes::broadcast_light(light_of(frame, i)), corner, material, front, all);
      for (int j = 0; j < 3; ++j) store_plane(out, field + j, c.at[j].diffuse), store_plane(out, field + 3 + j, c.at[j].specular);
    });
}

// All lights on the faces of triangles.
HWY_INLINE void store_face_light(const Frame& frame, float* out, const TriangleLanes& t, const V3f& geometric) {
  const SceneData& scene = *frame.scene;
  const light_lanes::CornerMaterial material = light_lanes::corner_material(scene, t.bits & i32(kTriangleMaterialMask));
  const light_lanes::V3 corner[3] = {as_vec3(to_f32(t.v0)), as_vec3(to_f32(t.v1)), as_vec3(to_f32(t.v2))};
  const light_lanes::Site site = light_lanes::face_site(corner, as_vec3(geometric), light_lanes::eye_of(frame));
  int field = kPlaneLight;
  for (int i = 0; i < static_cast<int>(scene.lights.size()); ++i, field += 2)
    light_lanes::with_kind(light_of(frame, i), [&](auto kind) HWY_ATTR {
      const auto r = light_lanes::light_face<decltype(kind)>(frame, light_lanes::broadcast_light(light_of(frame, i)), site, material);
      store_plane(out, field, r.diffuse), store_plane(out, field + 1, r.specular);
    });
}

// What textures are read by, where some triangle has any. flags: those of the materials.
HWY_INLINE void store_textures(const Frame& frame, float* out, I32 flags, const TriangleLanes& t, const WeightPlanes& w, const V3d& side1,
                               const V3d& side2, const V3d& normal) {
  const F32 zero = F32::zero();
  const Mask mapped = (flags & i32(int32_t{kMaterialMapped})) != I32::zero();
  store_plane(out, kPlaneMapped, select(mapped, f32(1.0f), zero));
  UvTangents along{{zero, zero, zero}, {zero, zero, zero}};
  if (any(mapped)) {
    const CornerUv c = corner_uv(*frame.scene, t);
    store_uv(out, w, c);
    if (frame.plan.bump && any_flag(flags, kMaterialBumped)) along = uv_tangents(c, side1, side2, normal);
  } else {  // vectors with mapped lanes read these, too
    for (int field = kPlaneUv; field < kPlaneGeometric; ++field) store_plane(out, field, zero);
  }
  if (frame.plan.bump) store_plane(out, kPlaneTangentU, along.u), store_plane(out, kPlaneTangentV, along.v);
}

// kLanes planes from entry `at` on.
// Source:   Olano and Greer 1997 (resolve-inl.h): the edge functions e of a primary ray are linear in the pixel. With s = sum(e) /
//           sum(e at the anchor), b(pixel) - b(anchor) = (dx (e_x / sum - b s_x) + dy (e_y / sum - b s_y)) / s.
[[maybe_unused]] static void set_up_planes(const Frame& frame, PlaneBlock& block, int at) {
  const SceneData& scene = *frame.scene;
  const PrimaryRays& p = frame.primary;
  const HitLanes hits{nullptr, i32(0), i32(0), I32::load(block.primitive + at), first_lanes(kLanes), false, block.primitive[at]};
  const TriangleLanes t = load_triangles(scene, hits);
  const V3d eye = broadcast(p.eye), forward = broadcast(p.forward);
  const V3d from_eye = t.v0 - eye, side1 = t.v1 - t.v0, side2 = t.v2 - t.v0, normal = cross(side1, side2);
  const V3d sum = along_rays(p, normal), edge1 = along_rays(p, cross(t.v2 - eye, -side2)), edge2 = along_rays(p, cross(from_eye, side1));
  // sum / from_eye . normal is 1 / depth.
  const F64 zero = f64(0.0);
  const Mask turned = dot(from_eye, normal) < zero;
  const auto nearer = [&](F64 step) HWY_ATTR { return and_not(turned, step > zero) | (turned & (step < zero)); };
  const AnchorLanes anchor = choose_anchor(p, t, I32::load(block.cell + at), nearer(sum.y), nearer(sum.z));
  const F64 x = to_f64(anchor.x), y = to_f64(anchor.y);
  const auto at_anchor = [&](const V3d& e) HWY_ATTR { return e.x + e.y * x + e.z * y; };
  const F64 inverse = f64(1.0) / at_anchor(sum), step_x = sum.y * inverse, step_y = sum.z * inverse;  // not finite: not good later
  WeightPlanes w;
  w.b1 = at_anchor(edge1) * inverse, w.b2 = at_anchor(edge2) * inverse;
  w.b1_x = edge1.y * inverse - w.b1 * step_x, w.b2_x = edge2.y * inverse - w.b2 * step_x;
  w.b1_y = edge1.z * inverse - w.b1 * step_y, w.b2_y = edge2.z * inverse - w.b2 * step_y;

  double* const real = block.reals(at);
  float* const out = block.singles(at);
  step_x.store(real + kPlaneStepX * kPlaneLine), step_y.store(real + kPlaneStepY * kPlaneLine);
  w.at_anchor(dot(from_eye, forward), dot(side1, forward), dot(side2, forward)).store(real + kPlaneDepth * kPlaneLine);
  store_plane(out, kPlaneAnchor, float_from_bits(anchor.x)), store_plane(out, kPlaneAnchor + 1, float_from_bits(anchor.y));
  int field = kPlaneWeight;
  for (const F64* b : {&w.b1, &w.b2, &w.b1_x, &w.b2_x, &w.b1_y, &w.b2_y}) store_plane(out, field++, to_f32(*b));
  store_attribute(out, kPlanePosition, w, t.v0, side1, side2);
  if (frame.plan.views)
    store_plane(out, kPlaneView, to_f32(-(broadcast(p.corner) + broadcast(p.step_x) * x + broadcast(p.step_y) * y)));
  const I32 material = t.bits & i32(kTriangleMaterialMask);
  if (reads_textures(frame)) store_textures(frame, out, flags_of_materials(frame, material), t, w, side1, side2, normal);
  const V3f geometric = geometric_normal(t, normal, from_eye);
  store_plane(out, kPlaneGeometric, geometric);
  if (block.fields > kPlaneFloatCount) {
    if (frame.settings.shading == Shading::kGouraud) store_corner_light(frame, out, t, geometric);
    else store_face_light(frame, out, t, geometric);
  }
  if (frame.plan.normals && frame.settings.shading != Shading::kFlat) {
    const CornerNormals n = corner_normals(scene, t, geometric);
    store_attribute(out, kPlaneNormal, w, to_f64(n.n0), to_f64(n.d1), to_f64(n.d2));
  }
  const auto reach = [&](F64 b1, F64 b2) HWY_ATTR { return max_abs(to_f32(side1 * b1 + side2 * b2)) * f32(kReachRounding); };
  const V3f error{size_error(t, from_eye, side1, side2), reach(w.b1_x, w.b2_x), reach(w.b1_y, w.b2_y)};
  store_plane(out, kPlaneError, error);
  const V3d side3 = side2 - side1;
  const F64 longest = max_(dot(side3, side3), max_(dot(side1, side1), dot(side2, side2)));
  const F32 slimness = to_f32(sqrt_(longest / dot(normal, normal)));  // without area: not finite, never good
  store_plane(out, kPlaneSlimness, slimness);
  F32 inside = F32::zero();
  if (any(anchor.covers)) {
    const F32 reach_both = error.y + error.z;
    const Mask whole = anchor.covers & cell_inside(w, t, step_x, step_y, anchor, I32::load(block.cell + at), error.x, reach_both, slimness);
    inside = select(whole & (dot(geometric, geometric) > F32::zero()), f32(1.0f), inside);
  }
  store_plane(out, kPlaneInside, inside);
  store_plane(out, kPlaneMaterial, float_from_bits(material));
}

}  // namespace surface_lanes
// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#endif  // SPANRAY_PLANE_INL_H_
