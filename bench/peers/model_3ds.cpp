#include "model_3ds.h"

#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>

namespace spanray::peers {
namespace {

enum Kind : uint16_t { kMain = 0x4d4d, kEditor = 0x3d3d, kObject = 0x4000, kMesh = 0x4100, kVertices = 0x4110, kFaces = 0x4120 };
constexpr size_t kHead = 6;

// A part of the file, read from its start; `whole` turns false where it ends early.
struct Bytes {
  const char *at, *end;
  bool whole = true;

  template <class T> T take() {
    T value{};
    if (static_cast<size_t>(end - at) < sizeof value) return whole = false, at = end, value;
    std::memcpy(&value, at, sizeof value);
    at += sizeof value;
    return value;
  }
  void skip_name() {
    while (at != end && *at != 0) ++at;
    take<char>();
  }
};

void read_vertices(Bytes& in, Model3ds& out) {
  out.positions.resize(in.take<uint16_t>());
  for (auto& p : out.positions)
    for (float& x : p) x = in.take<float>();
}

void read_faces(Bytes& in, Model3ds& out) {
  out.faces.resize(in.take<uint16_t>());
  for (auto& f : out.faces) {
    for (uint16_t& v : f) v = in.take<uint16_t>();
    in.take<uint16_t>();  // which edges are drawn
  }
}

// False where a chunk ends early.
bool read_chunks(Bytes in, Model3ds& out) {
  while (static_cast<size_t>(in.end - in.at) >= kHead) {
    const char* const begin = in.at;
    const auto kind = in.take<uint16_t>();
    const auto length = in.take<uint32_t>();
    if (length < kHead || length > static_cast<size_t>(in.end - begin)) return false;
    Bytes part{in.at, begin + length};
    if (kind == kObject) part.skip_name();
    if (kind == kVertices && out.positions.empty()) read_vertices(part, out);
    if (kind == kFaces && out.faces.empty()) read_faces(part, out);
    if (!part.whole) return false;
    if ((kind == kMain || kind == kEditor || kind == kObject || kind == kMesh) && !read_chunks(part, out)) return false;
    in.at = begin + length;
  }
  return true;
}

void make_normals(Model3ds& m) {
  m.normals.assign(m.positions.size(), {0, 0, 0});
  for (const auto& f : m.faces) {
    const auto &a = m.positions[f[0]], &b = m.positions[f[1]], &c = m.positions[f[2]];
    const float u[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]}, v[3] = {c[0] - a[0], c[1] - a[1], c[2] - a[2]};
    const float n[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    for (const uint16_t corner : f)
      for (size_t k = 0; k < 3; ++k) m.normals[corner][k] += n[k];
  }
  for (auto& n : m.normals) {
    const float length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    if (length > 0) n = {n[0] / length, n[1] / length, n[2] / length};
    else n = {0, 0, 1};
  }
}

}  // namespace

Result<Model3ds> read_3ds(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) return Error{"cannot be read", path};
  const std::string file{std::istreambuf_iterator<char>(in), {}};
  Model3ds model;
  if (!read_chunks({file.data(), file.data() + file.size()}, model)) return Error{"a chunk ends early; is this a 3DS file?", path};
  if (model.positions.empty() || model.faces.empty()) return Error{"holds no mesh", path};
  for (const auto& f : model.faces)
    for (const uint16_t v : f)
      if (v >= model.positions.size()) return Error{"a face names vertex " + std::to_string(v) + ", which is not there", path};
  make_normals(model);
  return model;
}

}  // namespace spanray::peers
