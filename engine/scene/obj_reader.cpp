// OBJ text -> ObjMesh. tinyobjloader reads the statements; a guard in front of it vets every line, because tinyobjloader
// takes words for the number 0, wraps large indices and converts decimals through std::pow, whose bits depend on the C library.
#include "scene/obj_mesh.h"

#include <cctype>
#include <fstream>
#include <istream>
#include <limits>
#include <map>
#include <set>
#include <sstream>
#include <streambuf>
#include <unordered_map>

#include "core/counted.h"

// This translation unit is the only one that knows tinyobjloader.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wfloat-conversion"
#define TINYOBJLOADER_IMPLEMENTATION
#include <tiny_obj_loader.h>
#pragma GCC diagnostic pop

namespace spanray {
namespace {

// Statements that are known and say nothing about surfaces of polygons.
bool is_ignored_statement(std::string_view key) {
  for (const char* known :
       {"l", "p", "mg", "vp", "lod", "shadow_obj", "trace_obj", "usemap", "maplib", "bevel", "c_interp", "d_interp"})
    if (key == known) return true;
  return false;
}

bool digits_and_signs(std::string_view line) {
  for (const char c : line)
    if (!((c >= '0' && c <= '9') || c == '/' || c == '-' || c == '+' || is_space(c))) return false;
  return true;
}

// Hands an OBJ text to an istream line by line: only statements that build polygons, and only when every word of them is right.
class Guard : public std::streambuf {
 public:
  Guard(std::string_view text, const std::string& file, ObjMesh& mesh, Messages& messages, const Progress& progress)
      : lines_(text), bytes_(static_cast<double>(text.size())), file_(file), mesh_(mesh), messages_(messages), progress_(progress) {}
  int line() const { return lines_.line_number(); }
  const float* numbers() const { return numbers_; }  // of the v, vn or vt line that was handed out last
  uint32_t smoothing() const { return smoothing_; }
  uint32_t object() const { return object_; }
  uint32_t group() const { return group_; }
  bool failed() const { return failed_; }
  const Error& error() const { return error_; }
  int fail(const std::string& message) {
    if (!failed_) error_ = Error{message, file_, line()};
    failed_ = true;
    return traits_type::eof();
  }
  // What the whole text lacked.
  void finish() {
    if (unknown_ > 0 && statements_ > 0)
      messages_.warn(file_, unknown_line_,
                     counted(unknown_, "line with an unknown statement", "lines with unknown statements") +
                         " ignored, first " + unknown_word_);
    if (unknown_ > 0 && statements_ == 0 && !failed_) {
      failed_ = true;
      error_ = Error{"not a Wavefront OBJ file: unknown statement " + unknown_word_, file_, unknown_line_};
    }
    if (short_faces_ > 0)
      messages_.warn(file_, short_line_, counted(short_faces_, "face", "faces") + " with fewer than 3 corners ignored");
  }

 protected:
  int_type underflow() override {
    std::string_view line;
    while (!failed_ && lines_.next(&line)) {
      bytes_read_ += static_cast<double>(line.size() + 1);
      if (++lines_read_ % kLinesPerReport == 0 && !progress_("reading the mesh", bytes_read_ / bytes_)) fail(kStopMessage);
      if (failed_ || !vet(line)) continue;
      if (failed_) break;
      current_.push_back('\n');
      setg(current_.data(), current_.data(), current_.data() + current_.size());
      return traits_type::to_int_type(current_[0]);
    }
    return traits_type::eof();
  }

 private:
  // True if the line (now in current_) is for tinyobjloader.
  bool vet(std::string_view rest) {
    if (rest.find('\0') != std::string_view::npos) return fail("binary data (NUL byte) in an OBJ file"), true;
    const std::string_view key = next_word(rest);
    if (key.empty() || key.front() == '#') return false;
    ++statements_;
    if (key == "v") return vet_numbers("v ", rest, 3, 7);
    if (key == "vn") return vet_numbers("vn ", rest, 3, 3);
    if (key == "vt") return vet_numbers("vt ", rest, 1, 3);
    if (key == "f" || key == "fo") return vet_face(rest);
    if (key == "usemtl") return current_.assign("usemtl ").append(trim(rest)), true;
    if (key == "mtllib") return mesh_.libraries.push_back({std::string(trim(rest)), line()}), false;
    if (key == "s") return vet_smoothing(rest), false;
    if (key == "o") return object_ = part_name(rest), false;
    if (key == "g") return group_ = part_name(rest), false;
    if (!is_ignored_statement(key)) note_unknown(key);
    return false;
  }

