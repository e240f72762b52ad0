// The nouns of a scene, as the stages read them: flat arrays of plain values, indices checked, all numbers finite.
// Made by scene/scene_builder.cpp only, which establishes every invariant stated here.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core/aligned.h"
#include "scene/instance.h"
#include "scene/motion.h"
#include "spanray/camera.h"
#include "spanray/settings.h"

namespace spanray {

// One 32-byte record, so that a gather of a vertex touches one cache line. Vertices are unique in
// (position, normal, uv, material), but that each instance has its own: a lit vertex (Gouraud) belongs to one material.
struct alignas(32) Vertex {
  float position[3];
  float normal[3];  // unit length
  float uv[2];      // OBJ convention: v = 0 is the bottom row of the image
};
inline constexpr int kVertexStride = 8;  // floats

// Canonical order: position(v0) <= position(v1) <= position(v2), compared as tuples of floats (-0 made +0 at load). So the
// same three points give the same arithmetic in every stage, whatever order the file had; kFlipped says when the
// order is the mirror image of the file's. Corner normals that were missing stand in the vertices already.
struct Triangle {
  uint32_t vertex[3];
  uint32_t bits;  // material index and kTriangleFlipped
};
inline constexpr uint32_t kTriangleMaterialMask = 0x7fffffffu;
inline constexpr uint32_t kTriangleFlipped = 0x80000000u;  // the file's order is v0, v2, v1 (counter-clockwise = front)
inline constexpr uint32_t kNoPrimitive = 0xffffffffu;
inline constexpr int kTriangleStride = 4;  // 32-bit words

inline uint32_t material_of(const Triangle& t) { return t.bits & kTriangleMaterialMask; }

// A sphere of [[sphere]] in a scene file. As a primitive, sphere i has the number triangles.size() + i.
struct Sphere {
  float center[3];
  float radius;  // > 0; the whole sphere keeps within coordinates of 1e30
  uint32_t material;
};

// A plane of [[plane]]: all p with dot(normal, p - point) = 0, exactly as the floats say. As a primitive, plane i has the number
// triangles.size() + spheres.size() + i.
struct Plane {
  float point[3];
  float normal[3];  // on the front side; of any length: its largest coordinate is 1 to below 2 in size
  uint32_t material;
};

// How a material uses a texture: the options of its MTL line. Only 4-byte fields, so that lanes can gather them.
struct TextureUse {
  int32_t texture = -1;          // index into SceneData::textures
  float offset[2] = {0, 0};      // -o
  float scale[2] = {1, 1};       // -s
  float base = 0, gain = 1;      // -mm: value = base + gain * texel
  float bump_multiplier = 1;     // -bm
  int32_t clamp = 0;             // -clamp on: 1
  int32_t channel = -1;          // -imfchan: 0 r, 1 g, 2 b, 3 a (m), 4 luminance; -1: the default of the slot
  bool operator==(const TextureUse&) const = default;
};
inline constexpr int kTextureUseStride = sizeof(TextureUse) / 4;

enum class MaterialTransparency : int32_t { kOpaque, kMask, kAlpha, kScreenDoor };

// MTL fields in linear light. Only 4-byte fields. Texture slots index SceneData::texture_uses, -1 = none; ambient light without a map of
// its own is modulated by map_diffuse.
struct Material {
  float ambient[3] = {0.8f, 0.8f, 0.8f};  // Ka, or Kd where Ka is absent or zero
  float diffuse[3] = {0.8f, 0.8f, 0.8f};  // Kd, reflectance in [0, 1]
  float specular[3] = {0, 0, 0};          // Ks
  float emission[3] = {0, 0, 0};          // Ke, radiance, W/(m^2 sr)
  float mirror[3] = {0, 0, 0};            // weight of the reflected radiance; Ks where illum asks for reflection, else 0
  float transmission_filter[3] = {1, 1, 1};  // Tf
  float shininess = 1;                    // Ns, clamped to [0, 1e4]
  float opacity = 1;                      // d
  float index_of_refraction = 1.5f;       // Ni
  int32_t illum = 2;
  int32_t reflectance = 0;                // index into the catalog's reflectance list
  int32_t transparency = 0;               // MaterialTransparency
  int32_t map_ambient = -1, map_diffuse = -1, map_specular = -1, map_shininess = -1, map_emission = -1;
  int32_t map_opacity = -1, map_bump = -1, map_normal = -1;
};
inline constexpr int kMaterialStride = sizeof(Material) / 4;

inline constexpr int kMaxMipLevels = 15;  // 16384 = 2^14
// Levels stand one after the other, row-major, top row first, no padding. Level k has size max(1, size >> k), made by an exact
// box filter (area weights in integers, rounded half up).
struct Texture {
  int32_t width = 0, height = 0, levels = 0;
  int32_t offset[kMaxMipLevels] = {};  // first texel of each level in SceneData::texels
};
inline constexpr int kTextureStride = sizeof(Texture) / 4;

// The height map of a texture use by its one channel, each row followed by its first two heights: three neighbours, around the
// end, too, are one load. A copy, made by make_height_rows() (scene/height_rows.h): no bit of a pixel depends on whether it is there.
struct HeightRows {
  int32_t offset[kMaxMipLevels + 1];  // first height of each level in SceneData::heights; -1: there are none
};
inline constexpr int kHeightRowsStride = sizeof(HeightRows) / 4;

// 16 bits a channel, linear light (sRGB decoded at load for color slots; height, normal, mask and shininess maps as they are).
// An sRGB byte decoded to this and encoded again is the same byte.
struct Texel { uint16_t r, g, b, a; };

enum class LightKind : int32_t { kPoint, kDirectional };
struct Light {
  int32_t kind = 0;                        // LightKind: index into the catalog's light list
  float position[3] = {0, 0, 0};           // point lights
  float direction[3] = {0, -1, 0};         // directional: unit vector along which light travels
  float intensity[3] = {1, 1, 1};          // point: radiant intensity, W/sr; directional: irradiance, W/m^2
  float attenuation[3] = {0, 0, 1};        // point: E = I / max(kc + kl*d + kq*d^2, kMinAttenuation)
};
inline constexpr float kMinAttenuation = 1e-4f;  // caps a light that lies on the surface (HARD-CASES S3)
inline constexpr int kMaxLights = 64;

struct CameraKey { double time; Camera camera; };  // seconds; a camera path is a list of these, in order of time

// The triangles from `first` on, up to the next part, belong to these names of the OBJ (`o`, `g`). No pixel depends on it.
struct ScenePart {
  uint32_t first = 0, object = 0, group = 0;  // names: indices into SceneData::part_names
};

// A piece of an array of the scene that moves with one motion; short enough to be one task.
struct MovingRun {
  uint32_t first, count, motion;  // the last: index into SceneData::motions
};
inline constexpr uint32_t kMostInRun = 4096;

// All of a scene but its large arrays.
struct SceneTables {
  std::vector<Material> materials;  // never empty
  std::vector<std::string> material_names;
  std::vector<ScenePart> parts;         // ascending; those without a triangle are left out
  std::vector<std::string> part_names;  // [0] is "": faces before any `o` or `g`
  std::vector<TextureUse> texture_uses;
  std::vector<HeightRows> height_rows;  // of each texture use, or empty
  std::vector<Texture> textures;
  std::vector<std::string> texture_names;
  std::vector<Light> lights;        // at most kMaxLights
  bool light_follows_eye = false;   // the only light is the default one: each frame has it near its own eye (default_light)
  float ambient_radiance[3] = {0.03f, 0.03f, 0.03f};
  float background[3] = {0.05f, 0.06f, 0.08f};  // radiance of rays that leave the scene, linear
  std::vector<Camera> cameras;      // never empty; the first is the default
  std::vector<std::string> camera_names;
  std::vector<CameraKey> camera_path;
  Settings settings;                // what the scene file asks for; the command line goes over it
  // Moving parts. The arrays hold them as the file does; scene/pose.h gives them as they stand at a time. Runs ascend, none overlap,
  // and no vertex belongs to two parts.
  std::vector<Motion> motions;
  std::vector<MovingRun> moving_vertices, moving_triangles;
  // Copies of parts. Their triangles and vertices stand in the arrays like any others, behind those of the OBJ: only trees may use that they
  // are copies (ray/bvh_instances.h). Ascending, none overlap, none moves.
  std::vector<InstancedPart> instanced_parts;
  std::vector<Instance> instances;
  // Exact primitives. Their materials are opaque, without maps; they stand still.
  std::vector<Sphere> spheres;
  std::vector<Plane> planes;
  // Of all triangles and spheres; if there are none, of the points of planes; equal if there is nothing at all.
  float bounds_min[3] = {0, 0, 0}, bounds_max[3] = {0, 0, 0};
  uint64_t hash = 0;                // of everything that can reach a pixel, taken after loading
};

struct SceneData : SceneTables {
  AlignedBuffer<Vertex> vertices;
  AlignedBuffer<Triangle> triangles;
  AlignedBuffer<Texel> texels;
  AlignedBuffer<uint16_t> heights;

  // What the tables of textures point into is that of `from`, which must outlive this.
  void borrow_texels(const SceneData& from) {
    texels = AlignedBuffer<Texel>::borrow(from.texels), heights = AlignedBuffer<uint16_t>::borrow(from.heights);
  }

  // Of primitives that are there: kNoPrimitive is none of these.
  bool is_triangle(uint32_t primitive) const { return primitive < triangles.size(); }
  bool is_sphere(uint32_t primitive) const { return primitive - triangles.size() < spheres.size(); }
  bool is_plane(uint32_t primitive) const { return primitive - triangles.size() - spheres.size() < planes.size(); }
  const Sphere& sphere(uint32_t primitive) const { return spheres[primitive - triangles.size()]; }
  const Plane& plane(uint32_t primitive) const { return planes[primitive - triangles.size() - spheres.size()]; }
  bool has_exact() const { return !spheres.empty() || !planes.empty(); }
};

// Of a primitive of any kind.
inline uint32_t material_of(const SceneData& scene, uint32_t primitive) {
  if (scene.is_triangle(primitive)) return material_of(scene.triangles[primitive]);
  return scene.is_sphere(primitive) ? scene.sphere(primitive).material : scene.plane(primitive).material;
}

}  // namespace spanray
