// A mesh on its way into an OBJ file: faces with shared positions, normals and texture coordinates.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "math/vec.h"

namespace spanray::assets {

struct Corner {
  glm::dvec3 position;  // meters
  glm::dvec3 normal;    // unit length
  glm::dvec2 uv;
};

// Prints x rounded to `decimals` (<= 9) fixed decimals, without trailing zeros; no locale, no printf. |x| < 1e9.
std::string fixed_text(double x, int decimals);

class ObjMesh {
 public:
  explicit ObjMesh(std::string mtl_file) : mtl_file_(std::move(mtl_file)) {}
  // Starts an object; following faces have this material.
  void object(const std::string& name, const std::string& material);
  // Corners counter-clockwise seen from the front. Equal neighbors collapse; a face left with fewer than 3 corners is dropped.
  void face(const std::vector<Corner>& corners);
  std::string text() const;

  // Index triples (position, uv, normal) of each face, 0-based, and the values as written.
  using Index = std::array<int, 3>;
  struct Object { std::string name, material; std::vector<std::vector<Index>> faces; };
  const std::vector<Object>& objects() const { return objects_; }
  glm::dvec3 position(const Index& i) const { return value(positions_, i[0], kPositionDecimals); }
  glm::dvec3 normal(const Index& i) const { return value(normals_, i[2], kNormalDecimals); }
  size_t triangle_count() const;

 private:
  static constexpr int kPositionDecimals = 4, kNormalDecimals = 4, kUvDecimals = 4;
  using Key = std::array<int64_t, 3>;  // rounded to the decimals that are written
  struct Table { std::map<Key, int> index; std::vector<Key> keys; };
  static int add(Table& table, const Key& key);
  static glm::dvec3 value(const Table& table, int i, int decimals);

  std::string mtl_file_;
  Table positions_, normals_, uvs_;
  std::vector<Object> objects_;
};

}  // namespace spanray::assets
