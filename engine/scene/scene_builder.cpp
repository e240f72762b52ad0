#include "scene/scene_builder.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <unordered_map>

#include "core/hash.h"
#include "math/vec.h"

namespace spanray {
namespace {

constexpr size_t kMostVertices = size_t{1} << 27, kMostTriangles = size_t{1} << 28;  // word offsets of gathers stay below 2^31

bool finite3(const float* p) { return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]); }

glm::dvec3 to_dvec(const float* p) { return {p[0], p[1], p[2]}; }

struct VertexKey {
  Vertex vertex;
  uint32_t material;
  bool operator==(const VertexKey& o) const {
    return material == o.material && std::memcmp(&vertex, &o.vertex, sizeof(Vertex)) == 0;
  }
};
struct VertexKeyHash {
  size_t operator()(const VertexKey& k) const {
    return static_cast<size_t>(Hash().add(&k.vertex, sizeof(Vertex)).add_word(k.material).value());
  }
};

bool position_less(const Vertex& a, const Vertex& b) {
  return std::lexicographical_compare(a.position, a.position + 3, b.position, b.position + 3);
}

// Makes the corners of one triangle fit to be vertices; false if the triangle must be dropped.
bool repair_corners(SoupTriangle& t, BuildReport& report) {
  for (const Vertex& v : t.corner)
    if (!usable_position(v.position)) {
      ++report.dropped_unusable;
      return false;
    }
  const glm::dvec3 p0 = to_dvec(t.corner[0].position);
  const glm::dvec3 cross = cross3(to_dvec(t.corner[1].position) - p0, to_dvec(t.corner[2].position) - p0);
  if (cross == glm::dvec3(0)) ++report.zero_area;
  const glm::dvec3 face = normalize3(cross, glm::dvec3(0, 1, 0));
  for (Vertex& v : t.corner) {
    const glm::dvec3 n = finite3(v.normal) ? to_dvec(v.normal) : glm::dvec3(0);
    if (n == glm::dvec3(0)) ++report.repaired_normals;
    const glm::dvec3 unit = normalize3(n, face);
    const bool uv_ok = std::isfinite(v.uv[0]) && std::isfinite(v.uv[1]);
    if (!uv_ok) ++report.repaired_uvs;
    for (int k = 0; k < 3; ++k) {
      v.position[k] += 0.0f;  // -0 becomes +0: equal positions have equal bits
      v.normal[k] = static_cast<float>(unit[k]) + 0.0f;
    }
    for (float& c : v.uv) c = uv_ok ? c + 0.0f : 0.0f;
  }
  return true;
}

// Sorts three vertex indices by position; the sign of the permutation tells whether the triangle was mirrored.
Triangle canonical_triangle(const AlignedBuffer<Vertex>& vertices, const uint32_t index[3], uint32_t material) {
  Triangle t{{index[0], index[1], index[2]}, material};
  bool flipped = false;
  const auto order = [&](int a, int b) {
    if (!position_less(vertices[t.vertex[b]], vertices[t.vertex[a]])) return;
    std::swap(t.vertex[a], t.vertex[b]);
    flipped = !flipped;
  };
  order(0, 1), order(1, 2), order(0, 1);
  if (flipped) t.bits |= kTriangleFlipped;
  return t;
}

template <class T> void hash_vector(Hash& hash, const std::vector<T>& v) {
  hash.add_word(v.size());
  if (!v.empty()) hash.add(v.data(), v.size() * sizeof(T));
}
template <class T> void hash_buffer(Hash& hash, const AlignedBuffer<T>& v) {
  hash.add_word(v.size());
  if (!v.empty()) hash.add(v.data(), v.size() * sizeof(T));
}

}  // namespace

Result<BuildReport> build_geometry(const std::vector<SoupTriangle>& soup, SceneData& scene) {
  BuildReport report;
  scene.vertices.clear();
  scene.triangles.clear();
  scene.parts.clear();
  std::unordered_map<VertexKey, uint32_t, VertexKeyHash> index_of;
  index_of.reserve(soup.size());
  bool empty = true;
  for (const SoupTriangle& file_triangle : soup) {
    SoupTriangle t = file_triangle;
    if (t.material >= scene.materials.size()) return Error{"material index " + std::to_string(t.material) + " out of range"};
    if (!repair_corners(t, report)) continue;
    uint32_t index[3];
    for (int i = 0; i < 3; ++i) {
      const auto [it, is_new] = index_of.try_emplace({t.corner[i], t.material}, static_cast<uint32_t>(scene.vertices.size()));
      index[i] = it->second;
      if (is_new) scene.vertices.push_back(t.corner[i]);
      for (int k = 0; k < 3; ++k) {
        const float p = t.corner[i].position[k];
        scene.bounds_min[k] = empty ? p : std::min(scene.bounds_min[k], p);
        scene.bounds_max[k] = empty ? p : std::max(scene.bounds_max[k], p);
      }
      empty = false;
    }
    if (scene.parts.empty() || scene.parts.back().object != t.object || scene.parts.back().group != t.group)
      scene.parts.push_back({static_cast<uint32_t>(scene.triangles.size()), t.object, t.group});
    scene.triangles.push_back(canonical_triangle(scene.vertices, index, t.material));
    if (scene.vertices.size() > kMostVertices || scene.triangles.size() > kMostTriangles)
      return Error{"the scene is too large: at most 2^27 distinct vertices and 2^28 triangles"};
  }
  if (empty)
    for (int k = 0; k < 3; ++k) scene.bounds_min[k] = scene.bounds_max[k] = 0;
  return report;
}

void hash_scene(SceneData& scene) {
  Hash hash;
  hash_buffer(hash, scene.vertices);
  hash_buffer(hash, scene.triangles);
  hash_vector(hash, scene.materials);
  hash_vector(hash, scene.texture_uses);
  hash_vector(hash, scene.textures);
  hash_buffer(hash, scene.texels);
  hash_vector(hash, scene.lights);
  if (scene.light_follows_eye) hash.add_word(1);
  hash.add(scene.ambient_radiance, sizeof scene.ambient_radiance).add(scene.background, sizeof scene.background);
  scene.hash = hash.value();
}

SceneData make_test_scene(const std::vector<SoupTriangle>& soup, std::vector<Material> materials) {
  SceneData scene;
  if (materials.empty()) materials.emplace_back();
  scene.materials = std::move(materials);
  scene.material_names.assign(scene.materials.size(), "material");
  scene.part_names = {""};
  scene.cameras.emplace_back();
  scene.camera_names.emplace_back("default");
  (void)build_geometry(soup, scene);
  hash_scene(scene);
  return scene;
}

}  // namespace spanray
