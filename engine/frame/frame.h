// Everything that the stages of one frame share: read-only while they run.
#pragma once
#include <cstdint>

#include "core/parallel.h"
#include "frame/rays.h"
#include "frame/samples.h"
#include "frame/tiles.h"
#include "scene/scene_data.h"
#include "simd/isa.h"

namespace spanray {

// What the frame needs, each with its reason (render/plan.cpp fills it; `spanray info` prints it). A stage whose flag is off
// allocates nothing and runs nothing.
struct PlanFlags {
  bool motion = false, raster = false, primary_rays = false, bvh = false, translucent_bvh = false;
  bool shadow_rays = false, bounces = false, translucents = false, masks = false;
  bool textures = false, bump = false, samples = false, lit_vertices = false, emission = false, ambient = false, specular = false;
  bool raw_normals = false;   // interpolated normals stay as they are (Settings::normals), and some triangle's corners differ
  bool coarse_quads = false;  // render/coarse_quads.h
  bool depths = true, weights = true, normals = true, views = true;  // somebody reads these fields of surfaces (t, weight, normal, view)
  bool surfaces = true;       // somebody asks for stored surfaces (shade/surface.h) themselves
  bool light_grids = false;   // shadow rays ask those, once they are there
  bool lifted_rays = false;   // shadow rays above coarse triangles (Settings::shadow_terminator), and some triangle's corners differ
  uint32_t maps = 0;  // MaterialMaps that some material has
};

enum MaterialMaps : uint32_t {
  kMapAmbient = 1, kMapDiffuse = 2, kMapSpecular = 4, kMapShininess = 8, kMapEmission = 16, kMapOpacity = 32, kAllMaps = 63
};

// What a material means in this frame: to visibility, where Settings::transparency may override the
// material's own wish, and to shading.
enum MaterialFlags : uint32_t {
  kMaterialMasked = 1,       // accept(hit) decides: alpha mask (map_d) or screen-door
  kMaterialTranslucent = 2,  // blended by alpha after the opaque surfaces; not an occluder of shadow rays
  kMaterialMapped = 4,       // has a map: its surfaces have texture coordinates
  kMaterialBumped = 8,       // has a height or normal map: and tangents
};

// Answers accept(hit) for primitives whose material is kMaterialMasked: alpha masks (map_d) and screen-door. Both engines ask it
// through Frame, since stages do not know each other; shade/accept_kernel.cpp implements it. Not called for other primitives.
struct Frame;
// For primary rays of pixels in one row: x0 .. x0 + count - 1 (count <= 32) at row y, all through one place (frame/samples.h),
// against one primitive. Bit i: pixel x0 + i accepts. Only bits set in `candidates` need be computed.
using AcceptRowFn = uint32_t (*)(const Frame&, uint32_t primitive, int x0, int y, uint32_t candidates, int place);
// For up to 32 rays of a batch, from `first` on, against one primitive that they hit. Bit i: ray first + i accepts. Only bits set in
// `candidates` are computed, the others are 0.
using AcceptRaysFn = uint32_t (*)(const Frame&, const RayBatch&, int first, uint32_t primitive, uint32_t candidates);

inline uint32_t flags_of(const Frame& frame, uint32_t primitive);

struct Frame {
  const SceneData* scene = nullptr;
  Settings settings;        // resolved: no kAuto, no kScene left but per-material decisions
  PlanFlags plan;
  PrimaryRays primary;
  TileGrid grid;
  SamplePlaces places;
  double footprint = 1;     // side of the square that is shaded at once, in pixels: less than 1 if every sample is
  Isa isa = Isa::kScalar;   // concrete
  Parallel* parallel = nullptr;
  const uint32_t* material_flags = nullptr;  // MaterialFlags by material
  AcceptRowFn accept_row = nullptr;
  AcceptRaysFn accept_rays = nullptr;  // none: no material is masked
  Light eye_light;  // the scene's only light, where that one follows the eye
};

inline const Light& light_of(const Frame& frame, int light) {
  return frame.scene->light_follows_eye ? frame.eye_light : frame.scene->lights[static_cast<size_t>(light)];
}

inline uint32_t flags_of(const Frame& frame, uint32_t primitive) {
  return frame.material_flags[material_of(frame.scene->triangles[primitive])];
}

// Which side of a triangle a point sees: > 0 the front (counter-clockwise in the file's order), < 0 the back, 0 edge-on.
// One formula, in double, for both engines; for a hit its sign is that of N.V (DESIGN 1).
inline double facing(const SceneData& scene, const Triangle& t, const glm::dvec3& from) {
  glm::dvec3 v[3];
  for (int i = 0; i < 3; ++i) {
    const float* p = scene.vertices[t.vertex[i]].position;
    v[i] = {p[0], p[1], p[2]};
  }
  const double side = dot3(cross3(v[1] - v[0], v[2] - v[0]), from - v[0]);
  return (t.bits & kTriangleFlipped) ? -side : side;
}

// Integers only: sums do not depend on the order of tasks.
struct FrameCounts {
  uint64_t triangles_in = 0, triangles_invalid = 0, triangles_clipped = 0, triangles_drawn = 0;
  // Of those that are not drawn: outside the picture, back faces (where they are culled), in clusters behind something large
  // (raster/occluders.h), without a sample in the picture. One that is several of these counts once, as any of them.
  uint64_t triangles_outside = 0, triangles_back_face = 0, triangles_hidden = 0, triangles_empty = 0;
  uint64_t triangles_culled() const { return triangles_outside + triangles_back_face + triangles_hidden + triangles_empty; }
  // Of opaque triangles, once for each tile and each sample of a pixel: listed, and hidden by what was drawn before. Samples that passed
  // the depth test; over the covered ones, that is the overdraw.
  uint64_t tile_triangles = 0, tile_triangles_hidden = 0, samples_passed = 0;
  uint64_t pixels_covered = 0, surfaces_shaded = 0, quads_shaded = 0, fragments_translucent = 0;
  uint64_t rays_primary = 0, rays_shadow = 0, rays_bounce = 0, rays_translucent = 0;
  uint64_t vertices_lit = 0;  // Gouraud: corners of what primary rays see, three a triangle in a cell
  // Walkers of columns and rows: the samples that passed. Packets of tiny triangles: the samples inside. Planes of primary hits: of triangles
  // in a cell. Surfaces: those that hit.
  LaneCounts walker_lanes, packet_lanes, plane_lanes, surface_lanes;
  uint64_t bvh_refits = 0, bvh_rebuilds = 0;  // trees that followed moving parts: of the second kind, those built anew