  uint32_t part_name(std::string_view rest) {
    const auto [it, is_new] = part_index_.try_emplace(std::string(trim(rest)), static_cast<uint32_t>(mesh_.part_names.size()));
    if (is_new) mesh_.part_names.push_back(it->first);
    return it->second;
  }

  void note_unknown(std::string_view key) {
    --statements_;
    if (unknown_++ > 0) return;
    unknown_line_ = line();
    unknown_word_ = quoted(key);
  }

  bool vet_numbers(const char* key, std::string_view rest, int least, int most) {
    current_.assign(key);
    rest = without_comment(rest);
    int count = 0;
    for (float& n : numbers_) n = 0;
    for (std::string_view word; !(word = next_word(rest)).empty();) {
      float value = 0;
      if (!parse_float(word, &value)) return fail(quoted(word) + " is not a number"), true;
      if (count < 3) numbers_[count] = value;
      ++count;
    }
    if (count < least)
      return fail(std::string(trim(key)) + " needs " + std::to_string(least) + " numbers, found " + std::to_string(count)),
             true;
    if (count > most)
      return fail(std::string(trim(key)) + " takes at most " + std::to_string(most) + " numbers, found " +
                  std::to_string(count)),
             true;
    current_.append("0 0 0");  // the values are numbers_
    return true;
  }

  bool vet_face(std::string_view rest) {
    current_.assign("f");
    rest = without_comment(rest);
    int corners = 0;
    for (std::string_view word; !(word = next_word(rest)).empty(); ++corners) {
      if (!vet_corner(word)) return true;
      while (word.back() == '/') word.remove_suffix(1);  // tinyobjloader would read on into the next corner
      current_.append(" ").append(word);
    }
    if (corners < 3) {
      if (short_faces_++ == 0) short_line_ = line();
      return false;
    }
    return true;
  }
  // v, v/vt, v//vn or v/vt/vn.
  bool vet_corner(std::string_view word) {
    const std::string_view whole = word;
    for (int part = 0; part < 3; ++part) {
      const size_t slash = word.find('/');
      const std::string_view number = word.substr(0, slash);
      int32_t index = 0;
      const bool absent = number.empty() && part > 0;
      if (!absent && (!digits_and_signs(number) || !parse_int(number, &index)))
        return fail("face corner " + quoted(whole) +
                    " is not of the form v, v/vt, v//vn or v/vt/vn, or its index is too large"),
               false;
      if (!absent && index == 0) return fail("face corner " + quoted(whole) + " has index 0: OBJ indices start at 1"), false;
      if (slash == std::string_view::npos) return true;
      word.remove_prefix(slash + 1);
    }
    return fail("face corner " + quoted(whole) + " has more than three indices"), false;
  }

  void vet_smoothing(std::string_view rest) {
    rest = without_comment(rest);
    const std::string_view word = next_word(rest);
    int32_t group = 0;
    if (word == "off" || word.empty())
      smoothing_ = 0;
    else if (parse_int(word, &group) && group >= 0)
      smoothing_ = static_cast<uint32_t>(group);
    else if (word == "on")
      smoothing_ = 1;
    else
      messages_.warn(file_, line(), "smoothing group " + quoted(word) + " is not a number; ignored");
  }

  static constexpr uint64_t kLinesPerReport = 8192;

  LineReader lines_;
  double bytes_, bytes_read_ = 0;
  uint64_t lines_read_ = 0;
  const std::string& file_;
  ObjMesh& mesh_;
  Messages& messages_;
  const Progress& progress_;
  std::string current_;
  float numbers_[3] = {};
  uint32_t smoothing_ = kSmoothingNotGiven, object_ = 0, group_ = 0;
  std::unordered_map<std::string, uint32_t> part_index_ = {{"", 0}};
  uint64_t statements_ = 0, unknown_ = 0, short_faces_ = 0;
  int unknown_line_ = 0, short_line_ = 0;
  std::string unknown_word_;
  bool failed_ = false;
  Error error_;
};

// tinyobjloader's callbacks: one statement each.
struct Builder {
  ObjMesh& mesh;
  Guard& guard;
  std::unordered_map<std::string, uint32_t> material_index = {{"", 0}};
  uint32_t material = 0;

