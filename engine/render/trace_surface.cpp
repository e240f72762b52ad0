#include "render/trace_surface.h"

#include "catalog/scalar.h"
#include "render/lifted_rays.h"

namespace spanray {
namespace {

namespace formula {
using namespace scalar;
#include "catalog/vocabulary.inl"
#include "catalog_lights.inc"
}  // namespace formula

void copy3(float* const from[3], int i, float (&to)[3]) {
  for (int c = 0; c < 3; ++c) to[c] = from[c][i];
}

// The light alone, its shadow ray, its bit, and the sum so far with it.
LightTrace trace_light(const Frame& frame, const Bvh& opaque, const HitBatch& hits, const SurfaceBatch& s, int index,
                       Radiance& sum) {
  LightTrace trace;
  trace.light = index;
  const Light& l = light_of(frame, index);
  const auto vec = [](const float (&v)[3]) { return formula::Vec3<float>{v[0], v[1], v[2]}; };
  const formula::LightLanes<float> lanes = {vec(l.position), vec(l.direction), vec(l.attenuation)};
  const formula::Vec3<float> at = {s.position[0][0], s.position[1][0], s.position[2][0]};
  const auto incidence = l.kind == static_cast<int32_t>(LightKind::kPoint) ? formula::lights::point::incidence(lanes, at)
                                                                          : formula::lights::directional::incidence(lanes, at);
  trace.to_light[0] = incidence.direction.x, trace.to_light[1] = incidence.direction.y, trace.to_light[2] = incidence.direction.z;
  const formula::Vec3<float> n = {s.geometric_normal[0][0], s.geometric_normal[1][0], s.geometric_normal[2][0]};
  trace.in_front = formula::dot(n, incidence.direction) > 0;
  for (int c = 0; c < 3; ++c) trace.irradiance[c] = l.intensity[c] * incidence.attenuation;

  AlignedBuffer<uint32_t> lit;
  lit.assign(kLanePadding, 1);
  if (frame.plan.shadow_rays) {
    RayBatch rays;
    AlignedBuffer<uint32_t> surface_of_ray, answer;
    make_shadow_rays(frame, s, index, rays, surface_of_ray);
    answer.assign(kLanePadding, 0);
    trace.has_ray = rays.count > 0;
    lit[0] = 0;
    if (trace.has_ray) {
      trace_any(frame, opaque, rays, answer.data());
      lit[0] = ~answer[0] & 1u;
      for (int k = 0; k < 3; ++k) trace.origin[k] = rays.origin[k][0], trace.direction[k] = rays.direction[k][0];
      trace.t_max = rays.t_max[0], trace.lifted = rays.from[0] == kNoPrimitive;
      answer.assign(kLanePadding, kNoPrimitive);
      trace_closest(frame, opaque, rays, answer.data());
      trace.blocker = answer[0];
    }
  }
  trace.lit = lit[0] != 0;
  Radiance alone;
  shade_light(frame, s, hits, index, nullptr, alone.pointer);
  alone.get(trace.alone);
  shade_light(frame, s, hits, index, frame.plan.shadow_rays ? lit.data() : nullptr, sum.pointer);
  sum.get(trace.sum);
  return trace;
}

}  // namespace

SurfaceTrace trace_surface(const Frame& frame, const Bvh& opaque, const HitBatch& hits, SurfaceBatch& s) {
  SurfaceTrace trace;
  if (hits.count == 0) return trace;
  resolve_surfaces(frame, hits, s);
  if (frame.plan.lifted_rays && frame.plan.shadow_rays) {
    RayBatch rays;
    AlignedBuffer<uint32_t> surface_of_ray, blocked;
    keep_free_lifts(frame, opaque, s, rays, surface_of_ray, blocked);
  }
  trace.valid = s.valid[0] != 0;
  trace.primitive = s.primitive[0], trace.material = s.material[0];
  trace.t = s.t[0], trace.position_error = s.position_error[0], trace.shininess = s.shininess[0], trace.opacity = s.opacity[0];
  copy3(s.weight, 0, trace.weight), copy3(s.position, 0, trace.position), copy3(s.geometric_normal, 0, trace.geometric_normal);
  copy3(s.normal, 0, trace.normal), copy3(s.view, 0, trace.view), copy3(s.lift, 0, trace.lift), copy3(s.dpdx, 0, trace.dpdx), copy3(s.dpdy, 0, trace.dpdy);
  copy3(s.ambient, 0, trace.ambient), copy3(s.diffuse, 0, trace.diffuse), copy3(s.specular, 0, trace.specular);
  copy3(s.emission, 0, trace.emission), copy3(s.mirror, 0, trace.mirror);
  for (int j = 0; j < 3 && frame.scene->is_triangle(trace.primitive); ++j)
    for (int k = 0; k < 2; ++k)
      trace.uv[k] += trace.weight[j] * frame.scene->vertices[frame.scene->triangles[trace.primitive].vertex[j]].uv[k];
  Radiance sum;
  shade_ambient(frame, s, sum.pointer);
  sum.get(trace.ambient_radiance);
  for (int i = 0; i < static_cast<int>(frame.scene->lights.size()); ++i)
    trace.lights.push_back(trace_light(frame, opaque, hits, s, i, sum));
  sum.get(trace.radiance);
  return trace;
}

}  // namespace spanray
