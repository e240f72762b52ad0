// What an OBJ file says, before it becomes a scene: polygons with checked indices.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "scene/progress.h"
#include "scene/scene_builder.h"
#include "scene/text_input.h"
#include "spanray/result.h"

namespace spanray {

struct ObjCorner {
  int32_t position, uv, normal;
};  // indices into the arrays of ObjMesh; uv and normal -1: not given

inline constexpr uint32_t kSmoothingNotGiven = 0xffffffffu;
struct ObjFace {
  uint32_t first_corner, corner_count;  // at least 3
  uint32_t material;                    // index into used_materials
  uint32_t smoothing;                   // group; 0: off; kSmoothingNotGiven: before any `s`
  int32_t line;
  uint32_t object, group;               // indices into part_names
};

struct ObjNamed {
  std::string name;
  int line;  // where it was named first
};

struct ObjMesh {
  std::vector<float> positions, uvs, normals;  // 3, 2, 3 a vertex; may hold NaN and infinities
  std::vector<ObjCorner> corners;
  std::vector<ObjFace> faces;
  std::vector<ObjNamed> used_materials;  // [0] is "": faces before any usemtl
  std::vector<std::string> part_names = {""};  // of `o` and `g`, the rest of the line, each once
  std::vector<ObjNamed> libraries;       // mtllib, the rest of the line
};

// Reads OBJ text. Every index of the result is in range. Errors name `file` and the line: an index out of range or zero, a word
// that is no number, too few coordinates, binary data, a text without any OBJ statement.
Result<ObjMesh> read_obj(std::string_view text, const std::string& file, Messages& messages, const Progress& progress = {});

// Unit normals of all corners that have none, as indices into mesh.normals (appended; never NaN but where positions are): the
// mean of the faces around a position weighted by their angles there (Thuermer and Wuethrich 1998, "Computing Vertex Normals
// from Polygonal Facets"), over faces of the same smoothing group that meet this one's normal at most at the crease angle. `s
// off` gives the face normal. cos_crease: cosine of the angle.
void add_missing_normals(ObjMesh& mesh, double cos_crease, const std::string& file, Messages& messages);

// Cuts a polygon into triangles by ear clipping; convex ones become a fan around corner 0. positions: 3 floats a vertex.
// Appends corner numbers, 3 a triangle, corner_count - 2 triangles or fewer (repeated positions are skipped). A polygon with
// non-finite positions becomes a fan. budget: point tests left for concave polygons of this file; at 0 they become fans.
void triangulate(const float* positions, const ObjCorner* corners, uint32_t corner_count, int64_t& budget,
                 std::vector<uint32_t>& out);

}  // namespace spanray
