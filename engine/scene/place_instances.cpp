// Instances written out: every copy has vertices and triangles of its own.
#include <algorithm>
#include <unordered_map>

#include "math/vec.h"
#include "scene/instance_list.h"
#include "scene/part_names.h"
#include "scene/text_input.h"

namespace spanray {
namespace {

// A part by itself.
Result<BuildReport> build_part(const std::vector<SoupTriangle>& soup, const PartFilter& filter, const SceneData& materials, SceneData& part) {
  std::vector<SoupTriangle> own;
  std::copy_if(soup.begin(), soup.end(), std::back_inserter(own), [&](const SoupTriangle& t) { return filter.has(t.object, t.group); });
  part.materials = materials.materials;  // their number is checked
  return build_geometry(own, part);
}

InstancedPart corners_of(const SceneData& part) {
  InstancedPart out;
  out.corners.reserve(9 * part.triangles.size());
  for (const Triangle& t : part.triangles)
    for (const uint32_t v : t.vertex) out.corners.insert(out.corners.end(), part.vertices[v].position, part.vertices[v].position + 3);
  return out;
}

float mapped(const double* row, const float* v, double offset) {
  return static_cast<float>((row[0] * v[0] + row[1] * v[1] + row[2] * v[2]) + offset) + 0.0f;  // never -0: equal positions have equal bits
}

// The inverse transpose times the determinant's magnitude: cofactors, with the sign of a map that keeps hands.
class NormalMap {
 public:
  NormalMap(const AffineMap& map, bool mirrored) {
    for (int i = 0; i < 3; ++i) {
      const double *const a = map.linear[(i + 1) % 3], *const b = map.linear[(i + 2) % 3];
      for (int k = 0; k < 3; ++k) {
        const double cofactor = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
        row_[i][k] = mirrored ? -cofactor : cofactor;
      }
    }
  }
  void apply(const float* from, float* to) const {
    const glm::dvec3 up(from[0], from[1], from[2]);
    glm::dvec3 n;
    for (int i = 0; i < 3; ++i) n[i] = row_[i][0] * up.x + row_[i][1] * up.y + row_[i][2] * up.z;
    store_unit(n, up, to);
    // As a file that holds the rounded normal would have it: the loader makes normals unit length once more.
    store_unit({to[0], to[1], to[2]}, up, to);
  }

 private:
  static void store_unit(const glm::dvec3& n, const glm::dvec3& fallback, float* to) {
    const glm::dvec3 unit = normalize3(n, fallback);
    for (int i = 0; i < 3; ++i) to[i] = static_cast<float>(unit[i]) + 0.0f;
  }

