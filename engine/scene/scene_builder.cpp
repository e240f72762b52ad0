#include "scene/scene_builder.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <unordered_map>

#include "core/hash.h"
#include "math/vec.h"

namespace spanray {
namespace {

bool finite3(const float* p) { return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]); }

glm::dvec3 to_dvec(const float* p) { return {p[0], p[1], p[2]}; }

struct VertexKey {
  Vertex vertex;
  uint32_t material, motion;
  bool operator==(const VertexKey& o) const {
    return material == o.material && motion == o.motion && std::memcmp(&vertex, &o.vertex, sizeof(Vertex)) == 0;
  }
};
struct VertexKeyHash {
  size_t operator()(const VertexKey& k) const {
    return static_cast<size_t>(Hash().add(&k.vertex, sizeof(Vertex)).add_word(k.material | uint64_t{k.motion} << 32).value());
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

void grow_bounds(const float (&low)[3], const float (&high)[3], bool first, SceneData& scene) {
  for (int k = 0; k < 3; ++k) {
    scene.bounds_min[k] = first ? low[k] : std::min(scene.bounds_min[k], low[k]);
    scene.bounds_max[k] = first ? high[k] : std::max(scene.bounds_max[k], high[k]);
  }
}

// Appends element `index` to the runs of its motion; motion: as in SoupTriangle.
void add_to_runs(std::vector<MovingRun>& runs, uint32_t index, uint32_t motion) {
  if (motion == 0) return;
  if (!runs.empty()) {
    MovingRun& last = runs.back();
    if (last.motion == motion - 1 && last.first + last.count == index && last.count < kMostInRun) return void(++last.count);
  }
  runs.push_back({index, 1, motion - 1});
}

template <class T> void hash_vector(Hash& hash, const std::vector<T>& v) {
  hash.add_word(v.size());
  if (!v.empty()) hash.add(v.data(), v.size() * sizeof(T));
}
template <class T> void hash_buffer(Hash& hash, const AlignedBuffer<T>& v) {
  hash.add_word(v.size());
  if (!v.empty()) hash.add(v.data(), v.size() * sizeof(T));
}

void hash_motions(Hash& hash, const SceneData& scene) {
  for (const Motion& m : scene.motions) {
    hash.add_word(static_cast<uint32_t>(m.carrier)).add(m.pivot, sizeof m.pivot).add(m.axis, sizeof m.axis);
    hash.add(&m.degrees_per_second, sizeof m.degrees_per_second).add_word(m.repeat);
    hash_vector(hash, m.keys);
  }
  hash_vector(hash, scene.moving_vertices);
  hash_vector(hash, scene.moving_triangles);
}

}  // namespace

void order_vertices(const AlignedBuffer<Vertex>& vertices, Triangle& t) {
  const auto order = [&](int a, int b) {
    if (!position_less(vertices[t.vertex[b]], vertices[t.vertex[a]])) return;
    std::swap(t.vertex[a], t.vertex[b]);
    t.bits ^= kTriangleFlipped;
  };
  order(0, 1), order(1, 2), order(0, 1);
}

Result<BuildReport> build_geometry(const std::vector<SoupTriangle>& soup, SceneData& scene) {
  BuildReport report;
  scene.vertices.clear();
  scene.triangles.clear();
  scene.parts.clear();
  scene.moving_vertices.clear();
  scene.moving_triangles.clear();
  std::unordered_map<VertexKey, uint32_t, VertexKeyHash> index_of;
  index_of.reserve(soup.size());
  bool empty = true;
  for (const SoupTriangle& file_triangle : soup) {
    SoupTriangle t = file_triangle;
    if (t.material >= scene.materials.size()) return Error{"material index " + std::to_string(t.material) + " out of range"};
    if (t.motion > scene.motions.size()) return Error{"motion " + std::to_string(t.motion) + " out of range"};
    if (!repair_corners(t, report)) continue;
    Triangle triangle{{}, t.material};
    for (int i = 0; i < 3; ++i) {
      const uint32_t next = static_cast<uint32_t>(scene.vertices.size());
      const auto [it, is_new] = index_of.try_emplace({t.corner[i], t.material, t.motion}, next);
      triangle.vertex[i] = it->second;
      if (is_new) scene.vertices.push_back(t.corner[i]), add_to_runs(scene.moving_vertices, next, t.motion);
      for (int k = 0; k < 3; ++k) {
        const float p = t.corner[i].position[k];
        scene.bounds_min[k] = empty ? p : std::min(scene.bounds_min[k], p);
        scene.bounds_max[k] = empty ? p : std::max(scene.bounds_max[k], p);
      }
      empty = false;
    }
    order_vertices(scene.vertices, triangle);
    if (scene.parts.empty() || scene.parts.back().object != t.object || scene.parts.back().group != t.group)
      scene.parts.push_back({static_cast<uint32_t>(scene.triangles.size()), t.object, t.group});
    add_to_runs(scene.moving_triangles, static_cast<uint32_t>(scene.triangles.size()), t.motion);
    scene.triangles.push_back(triangle);
    if (!fits(scene.vertices.size(), scene.triangles.size())) return Error{kSceneTooLarge};
  }
  if (empty)
    for (int k = 0; k < 3; ++k) scene.bounds_min[k] = scene.bounds_max[k] = 0;
  return report;
}

bool usable_sphere(const Sphere& s) {
  for (const float x : s.center)
    if (!(std::fabs(x) + s.radius <= kMostCoordinate)) return false;
  return s.radius > 0;
}

void add_sphere(const Sphere& sphere, SceneData& scene) {
  float low[3], high[3];
  for (int k = 0; k < 3; ++k) low[k] = sphere.center[k] - sphere.radius, high[k] = sphere.center[k] + sphere.radius;
  grow_bounds(low, high, scene.triangles.empty() && scene.spheres.empty(), scene);
  scene.spheres.push_back(sphere);
}

bool set_normal(const glm::dvec3& direction, Plane& plane) {
  const double most = std::max({std::fabs(direction.x), std::fabs(direction.y), std::fabs(direction.z)});
  if (!(most > 0) || !std::isfinite(most)) return false;
  int exponent = 0;
  std::frexp(most, &exponent);
  for (int k = 0; k < 3; ++k) plane.normal[k] = static_cast<float>(std::ldexp(direction[k], 1 - exponent)) + 0.0f;
  return true;
}

void add_plane(const Plane& plane, SceneData& scene) {
  if (scene.triangles.empty() && scene.spheres.empty()) grow_bounds(plane.point, plane.point, scene.planes.empty(), scene);
  scene.planes.push_back(plane);
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
  if (!scene.motions.empty()) hash_motions(hash, scene);
  if (!scene.spheres.empty()) hash_vector(hash, scene.spheres);
  if (!scene.planes.empty()) hash.add_word(0x706c616e65), hash_vector(hash, scene.planes);  // spheres of the same bytes are others
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
