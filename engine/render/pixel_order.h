// The order in which the pixels of a chunk are shaded: cells of 16 x 16, in them blocks of 4 x 4, so that the pixels of a vector are
// neighbours in the picture. They see the same triangles, textures and boxes.
#pragma once
#include <cstdint>
#include <cstring>
#include <vector>

namespace spanray {

class PixelOrder {
 public:
  // columns, rows >= 1: the chunk's. Cheap if they are those of the last call.
  void make(int columns, int rows);

  // By slot: x | y << 16 from the chunk's first pixel.
  const std::vector<uint32_t>& pixel() const { return pixel_; }
  // Where the pixel at (x, y) of the chunk is.
  int32_t slot(int x, int y) const { return slot_[static_cast<size_t>(y * columns_ + x)]; }

  // rows: `stride` entries a row.
  template <class T> void from_rows(const T* rows, int stride, T* slots) const {
    each_run([&](size_t slot, int x, int y, size_t n) { std::memcpy(slots + slot, rows + y * stride + x, n * sizeof(T)); });
  }
  template <class T> void to_rows(const T* slots, int stride, T* rows) const {
    each_run([&](size_t slot, int x, int y, size_t n) { std::memcpy(rows + y * stride + x, slots + slot, n * sizeof(T)); });
  }
  size_t memory_bytes() const { return (pixel_.capacity() + slot_.capacity()) * sizeof(uint32_t); }

 private:
  // Runs of pixels that are neighbours both in slots and in a row.
  template <class Copy> void each_run(const Copy& copy) const {
    if (columns_ % kRun == 0) {
      for (size_t i = 0; i < pixel_.size(); i += kRun)
        copy(i, static_cast<int>(pixel_[i] & 0xffff), static_cast<int>(pixel_[i] >> 16), kRun);
    } else {
      for (size_t i = 0; i < pixel_.size(); ++i) copy(i, static_cast<int>(pixel_[i] & 0xffff), static_cast<int>(pixel_[i] >> 16), 1);
    }
  }

  static constexpr int kBlock = 4;      // side of a block
  static constexpr size_t kRun = kBlock;  // neighbours in a row of it
  int columns_ = 0, rows_ = 0;
  std::vector<uint32_t> pixel_;
  std::vector<int32_t> slot_;
};

}  // namespace spanray
