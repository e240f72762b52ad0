// The only maker of SceneData: takes loose triangles and tables, checks every number, establishes the invariants.
#pragma once
#include <string>
#include <vector>

#include "math/vec.h"
#include "scene/scene_data.h"
#include "spanray/result.h"

namespace spanray {

// A triangle as a file gives it: corners in counter-clockwise order seen from the front.
struct SoupTriangle {
  Vertex corner[3];
  uint32_t material = 0;
  uint32_t object = 0, group = 0;  // names, as in ScenePart
  uint32_t motion = 0;             // 1 + index into SceneData::motions; 0: stands
};

// Positions that scenes can hold: finite, each coordinate at most 1e30 like those of cameras, so that what is derived from
// them (bounds, the default light) is finite too.
inline constexpr float kMostCoordinate = 1e30f;
inline bool usable_position(const float* p) {
  for (int k = 0; k < 3; ++k)
    if (!(p[k] >= -kMostCoordinate && p[k] <= kMostCoordinate)) return false;
  return true;
}

struct BuildReport {
  uint64_t dropped_unusable = 0;    // triangles with a position that is not usable
  uint64_t repaired_normals = 0;    // corners whose normal was zero or not finite: the face normal took its place
  uint64_t repaired_uvs = 0;        // corners whose uv was not finite: set to 0
  uint64_t zero_area = 0;           // kept (they cover no pixel), counted
};

// Word offsets of gathers stay below 2^31.
inline bool fits(uint64_t vertices, uint64_t triangles) { return vertices <= uint64_t{1} << 27 && triangles <= uint64_t{1} << 28; }
inline constexpr const char* kSceneTooLarge = "the scene is too large: at most 2^27 distinct vertices and 2^28 triangles";

// Sorts the corners of a triangle into the canonical order (scene_data.h) and keeps its bits right.
void order_vertices(const AlignedBuffer<Vertex>& vertices, Triangle& triangle);

// Replaces the geometry of `scene` by `soup`: drops and repairs as counted, merges equal (position, normal, uv, material, motion)
// corners into vertices in order of first use, orders each triangle canonically, keeps the order of triangles, computes bounds and parts.
// Material indices must be below scene.materials.size(), motions at most scene.motions.size(). Errors: too many vertices for 32-bit
// gathers.
Result<BuildReport> build_geometry(const std::vector<SoupTriangle>& soup, SceneData& scene);

// Whether a scene can hold the sphere: radius > 0, no coordinate of it beyond kMostCoordinate.
bool usable_sphere(const Sphere& sphere);

// Adds a usable sphere, whose material is one of the scene's, behind all that is there; bounds grow. After build_geometry.
void add_sphere(const Sphere& sphere, SceneData& scene);

// Sets the normal of a plane: along a direction of any length, scaled by a power of two and rounded to float. False: it has no
// length, or is not finite.
bool set_normal(const glm::dvec3& direction, Plane& plane);

// Adds a plane through a usable position, whose normal is set and whose material is one of the scene's, behind all that is there.
// After all spheres. Bounds grow only if there are planes alone.
void add_plane(const Plane& plane, SceneData& scene);

// Computes scene.hash from all that can reach a pixel. Call last.
void hash_scene(SceneData& scene);

// A scene from bare triangles with per-corner data, one default material, no light, a default camera: for tests.
SceneData make_test_scene(const std::vector<SoupTriangle>& soup, std::vector<Material> materials = {});

}  // namespace spanray