  double row_[3][3];
};

// Appends one copy of a part. False if it reaches too far out.
bool place(const SceneData& part, const WantedInstance& wanted, uint32_t part_index, SceneData& scene) {
  const AffineMap& map = wanted.world_from_part;
  const NormalMap normals(map, wanted.mirrored);
  const uint32_t first_vertex = static_cast<uint32_t>(scene.vertices.size()), first = static_cast<uint32_t>(scene.triangles.size());
  for (const Vertex& from : part.vertices) {
    Vertex to = from;
    for (int k = 0; k < 3; ++k) to.position[k] = mapped(map.linear[k], from.position, map.offset[k]);
    if (!usable_position(to.position)) return false;
    normals.apply(from.normal, to.normal);
    const bool alone = scene.vertices.empty();
    for (int k = 0; k < 3; ++k) {
      scene.bounds_min[k] = alone ? to.position[k] : std::min(scene.bounds_min[k], to.position[k]);
      scene.bounds_max[k] = alone ? to.position[k] : std::max(scene.bounds_max[k], to.position[k]);
    }
    scene.vertices.push_back(to);
  }
  for (const Triangle& from : part.triangles) {
    Triangle to = from;
    for (uint32_t& v : to.vertex) v += first_vertex;
    if (wanted.mirrored) to.bits ^= kTriangleFlipped;
    order_vertices(scene.vertices, to);
    scene.triangles.push_back(to);
  }
  for (const ScenePart& p : part.parts)
    if (scene.parts.empty() || scene.parts.back().object != p.object || scene.parts.back().group != p.group)
      scene.parts.push_back({p.first + first, p.object, p.group});
  scene.instances.push_back({first, static_cast<uint32_t>(part.triangles.size()), part_index, map});
  return true;
}

void add(BuildReport& to, const BuildReport& more) {
  to.dropped_unusable += more.dropped_unusable, to.repaired_normals += more.repaired_normals;
  to.repaired_uvs += more.repaired_uvs, to.zero_area += more.zero_area;
}

// The parts of a list, each once, and which of them each instance is of.
struct Parts {
  std::vector<SceneData> built;
  std::vector<uint32_t> of_instance;
};

// Nothing is placed unless all of it fits.
Result<void> build_parts(const std::vector<SoupTriangle>& soup, const InstanceList& list, const std::vector<std::string>& part_names,
                         SceneData& scene, Parts& parts) {
  std::unordered_map<std::string, uint32_t> index_of;
  uint64_t vertices = scene.vertices.size(), triangles = scene.triangles.size();
  for (const WantedInstance& wanted : list.instances) {
    const auto [it, is_new] = index_of.try_emplace(wanted.part, static_cast<uint32_t>(parts.built.size()));
    if (is_new) {
      if (const auto built = build_part(soup, PartFilter(part_names, wanted.part), scene, parts.built.emplace_back()); !built) return built.error();
      scene.instanced_parts.push_back(corners_of(parts.built.back()));
    }
    vertices += parts.built[it->second].vertices.size(), triangles += parts.built[it->second].triangles.size();
    if (!fits(vertices, triangles))
      return Error{"with this instance of " + quoted(wanted.part) + ", " + kSceneTooLarge, list.file, wanted.line};
    parts.of_instance.push_back(it->second);
  }
  scene.vertices.reserve(vertices), scene.triangles.reserve(triangles);
  return {};
}

// The triangles of templates go to `left_out`.
void sort_out_templates(const std::vector<SoupTriangle>& soup, const InstanceList& list, const std::vector<std::string>& part_names,
                        std::vector<SoupTriangle>& standing, std::vector<SoupTriangle>& left_out) {
  std::vector<PartFilter> templates;
  for (const TemplatePart& t : list.templates) templates.emplace_back(part_names, t.part);
  for (const SoupTriangle& t : soup) {
    const bool out = std::any_of(templates.begin(), templates.end(), [&](const PartFilter& f) { return f.has(t.object, t.group); });
    (out ? left_out : standing).push_back(t);
  }
}

}  // namespace

Result<BuildReport> build_instanced_geometry(const std::vector<SoupTriangle>& soup, const InstanceList& list,
                                             const std::vector<std::string>& part_names, SceneData& scene) {
  if (list.instances.empty()) return build_geometry(soup, scene);
  std::vector<SoupTriangle> standing, left_out;
  sort_out_templates(soup, list, part_names, standing, left_out);
  SceneData unseen;
  unseen.materials = scene.materials;
  const Result<BuildReport> report_unseen = build_geometry(left_out, unseen);  // for what it reports
  if (!report_unseen) return report_unseen.error();
  Result<BuildReport> report = build_geometry(standing, scene);
  if (!report) return report;
  add(report.value(), report_unseen.value());

  Parts parts;
  if (const Result<void> built = build_parts(soup, list, part_names, scene, parts); !built) return built.error();
  for (size_t i = 0; i < list.instances.size(); ++i) {
    const WantedInstance& wanted = list.instances[i];
    if (!place(parts.built[parts.of_instance[i]], wanted, parts.of_instance[i], scene))
      return Error{"this instance of " + quoted(wanted.part) + " reaches farther out than 1e30", list.file, wanted.line};
  }
  return report;
}

}  // namespace spanray
