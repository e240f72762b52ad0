// The hash ladder: what each stage made, hashed per tile and pixel, so that two runs can be compared and the first
// difference named by stage, tile, pixel and primitive (DESIGN 3).
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core/hash.h"
#include "spanray/result.h"

namespace spanray {

// The rungs, in the order of the frame.
enum class Rung { kScene, kVertices, kIds, kSurfaces, kShadowBits, kRadiance, kBytes };
inline constexpr int kRungCount = 7;
const char* rung_name(Rung rung);

// One picture's ladder. Whole-frame rungs (scene, vertices) are one hash; the others one 64-bit word a pixel, mixed in any
// number of times by the task that owns the pixel (bounces and lights mix in order).
class Ladder {
 public:
  void begin(int width, int height);
  void set(Rung rung, uint64_t hash) { whole_[static_cast<int>(rung)] = hash; }
  void mix(Rung rung, int x, int y, uint64_t word) {
    uint64_t& state = pixels_[static_cast<int>(rung)][static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x)];
    state = mix64(state ^ word) + 0x9e3779b97f4a7c15ull;
  }
  // The same, whatever the order of the words.
  void add(Rung rung, int x, int y, uint64_t word) {
    pixels_[static_cast<int>(rung)][static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x)] += mix64(word);
  }
  void set_primitive(int x, int y, uint32_t primitive) {
    primitive_[static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x)] = primitive;
  }
  int width() const { return width_; }
  int height() const { return height_; }

  // {"numeric_contract", "width", "height", "tile_size", "rungs": [{"name", "hash", "tiles": [{"tile", "hash",
  // "pixels": 4 hexadecimal digits a pixel, row by row}]}], "primitives": [8 digits a pixel, a string a tile]}
  // Written atomically. Reading checks every size; errors name the file and the field.
  Result<void> write_json(const std::string& path) const;
  static Result<Ladder> read_json(const std::string& path);

  struct Difference {
    bool found = false;
    Rung rung = Rung::kScene;
    int tile = -1, x = -1, y = -1;             // -1: the rung has no tiles
    uint32_t primitive_a = 0, primitive_b = 0;  // at that pixel; 0xffffffff: background
    std::string to_string() const;
  };
  // The first difference in order of rungs, then tiles, then pixels. Different sizes differ at kScene. After read_json a
  // pixel has 16 bits: a tile may differ (64 bits) where no pixel shows it (1 in 65536), then x and y stay -1.
  static Difference first_difference(const Ladder& a, const Ladder& b);

  // Of the whole picture: what set() gave, or the hash of all tiles.
  uint64_t hash(Rung rung) const;

 private:
  uint64_t tile_hash(int rung, int tile) const;

  int width_ = 0, height_ = 0;
  bool from_file_ = false;                       // then pixels have 16 bits and tile hashes stand in tiles_
  uint64_t whole_[kRungCount] = {};
  std::vector<uint64_t> pixels_[kRungCount];     // empty for whole-frame rungs
  std::vector<uint64_t> tiles_[kRungCount];
  std::vector<uint32_t> primitive_;
};

}  // namespace spanray
