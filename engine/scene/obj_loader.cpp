#include "scene/obj_loader.h"

#include <cmath>
#include <unordered_map>

#include "core/counted.h"
#include "math/elementary.h"
#include "scene/height_rows.h"
#include "scene/moving_parts.h"
#include "scene/mtl_library.h"
#include "scene/obj_mesh.h"
#include "scene/path_finder.h"
#include "scene/progress.h"
#include "scene/scene_builder.h"
#include "scene/texture_loader.h"

namespace spanray {
namespace {

constexpr uint64_t kMostObjBytes = (uint64_t{1} << 31) - 1;
constexpr uint64_t kMostMtlBytes = uint64_t{1} << 26;
constexpr size_t kMostLibraries = 256;
constexpr size_t kFacesPerReport = 16384;
constexpr int64_t kTriangulationBudget = 50'000'000;  // point tests, about a quarter of a second

using MaterialIndex = std::unordered_map<std::string, uint32_t>;

int32_t* slot_of(Material& m, MtlMap map) {
  int32_t* const slots[] = {&m.map_ambient,  &m.map_diffuse, &m.map_specular, &m.map_shininess,
                            &m.map_emission, &m.map_opacity, &m.map_bump,     &m.map_normal};
  return slots[static_cast<int>(map)];
}

class MaterialLoader {
 public:
  MaterialLoader(const std::string& obj, const LoadOptions& options, SceneData& scene, Messages& messages, const Progress& progress)
      : obj_(obj),
        progress_(progress),
        folder_(folder_of(obj)),
        finder_(folder_, options.allow_outside),
        textures_(finder_, scene, messages),
        scene_(scene),
        messages_(messages) {}

  // One line of mtllib: one file name, or several without spaces.
  void library(const ObjNamed& line) {
    std::string_view name = line.name;
    if (name.size() > 1 && name.front() == '"' && name.back() == '"') name = name.substr(1, name.size() - 2);
    Result<std::string> whole = finder_.find(folder_, name);
    if (whole) return file(whole.value());
    bool several = false;
    for (std::string_view rest = name, word; !(word = next_word(rest)).empty() && word != name; several = true) {
      const Result<std::string> path = finder_.find(folder_, word);
      if (path)
        file(path.value());
      else
        messages_.warn(obj_, line.line, "material library: " + path.error().message);
    }
    if (!several) messages_.warn(obj_, line.line, "material library: " + whole.error().message);
  }

  // Index of a material by its name; the default one where it is not defined.
  uint32_t find(const ObjNamed& used) {
    const auto it = index_.find(used.name);
    if (it != index_.end()) return it->second;
    if (!used.name.empty())
      messages_.warn(obj_, used.line,
                     "material " + quoted(used.name) + " is not defined; the default material takes its place");
    if (default_ < 0) {
      default_ = static_cast<int64_t>(scene_.materials.size());
      scene_.materials.emplace_back();
      scene_.material_names.emplace_back("(default)");
    }
    return static_cast<uint32_t>(default_);
  }

 private:
  void file(const std::string& path) {
    if (!read_.try_emplace(path, true).second) return;
    const Result<std::string> text = read_text_file(path, kMostMtlBytes);
    if (!text) return messages_.warn(path, 0, "material library: " + text.error().message);
    const std::vector<MtlMaterial> materials = read_mtl(text.value(), path, messages_);
    for (size_t i = 0; i < materials.size(); ++i) {
      if (!progress_("decoding textures", static_cast<double>(i) / static_cast<double>(materials.size()))) return;
      add(materials[i], path);
    }
  }

  void add(const MtlMaterial& mtl, const std::string& path) {
    if (!index_.try_emplace(mtl.name, static_cast<uint32_t>(scene_.materials.size())).second)
      return messages_.warn(path, mtl.line, "material " + quoted(mtl.name) + " is defined twice; the first one is taken");
    Material m = convert_material(mtl, path, messages_);
    for (int i = 0; i < static_cast<int>(MtlMap::kCount); ++i) {
      const MtlMap map = static_cast<MtlMap>(i);
      if (mtl[map].line > 0) *slot_of(m, map) = textures_.use(map, mtl[map], path, folder_);
    }
    settle_textures(m);
    scene_.materials.push_back(m);
    scene_.material_names.push_back(mtl.name);
  }

  // What a texture means depends on what was loaded.
  void settle_textures(Material& m) const {
    const auto use = [&](int32_t index) { return scene_.texture_uses[static_cast<size_t>(index)]; };
    if (m.map_ambient >= 0 && m.map_diffuse >= 0 && use(m.map_ambient) == use(m.map_diffuse)) m.map_ambient = -1;
    if (m.illum == 0 && m.map_emission < 0) m.map_emission = m.map_diffuse;
    if (m.map_opacity < 0 && m.transparency == static_cast<int32_t>(MaterialTransparency::kMask))
      m.transparency = static_cast<int32_t>(MaterialTransparency::kOpaque);
  }

