// A mesh on its way into an OBJ file: faces with shared positions, normals and texture coordinates.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
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
  struct Decimals {
    int position = 4, normal = 4, uv = 4;
    double half = 0.5;  // a little more: halves go up even where they were computed too small, so that faces that meet agree
  };
  explicit ObjMesh(std::string mtl_file) : ObjMesh(std::move(mtl_file), Decimals{}) {}
  ObjMesh(std::string mtl_file, Decimals decimals) : mtl_file_(std::move(mtl_file)), decimals_(decimals) {}
  // A mesh that only counts the triangles that it is given.
  static ObjMesh counter();

  // Starts an object; following faces have this material.
  void object(const std::string& name, const std::string& material);
  // Corners counter-clockwise seen from the front. Equal neighbors collapse; a face left with fewer than 3 corners is dropped.
  void face(std::span<const Corner> corners);
  void face(std::initializer_list<Corner> corners) { face(std::span<const Corner>(corners.begin(), corners.size())); }
  // The file, a piece at a time; `sink` returns false to stop.
  void write(const std::function<bool(std::string_view)>& sink) const;
  std::string text() const;

  // Index triples (position, uv, normal), 0-based, and the values as written.
  using Index = std::array<int, 3>;
  using Face = std::span<const Index>;
  struct Object {
    std::string name, material;
    std::vector<Index> corners;   // of all faces, one after the other
    std::vector<uint32_t> ends;   // of each face in `corners`
    std::vector<Face> faces() const;
  };
  const std::vector<Object>& objects() const { return objects_; }
  glm::dvec3 position(const Index& i) const { return value(positions_, i[0], decimals_.position); }
  glm::dvec3 normal(const Index& i) const { return value(normals_, i[2], decimals_.normal); }
  size_t triangle_count() const { return triangles_; }

 private:
  using Key = std::array<int32_t, 3>;  // rounded to the decimals that are written
  // Distinct keys in the order of their first use, found by open addressing: at 10 million triangles a tree of nodes takes minutes.
  struct Table {
    std::vector<Key> keys;
    std::vector<uint32_t> slots;  // 1 + index into keys, 0: free; a power of two of them
    int add(const Key& key);
    void grow();
    size_t slot_of(const Key& key) const;
  };
  static glm::dvec3 value(const Table& table, int i, int decimals);

  std::string mtl_file_;
  Decimals decimals_;
  bool only_count_ = false;
  Table positions_, normals_, uvs_;
  std::vector<Object> objects_;
  size_t triangles_ = 0;
};

}  // namespace spanray::assets
