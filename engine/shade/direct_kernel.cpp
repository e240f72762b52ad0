// Hits of primary rays -> radiance, kLanes at a time from plane to light.
#include <cstddef>
#include <limits>

#include "shade/direct.h"
#include "shade/light_kernel.h"
#include "shade/surface_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shade/direct_kernel.cpp"
#include "hwy/foreach_target.h"
#include "shade/hit_point-inl.h"
#include "shade/material-inl.h"
#include "shade/surface_light-inl.h"

HWY_BEFORE_NAMESPACE();
namespace spanray {
namespace HWY_NAMESPACE {
using namespace surface_lanes;
namespace {

using Vec = light_lanes::V3;
using light_lanes::Incidence;
using light_lanes::LightLanes;
using light_lanes::Met;
using light_lanes::Site;

constexpr int kTogether = 4;  // vectors that go from stage to stage together: their surfaces stay in the first-level cache

// A vector of hits, as far as it has come. Only what later stages read is stored.
struct Shaded {
  Mask valid;
  V3f position, geometric, view, normal;
  F32 t;
  I32 material;
  uint32_t first_material;  // word of SceneData::materials where the first lane's begins
  bool one_material;        // that of all lanes
  UvLanes uv;
  PlainSample sample;
  MaterialLanes m;
  Vec radiance;

  HWY_INLINE void take(const Frame& frame, const PointLanes& point) {
    position = point.position, geometric = point.geometric, material = point.material;
    const int32_t first = first_lane(material);
    first_material = static_cast<uint32_t>(first * kMaterialStride), one_material = all(material == i32(first));
    if (frame.plan.normals) normal = point.normal, view = point.view;
    if (frame.plan.depths) t = point.t;
    if (point.mapped) uv = point.uv;
  }
};

HWY_INLINE Materials materials_of(const Frame& frame, PlainTextures& plain, Shaded& s) {
  return {frame, s.valid, {s.material * i32(kMaterialStride), s.first_material, s.one_material}, &plain, &s.sample};
}

// What maps do: apart, so that vectors without any stay short.
HWY_NOINLINE void apply_bump(const Frame& frame, PlainTextures& plain, Shaded& s) {
  s.normal = bumped_normal(materials_of(frame, plain, s), s.uv, s.normal);
}
HWY_NOINLINE void apply_textures(const Frame& frame, PlainTextures& plain, Shaded& s) {
  apply_maps(materials_of(frame, plain, s), s.uv, s.m, false);
}

// Where the texture of most maps is read, before any is.
HWY_INLINE void find_sample(const Frame& frame, PlainTextures& plain, Shaded& s) {
  s.sample.use = -1;
  find_shared_sample(materials_of(frame, plain, s), s.uv, kDiffuseSlot);
}

HWY_INLINE void add_material(const Frame& frame, PlainTextures& plain, Shaded& s) {
  if (frame.plan.bump) apply_bump(frame, plain, s);
  if (frame.plan.normals) s.normal = clamp_to_horizon(s.normal, s.geometric);
  s.m = constants_of(materials_of(frame, plain, s));
  if (frame.plan.textures) apply_textures(frame, plain, s);
  s.radiance = light_lanes::ambient_radiance(frame, as_vec3(s.m.ambient), as_vec3(s.m.emission));
}

// Light on vectors that go together, stage by stage: what waits for itself, roots, quotients and powers, then overlaps.
template <class Kind> struct OneLight {
  const Frame& frame;
  const Light& light;
  const LightLanes lanes;

  HWY_INLINE Site site_of(const Shaded& s) const { return {as_vec3(s.position), as_vec3(s.normal), as_vec3(s.view)}; }

  HWY_INLINE Mask faced(const Shaded& s, const Incidence& incidence) const {
    return s.valid & (formula::dot(as_vec3(s.geometric), incidence.direction) > F32::zero());
  }

  HWY_INLINE bool meet(const Shaded& s, Met& met) const {
    const Site site = site_of(s);
    const Incidence incidence = Kind::incidence(lanes, site.position);
    const auto highlight = [&]() HWY_ATTR { return max_(max_(s.m.specular.x, s.m.specular.y), s.m.specular.z); };
    return light_lanes::meet_light(frame, site, incidence, faced(s, incidence), highlight, met);
  }

  HWY_INLINE void reflect(Shaded& s, const Met& met) const {
    const Site site = site_of(s);
    const Vec direction = Kind::incidence(lanes, site.position).direction;
    const auto models = light_lanes::models_of(*frame.scene, select(met.active, s.material, I32::zero()));
    add(s, met.active, light_lanes::reflect_light(frame, site, direction, met, models, s.m.shininess), met.specular);
  }

  HWY_INLINE void add(Shaded& s, Mask active, const light_lanes::Reflected& factor, bool specular) const {
    s.radiance = light_lanes::plus_light(s.radiance, active, light, factor, as_vec3(s.m.diffuse), as_vec3(s.m.specular), specular);
  }

  // carried: diffuse and specular factors of the first vector; those of the next stand `stride` floats behind.
  void add_carried(Shaded* s, int vectors, const float* carried, int stride) const {
    const bool specular = frame.plan.specular;
    for (int k = 0; k < vectors; ++k) {
      const float* const from = carried + k * stride;
      const Mask active = faced(s[k], Kind::incidence(lanes, as_vec3(s[k].position)));
      if (any(active)) add(s[k], active, {F32::load(from), specular ? F32::load(from + kLanes) : F32::zero()}, specular);
    }
  }

  void add_all(Shaded* s, int vectors) const {
    Met met[kTogether];
    int n = 0;
    for (int k = 0; k < vectors; ++k) {
      met[n].at = k;
      n += meet(s[k], met[n]);
    }
    for (int k = 0; k < n; ++k) reflect(s[met[k].at], met[k]);
  }
};

// A batch, a few vectors at a time.
class DirectShader {
 public:
  DirectShader(const Frame& frame, const HitBatch& hits, AlignedBuffer<float>& memory, float* const radiance[3], float* t)
      : frame_(frame), hits_(hits), radiance_(radiance), t_(t),
        carried_lights_(frame.settings.shading == Shading::kPhong ? 0 : static_cast<int>(frame.scene->lights.size())),
        stride_(2 * kLanes * carried_lights_), planes_(memory, light_fields_of(frame, carried_lights_), kTogether * stride_) {}

