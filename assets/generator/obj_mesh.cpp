#include "obj_mesh.h"

#include <cmath>

namespace spanray::assets {
namespace {

int64_t power_of_ten(int n) {
  int64_t p = 1;
  for (int i = 0; i < n; ++i) p *= 10;
  return p;
}

int64_t to_fixed(double x, int decimals) { return static_cast<int64_t>(std::floor(x * static_cast<double>(power_of_ten(decimals)) + 0.5)); }

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

int ObjMesh::add(Table& table, const Key& key) {
  const auto [it, is_new] = table.index.try_emplace(key, static_cast<int>(table.keys.size()));
  if (is_new) table.keys.push_back(key);
  return it->second;
}

glm::dvec3 ObjMesh::value(const Table& table, int i, int decimals) {
  const Key& k = table.keys[static_cast<size_t>(i)];
  const double unit = static_cast<double>(power_of_ten(decimals));
  return {static_cast<double>(k[0]) / unit, static_cast<double>(k[1]) / unit, static_cast<double>(k[2]) / unit};
}

void ObjMesh::object(const std::string& name, const std::string& material) { objects_.push_back({name, material, {}}); }

void ObjMesh::face(const std::vector<Corner>& corners) {
  std::vector<Index> indices;
  for (const Corner& c : corners) {
    Key p, n;
    for (int k = 0; k < 3; ++k) p[static_cast<size_t>(k)] = to_fixed(c.position[k], kPositionDecimals);
    for (int k = 0; k < 3; ++k) n[static_cast<size_t>(k)] = to_fixed(c.normal[k], kNormalDecimals);
    const Index i = {add(positions_, p), add(uvs_, {to_fixed(c.uv.x, kUvDecimals), to_fixed(c.uv.y, kUvDecimals), 0}), add(normals_, n)};
    if (indices.empty() || indices.back()[0] != i[0]) indices.push_back(i);
  }
  while (indices.size() > 1 && indices.front()[0] == indices.back()[0]) indices.pop_back();
  if (indices.size() >= 3) objects_.back().faces.push_back(indices);
}

size_t ObjMesh::triangle_count() const {
  size_t n = 0;
  for (const Object& o : objects_) {
    for (const auto& f : o.faces) n += f.size() - 2;
  }
  return n;
}

std::string ObjMesh::text() const {
  std::string out = "# Made by assets/generator; meters, y up.\nmtllib " + mtl_file_ + "\n";
  const auto lines = [&out](const Table& table, const char* keyword, int values, int decimals) {
    for (const Key& k : table.keys) {
      out += keyword;
      for (int i = 0; i < values; ++i) out += " " + fixed_key_text(k[static_cast<size_t>(i)], decimals);
      out += "\n";
    }
  };
  lines(positions_, "v", 3, kPositionDecimals);
  lines(uvs_, "vt", 2, kUvDecimals);
  lines(normals_, "vn", 3, kNormalDecimals);
  for (const Object& o : objects_) {
    out += "o " + o.name + "\nusemtl " + o.material + "\n";
    for (const auto& f : o.faces) {
      out += "f";
      for (const Index& i : f) out += " " + std::to_string(i[0] + 1) + "/" + std::to_string(i[1] + 1) + "/" + std::to_string(i[2] + 1);
      out += "\n";
    }
  }
  return out;
}

}  // namespace spanray::assets
