// Light on surfaces: shadow rays, radiance of one light after the other in index order, mirror rays, compositing.
#pragma once
#include "shade/surface.h"

namespace spanray {

// For each valid surface that `light` may reach (in front of it by the geometric normal): one ray from the surface, origin moved off
// it by the error bound, to the light, appended to rays; surface_of_ray[i] names the surface of ray i. With plan.lifted_rays also where the
// interpolated normal of a surface with a lift faces the light; those rays start at position + lift and leave no triangle.
void make_shadow_rays(const Frame& frame, const SurfaceBatch& surfaces, int light, RayBatch& rays,
                      AlignedBuffer<uint32_t>& surface_of_ray);

// With plan.lifted_rays, before the shadow rays of any light: from each surface that may want some of those lifted, the segment to where
// they would start (SurfaceBatch::lift). Surfaces that something hides there must lose their lift: else light would pass through it.
void make_lift_rays(const Frame& frame, const SurfaceBatch& surfaces, RayBatch& rays, AlignedBuffer<uint32_t>& surface_of_ray);

// Lights of the scene in a row, and which surfaces each of them reaches.
struct LightRange {
  int first = 0, count = 0;
  const uint32_t* lit = nullptr;  // one bit a surface (32 a word), nullptr: all lit
  size_t words = 0;               // from the bits of one light to those of the next
  const uint32_t* bits(int k) const { return lit == nullptr ? nullptr : lit + static_cast<size_t>(k) * words; }
};

// radiance[c][i] = ambient + emission of surface i, and what these lights add, in index order: shade_ambient and shade_light of each, in
// one go and with the same bits. Writes all count entries (0 for invalid ones).
void shade_lights(const Frame& frame, const SurfaceBatch& surfaces, const HitBatch& hits, const LightRange& lights, float* const radiance[3]);

// radiance[c][i] = ambient + emission of surface i. Writes all count entries (0 for invalid ones).
void shade_ambient(const Frame& frame, const SurfaceBatch& surfaces, float* const radiance[3]);

// radiance[c][i] += light reflected toward the viewer. lit: one bit a surface (32 a word), nullptr = all lit.
void shade_light(const Frame& frame, const SurfaceBatch& surfaces, const HitBatch& hits, int light, const uint32_t* lit,
                 float* const radiance[3]);

// Mirror rays of the surfaces whose mirror weight is not zero, with their differentials. surface_of_ray as above.
void make_bounce_rays(const Frame& frame, const SurfaceBatch& surfaces, const HitBatch& hits, RayBatch& rays,
                      AlignedBuffer<uint32_t>& surface_of_ray);

// Blends shaded translucent fragments over opaque radiance, per ray far to near (t descending, id descending: the lowest id
// lies on top): L = a * Lf + (1 - a) * L. Fragments farther than the opaque t are dropped. opaque_t[slot]: infinity for misses.
// slot[i]: the entry of fragment i in radiance/opaque_t; slot -1 drops it. transmittance[slot] is set to the product of (1 - a).
void composite(const SurfaceBatch& fragments, const int32_t* slot, const float* const fragment_radiance[3],
               const float* opaque_t, int slots, float* const radiance[3], float* transmittance);

}  // namespace spanray