  DirectCounts shade() {
    static_assert(kPlaneHits % (kTogether * kLanes) == 0);
    for (int from = 0; from < hits_.count; from += kTogether * kLanes) {
      if (from % kPlaneHits == 0) set_up(from);
      find_points(from);
      if (frame_.plan.textures)
        for (int k = 0; k < vectors_; ++k) find_sample(frame_, textures_, shaded_[k]);
      for (int k = 0; k < vectors_; ++k) add_material(frame_, textures_, shaded_[k]);
      add_lights();
      for (int k = 0; k < vectors_; ++k) store(at_[k], shaded_[k]);
    }
    return counts_;
  }

 private:
  void set_up(int from) {
    set_up_block(frame_, hits_, from, planes_);
    const int vectors = (planes_.planes + kLanes - 1) / kLanes;
    counts_.plane_lanes.add({static_cast<uint64_t>(vectors * kLanes), static_cast<uint64_t>(planes_.planes)});
  }

  // The points of the next vectors that hit something; the others are done.
  HWY_INLINE void find_points(int from) {
    const int end = hits_.count < from + kTogether * kLanes ? hits_.count : from + kTogether * kLanes;
    vectors_ = 0;
    for (int i = from; i < end; i += kLanes) {
      Shaded& s = shaded_[vectors_];
      s.valid = triangles_at(*frame_.scene, hits_, i);
      const int found = count(s.valid);
      if (found == 0) {
        s.radiance = {F32::zero(), F32::zero(), F32::zero()}, s.t = F32::zero();
        store(i, s);
        continue;
      }
      float* const carried = planes_.spare() + vectors_ * stride_;
      const auto carry = [&](int light, int factor) HWY_ATTR { return carried + (2 * light + factor) * kLanes; };
      with_planes(planes_, i % kPlaneHits, [&](const auto& of_hits) HWY_ATTR {
        PointLanes point;
        resolve_primary(frame_, hits_, i, s.valid, of_hits, carried_lights_, carry, point);
        s.take(frame_, point);
      });
      at_[vectors_++] = i;
      counts_.surface_lanes.add({static_cast<uint64_t>(kLanes), static_cast<uint64_t>(found)});
    }
  }

  HWY_INLINE void add_lights() {
    for (int i = 0; i < static_cast<int>(frame_.scene->lights.size()); ++i) {
      const Light& light = light_of(frame_, i);
      light_lanes::with_kind(light, [&](auto kind) HWY_ATTR {
        const OneLight<decltype(kind)> one{frame_, light, light_lanes::broadcast_light(light)};
        if (carried_lights_ > 0) one.add_carried(shaded_, vectors_, planes_.spare() + 2 * i * kLanes, stride_);
        else one.add_all(shaded_, vectors_);
      });
    }
  }

  HWY_INLINE void store(int at, const Shaded& s) const {
    const float* const background = frame_.scene->background;
    select(s.valid, s.radiance.x, f32(background[0])).store(radiance_[0] + at);
    select(s.valid, s.radiance.y, f32(background[1])).store(radiance_[1] + at);
    select(s.valid, s.radiance.z, f32(background[2])).store(radiance_[2] + at);
    if (frame_.plan.depths) select(s.valid, s.t, f32(std::numeric_limits<float>::infinity())).store(t_ + at);
  }

  const Frame& frame_;
  const HitBatch& hits_;
  float* const* const radiance_;
  float* const t_;
  const int carried_lights_;  // flat and Gouraud: what triangles carry of them stands behind the planes,
  const int stride_;          // this far from vector to vector
  PlaneBlock planes_;
  DirectCounts counts_;
  PlainTextures textures_;
  Shaded shaded_[kTogether];
  int at_[kTogether], vectors_ = 0;
};

}  // namespace

// Contract: bits of resolve() and the kernels of light: the same functions of the same values.
DirectCounts shade_direct(const Frame& frame, const HitBatch& hits, AlignedBuffer<float>& planes, float* const radiance[3], float* t) {
  return DirectShader(frame, hits, planes, radiance, t).shade();
}

}  // namespace HWY_NAMESPACE
}  // namespace spanray
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace spanray {

const ShadeDirectFn kShadeDirect[kIsaCount] = SPANRAY_KERNEL_TABLE(shade_direct);

bool can_shade_direct(const Frame& frame) {
  const PlanFlags& plan = frame.plan;
  return !plan.shadow_rays && !plan.bounces && !plan.lifted_rays && !plan.weights && !plan.surfaces &&
         !frame.scene->has_exact() && !frame.scene->triangles.empty() &&
         (frame.settings.shading == Shading::kPhong || triangles_carry_light(frame));
}

DirectCounts shade_direct(const Frame& frame, const HitBatch& hits, AlignedBuffer<float>& planes, float* const radiance[3], float* t) {
  return kShadeDirect[isa_index(frame.isa)](frame, hits, planes, radiance, t);
}

}  // namespace spanray
#endif