  void add(const FrameCounts& c) {
    triangles_in += c.triangles_in, triangles_invalid += c.triangles_invalid, triangles_clipped += c.triangles_clipped;
    triangles_drawn += c.triangles_drawn, triangles_outside += c.triangles_outside, triangles_back_face += c.triangles_back_face;
    triangles_hidden += c.triangles_hidden, triangles_empty += c.triangles_empty;
    tile_triangles += c.tile_triangles, tile_triangles_hidden += c.tile_triangles_hidden, samples_passed += c.samples_passed;
    pixels_covered += c.pixels_covered, surfaces_shaded += c.surfaces_shaded, quads_shaded += c.quads_shaded;
    fragments_translucent += c.fragments_translucent;
    rays_primary += c.rays_primary, rays_shadow += c.rays_shadow, rays_bounce += c.rays_bounce, rays_translucent += c.rays_translucent;
    vertices_lit += c.vertices_lit, bvh_refits += c.bvh_refits, bvh_rebuilds += c.bvh_rebuilds;
    walker_lanes.add(c.walker_lanes), packet_lanes.add(c.packet_lanes);
    plane_lanes.add(c.plane_lanes), surface_lanes.add(c.surface_lanes);
  }
  void add(const TileHits& tile) {
    tile_triangles += tile.triangles, tile_triangles_hidden += tile.triangles_hidden, samples_passed += tile.passed;
    walker_lanes.add(tile.walker_lanes), packet_lanes.add(tile.packet_lanes);
  }
};

}  // namespace spanray
