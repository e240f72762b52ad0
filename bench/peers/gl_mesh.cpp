#include "gl_mesh.h"

#include <algorithm>
#include <utility>

#include "math/vec.h"

namespace spanray::peers {
namespace {

struct Corners { uint32_t v[3]; };

glm::dvec3 position(const Vertex& v) { return {v.position[0], v.position[1], v.position[2]}; }

glm::dvec3 face_normal(const std::vector<Vertex>& vertices, const Corners& t) {
  const glm::dvec3 a = position(vertices[t.v[0]]);
  return cross3(position(vertices[t.v[1]]) - a, position(vertices[t.v[2]]) - a);
}

// As uv_tangents of engine/shade/point-inl.h.
struct Tangents { glm::dvec3 u, v; };
Tangents find_tangents(const std::vector<Vertex>& vertices, const Corners& c) {
  const Vertex &a = vertices[c.v[0]], &b = vertices[c.v[1]], &d = vertices[c.v[2]];
  const glm::dvec3 side1 = position(b) - position(a), side2 = position(d) - position(a), n = cross3(side1, side2), none(0);
  const double du1 = b.uv[0] - a.uv[0], du2 = d.uv[0] - a.uv[0], dv1 = b.uv[1] - a.uv[1], dv2 = d.uv[1] - a.uv[1];
  if (du1 * dv2 - du2 * dv1 == 0) return {none, none};
  const glm::dvec3 g1 = cross3(side2, n), g2 = cross3(n, side1);
  return {normalize3(g1 * du1 + g2 * du2, none), normalize3(g1 * dv1 + g2 * dv2, none)};
}

Corners wind(const std::vector<Vertex>& vertices, const Triangle& t, bool by_normals) {
  Corners c = {{t.vertex[0], t.vertex[1], t.vertex[2]}};
  if ((t.bits & kTriangleFlipped) != 0) std::swap(c.v[1], c.v[2]);
  if (!by_normals) return c;
  glm::dvec3 sum(0);
  for (const uint32_t v : c.v) sum += glm::dvec3(vertices[v].normal[0], vertices[v].normal[1], vertices[v].normal[2]);
  if (dot3(face_normal(vertices, c), sum) < 0) std::swap(c.v[1], c.v[2]);
  return c;
}

// Turns the corners until the last one provokes no other triangle, and gives it the face.
class FaceGiver {
 public:
  explicit FaceGiver(GlMesh& mesh) : mesh_(mesh), taken_(mesh.vertices.size(), false) { mesh.faces.resize(mesh.vertices.size()); }
  void give(Corners& c) {
    for (int turn = 0; turn < 2 && taken_[c.v[2]]; ++turn) std::rotate(c.v, c.v + 1, c.v + 3);
    if (taken_[c.v[2]]) {
      mesh_.vertices.push_back(Vertex(mesh_.vertices[c.v[2]]));
      c.v[2] = static_cast<uint32_t>(mesh_.vertices.size() - 1);
      taken_.push_back(false), mesh_.faces.emplace_back();
    }
    taken_[c.v[2]] = true;
    const glm::dvec3 n = normalize3(face_normal(mesh_.vertices, c), glm::dvec3(0, 0, 1));
    const Tangents tangents = find_tangents(mesh_.vertices, c);
    GlFace& face = mesh_.faces[c.v[2]];
    for (int k = 0; k < 3; ++k) {
      face.normal[k] = static_cast<float>(n[k]);
      face.tangent_u[k] = static_cast<float>(tangents.u[k]), face.tangent_v[k] = static_cast<float>(tangents.v[k]);
      face.centroid[k] = (mesh_.vertices[c.v[0]].position[k] + mesh_.vertices[c.v[1]].position[k] + mesh_.vertices[c.v[2]].position[k]) / 3.0f;
    }
  }

 private:
  GlMesh& mesh_;
  std::vector<bool> taken_;
};

using TriangleList = std::vector<uint32_t>;
struct Group { uint32_t material; TriangleList triangles; };

// Neighbours of one material; where materials alternate so often that draws would cost, all of a material instead.
std::vector<Group> group_triangles(const SceneData& scene) {
  constexpr size_t kMostRunsAMaterial = 8;
  std::vector<Group> runs;
  for (size_t i = 0; i < scene.triangles.size(); ++i) {
    const uint32_t material = material_of(scene.triangles[i]);
    if (runs.empty() || runs.back().material != material) runs.push_back({material, {}});
    runs.back().triangles.push_back(static_cast<uint32_t>(i));
  }
  if (runs.size() <= kMostRunsAMaterial * scene.materials.size()) return runs;
  std::vector<Group> groups;
  std::vector<size_t> group_of(scene.materials.size(), SIZE_MAX);
  for (const Group& run : runs) {
    size_t& g = group_of[run.material];
    if (g == SIZE_MAX) g = groups.size(), groups.push_back({run.material, {}});
    groups[g].triangles.insert(groups[g].triangles.end(), run.triangles.begin(), run.triangles.end());
  }
  return groups;
}

}  // namespace

GlMesh make_gl_mesh(const SceneData& scene, bool by_normals, bool with_faces) {
  GlMesh mesh;
  mesh.vertices.assign(scene.vertices.data(), scene.vertices.data() + scene.vertices.size());
  FaceGiver* giver = nullptr;
  FaceGiver faces(mesh);
  if (with_faces) giver = &faces;
  mesh.indices.reserve(3 * scene.triangles.size());
  for (const Group& group : group_triangles(scene)) {
    const auto first = static_cast<uint32_t>(mesh.indices.size());
    for (const uint32_t i : group.triangles) {
      Corners c = wind(mesh.vertices, scene.triangles[i], by_normals);
      if (giver != nullptr) giver->give(c);
      mesh.indices.insert(mesh.indices.end(), c.v, c.v + 3);
    }
    mesh.batches.push_back({first, static_cast<uint32_t>(mesh.indices.size()) - first, group.material});
  }
  if (!with_faces) mesh.faces.clear();
  return mesh;
}

}  // namespace spanray::peers
