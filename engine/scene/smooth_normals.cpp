#include <cmath>
#include <cstring>
#include <unordered_map>

#include "core/hash.h"
#include "math/elementary.h"
#include "math/vec.h"
#include "scene/obj_mesh.h"

namespace spanray {
namespace {

// Comparing each face with each at a point costs the square of their number: crowded points are smoothed as a whole.
constexpr uint32_t kCrowded = 1024;

struct PointKey {
  float p[3];
  bool operator==(const PointKey& o) const { return std::memcmp(p, o.p, sizeof p) == 0; }
};
struct PointKeyHash {
  size_t operator()(const PointKey& k) const { return static_cast<size_t>(Hash().add(k.p, sizeof k.p).value()); }
};

glm::dvec3 position_of(const ObjMesh& mesh, const ObjCorner& c) {
  const float* p = &mesh.positions[3 * static_cast<size_t>(c.position)];
  return {p[0], p[1], p[2]};
}

// One corner of a face, as the point it stands on sees it.
struct Around {
  glm::dvec3 face_normal;  // unit, or 0 for a face without area
  double angle;            // at this corner, radians
  uint32_t smoothing;
};

glm::dvec3 face_normal(const ObjMesh& mesh, const ObjFace& face) {
  const ObjCorner* c = &mesh.corners[face.first_corner];
  const glm::dvec3 origin = position_of(mesh, c[0]);
  glm::dvec3 normal(0);
  for (uint32_t i = 1; i + 1 < face.corner_count; ++i)
    normal += cross3(position_of(mesh, c[i]) - origin, position_of(mesh, c[i + 1]) - origin);
  return normalize3(normal, glm::dvec3(0));
}

double corner_angle(const ObjMesh& mesh, const ObjFace& face, uint32_t i) {
  const ObjCorner* c = &mesh.corners[face.first_corner];
  const glm::dvec3 p = position_of(mesh, c[i]);
  const glm::dvec3 a = normalize3(position_of(mesh, c[(i + 1) % face.corner_count]) - p, glm::dvec3(0));
  const glm::dvec3 b = normalize3(position_of(mesh, c[(i + face.corner_count - 1) % face.corner_count]) - p, glm::dvec3(0));
  if (a == glm::dvec3(0) || b == glm::dvec3(0)) return 0;
  return acos_(dot3(a, b));
}

// Corners grouped by the bits of their position (-0 as +0): OBJ seams repeat positions under several indices.
struct Points {
  std::vector<uint32_t> of_corner;  // point of each corner
  std::vector<uint32_t> start;      // of each point's corners in `corner`, one more than points
  std::vector<uint32_t> corner;
};

Points group_by_position(const ObjMesh& mesh) {
  Points points;
  std::vector<uint32_t> of_position(mesh.positions.size() / 3);
  std::unordered_map<PointKey, uint32_t, PointKeyHash> index;
  index.reserve(of_position.size());
  for (size_t i = 0; i < of_position.size(); ++i) {
    const float* p = &mesh.positions[3 * i];
    of_position[i] =
        index.try_emplace({{p[0] + 0.0f, p[1] + 0.0f, p[2] + 0.0f}}, static_cast<uint32_t>(index.size())).first->second;
  }
  points.of_corner.resize(mesh.corners.size());
  points.start.assign(index.size() + 1, 0);
  for (size_t c = 0; c < mesh.corners.size(); ++c) {
    points.of_corner[c] = of_position[static_cast<size_t>(mesh.corners[c].position)];
    ++points.start[points.of_corner[c] + 1];
  }
  for (size_t i = 1; i < points.start.size(); ++i) points.start[i] += points.start[i - 1];
  points.corner.resize(mesh.corners.size());
  std::vector<uint32_t> next(points.start.begin(), points.start.end() - 1);
  for (size_t c = 0; c < mesh.corners.size(); ++c) points.corner[next[points.of_corner[c]]++] = static_cast<uint32_t>(c);
  return points;
}

int32_t append_normal(ObjMesh& mesh, const glm::dvec3& n) {
  for (const double v : {n.x, n.y, n.z}) mesh.normals.push_back(static_cast<float>(v));
  return static_cast<int32_t>(mesh.normals.size() / 3 - 1);
}

}  // namespace

void add_missing_normals(ObjMesh& mesh, double cos_crease, const std::string& file, Messages& messages) {
  bool missing = false;
  for (const ObjCorner& c : mesh.corners) missing = missing || c.normal < 0;
  if (!missing) return;
  const Points points = group_by_position(mesh);
  std::vector<Around> around(mesh.corners.size());
  for (const ObjFace& face : mesh.faces) {
    const glm::dvec3 normal = face_normal(mesh, face);
    for (uint32_t i = 0; i < face.corner_count; ++i)
      around[face.first_corner + i] = {normal, corner_angle(mesh, face, i), face.smoothing};
  }
  uint64_t crowded = 0;
  for (size_t c = 0; c < mesh.corners.size(); ++c) {
    if (mesh.corners[c].normal >= 0) continue;
    const Around& self = around[c];
    const uint32_t begin = points.start[points.of_corner[c]], end = points.start[points.of_corner[c] + 1];
    glm::dvec3 sum(0);
    if (end - begin > kCrowded) {
      ++crowded;
    } else if (self.smoothing != 0) {
      for (uint32_t k = begin; k < end; ++k) {
        const Around& other = around[points.corner[k]];
        if (other.smoothing == self.smoothing && dot3(other.face_normal, self.face_normal) >= cos_crease - 1e-9)
          sum += other.face_normal * other.angle;
      }
    }
    mesh.corners[c].normal = append_normal(mesh, normalize3(sum, normalize3(self.face_normal, glm::dvec3(0, 1, 0))));
  }
  if (crowded > 0)
    messages.warn(file, 0,
                  std::to_string(crowded) + " corners at points shared by more than " + std::to_string(kCrowded) +
                      " face corners have the face's own normal");
}

}  // namespace spanray