  static Builder& of(void* self) { return *static_cast<Builder*>(self); }
  static void on_position(void* self, float, float, float, float) {
    const float* n = of(self).guard.numbers();
    of(self).mesh.positions.insert(of(self).mesh.positions.end(), n, n + 3);
  }
  static void on_normal(void* self, float, float, float) {
    const float* n = of(self).guard.numbers();
    of(self).mesh.normals.insert(of(self).mesh.normals.end(), n, n + 3);
  }
  static void on_uv(void* self, float, float, float) {
    const float* n = of(self).guard.numbers();
    of(self).mesh.uvs.insert(of(self).mesh.uvs.end(), n, n + 2);
  }
  static void on_material(void* self, const char* name, int) {
    Builder& b = of(self);
    const auto [it, is_new] = b.material_index.try_emplace(name, static_cast<uint32_t>(b.mesh.used_materials.size()));
    if (is_new) b.mesh.used_materials.push_back({name, b.guard.line()});
    b.material = it->second;
  }
  static void on_face(void* self, tinyobj::index_t* indices, int count) {
    Builder& b = of(self);
    const uint32_t first = static_cast<uint32_t>(b.mesh.corners.size());
    b.mesh.faces.push_back(
        {first, static_cast<uint32_t>(count), b.material, b.guard.smoothing(), b.guard.line(), b.guard.object(), b.guard.group()});
    for (int i = 0; i < count; ++i)
      b.mesh.corners.push_back({b.resolve(indices[i].vertex_index, b.mesh.positions.size() / 3, "vertex"),
                                b.resolve(indices[i].texcoord_index, b.mesh.uvs.size() / 2, "texture coordinate"),
                                b.resolve(indices[i].normal_index, b.mesh.normals.size() / 3, "normal")});
  }
  // 0-based; -1 where absent. Positive indices may point ahead, so they are checked at the end of the file.
  int32_t resolve(int index, size_t defined, const char* what) {
    if (index >= 0) return index - 1;
    const int64_t resolved = static_cast<int64_t>(defined) + index;
    if (resolved < 0)
      guard.fail(std::string(what) + " index " + std::to_string(index) + " out of range: only " + std::to_string(defined) +
                 " defined so far");
    return static_cast<int32_t>(resolved);
  }
};

Result<void> check_indices(const ObjMesh& mesh, const std::string& file) {
  const auto out_of_range = [&](const ObjFace& face, const char* what, int32_t index, size_t count) {
    return Error{
        std::string(what) + " index " + std::to_string(index + 1) + " out of range: the file has " + std::to_string(count),
        file, face.line};
  };
  const size_t positions = mesh.positions.size() / 3, uvs = mesh.uvs.size() / 2, normals = mesh.normals.size() / 3;
  for (const ObjFace& face : mesh.faces)
    for (uint32_t i = 0; i < face.corner_count; ++i) {
      const ObjCorner& c = mesh.corners[face.first_corner + i];
      if (c.position < 0 || static_cast<size_t>(c.position) >= positions)
        return out_of_range(face, "vertex", c.position, positions);
      if (c.uv < -1 || (c.uv >= 0 && static_cast<size_t>(c.uv) >= uvs))
        return out_of_range(face, "texture coordinate", c.uv, uvs);
      if (c.normal < -1 || (c.normal >= 0 && static_cast<size_t>(c.normal) >= normals))
        return out_of_range(face, "normal", c.normal, normals);
    }
  return {};
}

}  // namespace

Result<ObjMesh> read_obj(std::string_view text, const std::string& file, Messages& messages, const Progress& progress) {
  ObjMesh mesh;
  mesh.used_materials.push_back({"", 0});
  Guard guard(text, file, mesh, messages, progress);
  Builder builder{mesh, guard};
  std::istream stream(&guard);
  stream.exceptions(std::ios::badbit);  // or an exception inside the guard would look like the end of the file
  tinyobj::callback_t callbacks;
  callbacks.vertex_cb = Builder::on_position;
  callbacks.normal_cb = Builder::on_normal;
  callbacks.texcoord_cb = Builder::on_uv;
  callbacks.usemtl_cb = Builder::on_material;
  callbacks.index_cb = Builder::on_face;
  std::string warning, problem;
  const bool read = tinyobj::LoadObjWithCallback(stream, callbacks, &builder, nullptr, &warning, &problem);
  guard.finish();
  if (guard.failed()) return guard.error();
  if (!read) return Error{"cannot be read: " + problem, file};
  if (const Result<void> checked = check_indices(mesh, file); !checked) return checked.error();
  return mesh;
}

}  // namespace spanray
