// Surfaces: everything that shading wants to know about a batch of hits, as arrays over lanes.
#pragma once
#include <cstdint>
#include <vector>

#include "frame/frame.h"

namespace spanray {

// Fields that only some frames need.
enum SurfaceFields : uint32_t { kSurfaceAmbient = 1, kSurfaceEmission = 2, kSurfaceMirror = 4, kSurfaceFootprint = 8,
                                kSurfaceDepth = 16, kSurfaceWeight = 32, kSurfaceLift = 64, kSurfaceNormal = 128,
                                kSurfaceView = 256, kSurfaceAllFields = 511 };

// Arrays of one float (or word) a surface; all are padded so that whole vectors may be read and written past count.
// Fields of stages that the plan leaves out (ambient, specular, shininess, emission, mirror, dpdx, dpdy, lift, smooth_normal), and t,
// weight, normal and view where nobody reads them, are 0.
struct SurfaceBatch {
  int count = 0;
  uint32_t fields = 0;         // SurfaceFields that are written
  LaneCounts plane_lanes, surface_lanes;  // what it took: FrameCounts
  float* position[3];          // on the original triangle, moved into it
  float* position_error;       // bound on the distance of position from the triangle, each coordinate, world units (resolve-inl.h, plane-inl.h)
  float* geometric_normal[3];  // unit, toward the ray's origin
  float* normal[3];            // shading normal: interpolated, bumped; unit, clamped to the hemisphere of geometric_normal
  float* view[3];              // unit, toward the ray's origin
  float* t;                    // in units of the ray's direction; for primary rays the view depth
  float* weight[3];            // barycentric, sum 1 within rounding, each in [0, 1]
  float* dpdx[3];              // differential of position by pixel x and y: the footprint
  float* dpdy[3];
  float* lift[3];              // from position to where lifted shadow rays start, world units; zero: none do (shade/lift-inl.h)
  float* smooth_normal[3];     // interpolated normal before maps bend it, of no certain length
  float *ambient[3], *diffuse[3], *specular[3], *emission[3], *mirror[3];  // material times textures
  float *shininess, *opacity;
  uint32_t *pixel, *ray, *primitive, *material;
  uint32_t* valid;             // 1, or 0 for a miss (all floats are then 0)

  std::vector<int> exact;      // entries that are hits of exact primitives
  int lights = 0;              // that the surfaces carry (triangle_light): all of the scene's or none
  AlignedBuffer<float> planes;  // scratch of resolve_surfaces (shade/plane-inl.h)

  SurfaceBatch();
  // written: SurfaceFields. The others share one array of zeros: nothing else may be written there.
  void resize(int n, uint32_t written = kSurfaceAllFields, int with_lights = 0);
  // Gouraud and flat, of primary rays: attenuation * reflectance * cosine, interpolated from the corners or of the face. Factor 0: diffuse,
  // times intensity and Kd it is radiance; 1: specular, only with plan.specular. nullptr without lights.
  float* triangle_light(int light, int factor) const { return lights > 0 ? triangle_light_ + static_cast<size_t>(2 * light + factor) * stride_ : nullptr; }
  size_t memory_bytes() const { return storage_.bytes() + planes.bytes(); }

 private:
  AlignedBuffer<float> storage_;
  float* triangle_light_ = nullptr;
  size_t stride_ = 0;  // entries of each array
};

// Recomputes the surface of each hit from its ray and the original triangle, from a setup in double: once a triangle and cell of the picture
// for primary rays, once a hit for others. The same for both engines, so equal ids give equal bits (DESIGN 1). Interpolation by
// settings.shading; textures by footprint; bump.
void resolve_surfaces(const Frame& frame, const HitBatch& hits, SurfaceBatch& out);

// accept(hit) for both engines: see frame/frame.h.
uint32_t accept_row(const Frame& frame, uint32_t primitive, int x0, int y, uint32_t candidates, int place = 0);
uint32_t accept_rays(const Frame& frame, const RayBatch& rays, int first, uint32_t primitive, uint32_t candidates);

}  // namespace spanray