  const std::string& obj_;
  const Progress& progress_;
  std::string folder_;
  PathFinder finder_;
  TextureLoader textures_;
  SceneData& scene_;
  Messages& messages_;
  MaterialIndex index_;
  std::unordered_map<std::string, bool> read_;
  int64_t default_ = -1;
};

Vertex vertex_of(const ObjMesh& mesh, const ObjCorner& c) {
  Vertex v{};
  for (int k = 0; k < 3; ++k) v.position[k] = mesh.positions[3 * static_cast<size_t>(c.position) + static_cast<size_t>(k)];
  for (int k = 0; k < 3 && c.normal >= 0; ++k)
    v.normal[k] = mesh.normals[3 * static_cast<size_t>(c.normal) + static_cast<size_t>(k)];
  for (int k = 0; k < 2 && c.uv >= 0; ++k) v.uv[k] = mesh.uvs[2 * static_cast<size_t>(c.uv) + static_cast<size_t>(k)];
  return v;
}

bool has_usable_positions(const ObjMesh& mesh, const ObjFace& face) {
  for (uint32_t i = 0; i < face.corner_count; ++i) {
    const float* p = &mesh.positions[3 * static_cast<size_t>(mesh.corners[face.first_corner + i].position)];
    if (!usable_position(p)) return false;
  }
  return true;
}

struct Soup {
  std::vector<SoupTriangle> triangles;
  int first_unusable_line = 0;
};

Soup make_soup(const ObjMesh& mesh, const std::vector<uint32_t>& material_of_used, const std::vector<uint32_t>& moving, const std::string& file,
               Messages& messages, const Progress& progress) {
  Soup soup;
  soup.triangles.reserve(mesh.faces.size());
  int64_t budget = kTriangulationBudget;
  std::vector<uint32_t> corners;
  for (const ObjFace& face : mesh.faces) {
    const size_t index = static_cast<size_t>(&face - mesh.faces.data());
    if (index % kFacesPerReport == 0 && !progress("cutting polygons", static_cast<double>(index) / static_cast<double>(mesh.faces.size())))
      break;
    if (soup.first_unusable_line == 0 && !has_usable_positions(mesh, face)) soup.first_unusable_line = face.line;
    corners.clear();
    triangulate(mesh.positions.data(), &mesh.corners[face.first_corner], face.corner_count, budget, corners);
    for (size_t i = 0; i + 2 < corners.size(); i += 3) {
      SoupTriangle t;
      for (size_t k = 0; k < 3; ++k) t.corner[k] = vertex_of(mesh, mesh.corners[face.first_corner + corners[i + k]]);
      t.material = material_of_used[face.material];
      t.object = face.object, t.group = face.group;
      t.motion = moving.empty() ? 0 : moving[index];
      soup.triangles.push_back(t);
    }
  }
  if (budget <= 0) messages.warn(file, 0, "many large concave polygons: the last of them were cut as if they were convex");
  return soup;
}

void report(const BuildReport& r, int unusable_line, const std::string& file, Messages& messages) {
  const auto say = [&](uint64_t count, int line, const char* one, const char* many, const std::string& what) {
    if (count > 0) messages.warn(file, line, counted(count, one, many) + what);
  };
  say(r.dropped_unusable, unusable_line, "triangle", "triangles", " dropped: a vertex is NaN, infinite or farther out than 1e30");
  say(r.repaired_normals, 0, "corner", "corners", " with a zero or non-finite normal: the face's normal is taken");
  say(r.repaired_uvs, 0, "corner", "corners", " with non-finite texture coordinates: (0, 0) is taken");
  say(r.zero_area, 0, "triangle has", "triangles have", " no area");
}

}  // namespace

Result<void> load_obj(const std::string& path, const LoadOptions& options, const MovingParts& moving, const InstanceList& instances, SceneData& scene,
                      Messages& messages) {
  const Progress progress(options.progress);
  const Error stopped{kStopMessage, path};
  if (!progress("opening", 0)) return stopped;
  const Result<std::string> text = read_text_file(path, kMostObjBytes);
  if (!text) return text.error();
  Result<ObjMesh> read = read_obj(text.value(), path, messages, progress);
  if (!read) return read.error();
  ObjMesh& mesh = read.value();
  if (mesh.libraries.size() > kMostLibraries)
    return Error{"more than " + std::to_string(kMostLibraries) + " mtllib statements", path,
                 mesh.libraries[kMostLibraries].line};
  const Result<std::vector<uint32_t>> motion_of = find_moving_faces(mesh, moving);
  if (!motion_of) return motion_of.error();
  if (const Result<void> checked = check_instances(mesh, motion_of.value(), instances); !checked) return checked;
  scene.motions = moving.motions;

  MaterialLoader materials(path, options, scene, messages, progress);
  for (const ObjNamed& library : mesh.libraries) materials.library(library);
  std::vector<uint32_t> material_of_used(mesh.used_materials.size(), 0);
  std::vector<bool> has_faces(mesh.used_materials.size(), false);
  for (const ObjFace& face : mesh.faces) has_faces[face.material] = true;
  for (size_t i = 0; i < mesh.used_materials.size(); ++i)
    if (has_faces[i]) material_of_used[i] = materials.find(mesh.used_materials[i]);
  if (scene.materials.empty()) materials.find({"", 0});
  make_height_rows(scene);

  if (!progress("smoothing normals", 0)) return stopped;
  double sine = 0, cosine = 0;
  sin_cos(options.crease_angle_degrees * (kPi / 180), &sine, &cosine);
  add_missing_normals(mesh, cosine, path, messages);
  const Soup soup = make_soup(mesh, material_of_used, motion_of.value(), path, messages, progress);
  if (!progress("merging vertices", 0)) return stopped;
  const Result<BuildReport> built = build_instanced_geometry(soup.triangles, instances, mesh.part_names, scene);
  if (!built) return built.error().file.empty() ? Error{built.error().message, path} : built.error();
  scene.part_names = std::move(mesh.part_names);
  report(built.value(), soup.first_unusable_line, path, messages);
  return {};
}

}  // namespace spanray
