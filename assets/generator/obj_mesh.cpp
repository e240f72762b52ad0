#include "obj_mesh.h"

#include <cmath>

#include "core/hash.h"

namespace spanray::assets {
namespace {

int64_t power_of_ten(int n) {
  int64_t p = 1;
  for (int i = 0; i < n; ++i) p *= 10;
  return p;
}

int64_t to_fixed(double x, int decimals, double half = 0.5) {
  return static_cast<int64_t>(std::floor(x * static_cast<double>(power_of_ten(decimals)) + half));
}

std::string fixed_key_text(int64_t key, int decimals) {
  std::string digits = std::to_string(key < 0 ? -key : key);
  const size_t places = static_cast<size_t>(decimals);
  if (digits.size() <= places) digits.insert(0, places + 1 - digits.size(), '0');
  std::string fraction = digits.substr(digits.size() - places);
  while (!fraction.empty() && fraction.back() == '0') fraction.pop_back();
  std::string text = (key < 0 ? "-" : "") + digits.substr(0, digits.size() - places);
  if (!fraction.empty()) text += "." + fraction;
  return text;
}

}  // namespace

std::string fixed_text(double x, int decimals) { return fixed_key_text(to_fixed(x, decimals), decimals); }

ObjMesh ObjMesh::counter() {
  ObjMesh mesh("");
  mesh.only_count_ = true;
  return mesh;
}

// The slot that holds `key`, or the free one where it belongs.
size_t ObjMesh::Table::slot_of(const Key& key) const {
  const auto word = [&](size_t i) { return static_cast<uint64_t>(static_cast<uint32_t>(key[i])); };
  size_t slot = mix64(mix64(word(0) << 32 | word(1)) ^ word(2));
  for (slot &= slots.size() - 1; slots[slot] != 0 && keys[slots[slot] - 1] != key;) slot = (slot + 1) & (slots.size() - 1);
  return slot;
}

void ObjMesh::Table::grow() {
  slots.assign(slots.empty() ? 1024 : 2 * slots.size(), 0);
  for (size_t i = 0; i < keys.size(); ++i) slots[slot_of(keys[i])] = static_cast<uint32_t>(i + 1);
}

int ObjMesh::Table::add(const Key& key) {
  if (2 * (keys.size() + 1) > slots.size()) grow();
  uint32_t& slot = slots[slot_of(key)];
  if (slot == 0) {
    keys.push_back(key);
    slot = static_cast<uint32_t>(keys.size());
  }
  return static_cast<int>(slot - 1);
}

glm::dvec3 ObjMesh::value(const Table& table, int i, int decimals) {
  const Key& k = table.keys[static_cast<size_t>(i)];
  const double unit = static_cast<double>(power_of_ten(decimals));
  return {static_cast<double>(k[0]) / unit, static_cast<double>(k[1]) / unit, static_cast<double>(k[2]) / unit};
}

void ObjMesh::object(const std::string& name, const std::string& material) { objects_.push_back({name, material, {}, {}}); }

void ObjMesh::face(std::span<const Corner> corners) {
  if (only_count_) {
    triangles_ += corners.size() - 2;
    return;
  }
  std::vector<Index>& out = objects_.back().corners;
  const size_t start = out.size();
  for (const Corner& c : corners) {
    Key p, n;
    for (int k = 0; k < 3; ++k) p[static_cast<size_t>(k)] = static_cast<int32_t>(to_fixed(c.position[k], decimals_.position, decimals_.half));
    for (int k = 0; k < 3; ++k) n[static_cast<size_t>(k)] = static_cast<int32_t>(to_fixed(c.normal[k], decimals_.normal));
    const Key uv = {static_cast<int32_t>(to_fixed(c.uv.x, decimals_.uv)), static_cast<int32_t>(to_fixed(c.uv.y, decimals_.uv)), 0};
    const Index i = {positions_.add(p), uvs_.add(uv), normals_.add(n)};
    if (out.size() == start || out.back()[0] != i[0]) out.push_back(i);
  }
  while (out.size() > start + 1 && out[start][0] == out.back()[0]) out.pop_back();
  if (out.size() < start + 3) return out.resize(start);
  objects_.back().ends.push_back(static_cast<uint32_t>(out.size()));
  triangles_ += out.size() - start - 2;
}

std::vector<ObjMesh::Face> ObjMesh::Object::faces() const {
  std::vector<Face> faces;
  size_t start = 0;
  for (const uint32_t end : ends) {
    faces.push_back(Face(corners).subspan(start, end - start));
    start = end;
  }
  return faces;
}

void ObjMesh::write(const std::function<bool(std::string_view)>& sink) const {
  std::string out = "# Made by assets/generator; meters, y up.\nmtllib " + mtl_file_ + "\n";
  bool going = true;
  const auto flush = [&](size_t most) {
    if (going && out.size() > most) going = sink(out), out.clear();
  };
  const auto lines = [&](const Table& table, const char* keyword, size_t values, int decimals) {
    for (const Key& k : table.keys) {
      out += keyword;
      for (size_t i = 0; i < values; ++i) out += " " + fixed_key_text(k[i], decimals);
      out += "\n";
      flush(1 << 20);
    }
  };
  lines(positions_, "v", 3, decimals_.position);
  lines(uvs_, "vt", 2, decimals_.uv);
  lines(normals_, "vn", 3, decimals_.normal);
  for (const Object& o : objects_) {
    out += "o " + o.name + "\nusemtl " + o.material + "\n";
    for (const Face& f : o.faces()) {
      out += "f";
      for (const Index& i : f) out += " " + std::to_string(i[0] + 1) + "/" + std::to_string(i[1] + 1) + "/" + std::to_string(i[2] + 1);
      out += "\n";
      flush(1 << 20);
    }
  }
  flush(0);
}

std::string ObjMesh::text() const {
  std::string all;
  write([&](std::string_view piece) { all += piece; return true; });
  return all;
}

}  // namespace spanray::assets
