// The order in which the pixels of a chunk are shaded: cells of 16 x 16, in them blocks of 4 x 4, so that the pixels of a vector are
// neighbours in the picture. They see the same triangles, textures and boxes.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <vector>

#include "frame/tiles.h"

namespace spanray {

class PixelOrder {
 public:
  // columns, rows >= 1: the chunk's. Cheap if they are those of the last call.
  void make(int columns, int rows);

  // By slot: x | y << 16 from the chunk's first pixel.
  const std::vector<uint32_t>& pixel() const { return pixel_; }
  // Where the pixel at (x, y) of the chunk is.
  int32_t slot(int x, int y) const { return slot_[static_cast<size_t>(y * columns_ + x)]; }

  // By slot: pixel() of a chunk that begins at pixel `first`.
  void name_pixels(uint32_t first, uint32_t* slots) const {
    const uint32_t* const offset = pixel_.data();
    for (size_t i = 0, n = pixel_.size(); i < n; ++i) slots[i] = first + offset[i];
  }

  // rows: `stride` entries a row.
  template <class T> void from_rows(const T* rows, int stride, T* slots) const {
    each_run([=](size_t slot, ptrdiff_t x, ptrdiff_t y, auto n) { std::memcpy(slots + slot, rows + y * stride + x, n * sizeof(T)); });
  }
  template <class T> void to_rows(const T* slots, int stride, T* rows) const {
    each_run([=](size_t slot, ptrdiff_t x, ptrdiff_t y, auto n) { std::memcpy(rows + y * stride + x, slots + slot, n * sizeof(T)); });
  }
  size_t memory_bytes() const { return (pixel_.capacity() + slot_.capacity()) * sizeof(uint32_t); }

 private:
  // Runs of pixels that are neighbours both in slots and in a row.
  template <class Copy> void each_run(const Copy& copy) const {
    const int columns = columns_, rows = rows_;  // no members in the loops: what is copied might change them
    if (columns % kBlock != 0 || rows % kBlock != 0) {
      const uint32_t* const pixel = pixel_.data();
      for (size_t i = 0, n = pixel_.size(); i < n; ++i)
        copy(i, static_cast<ptrdiff_t>(pixel[i] & 0xffff), static_cast<ptrdiff_t>(pixel[i] >> 16), std::integral_constant<size_t, 1>());
      return;
    }
    size_t first = 0;  // slot of the cell
    for (int y0 = 0; y0 < rows; y0 += kCellSize)
      for (int x0 = 0; x0 < columns; x0 += kCellSize) {
        const int width = std::min(kCellSize, columns - x0), height = std::min(kCellSize, rows - y0);
        if (width == kCellSize) each_run_of_cell(first, x0, y0, std::integral_constant<int, kCellSize>(), height, copy);
        else each_run_of_cell(first, x0, y0, width, height, copy);
        first += static_cast<size_t>(width * height);
      }
  }
  // Row by row: whole cache lines are then written at once.
  template <class Width, class Copy> static void each_run_of_cell(size_t first, int x0, int y0, Width width, int height, const Copy& copy) {
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; x += kBlock) {
        const int slot = (y / kBlock) * kBlock * width + x * kBlock + (y % kBlock) * kBlock;
        copy(first + static_cast<size_t>(slot), ptrdiff_t{x0} + x, ptrdiff_t{y0} + y, std::integral_constant<size_t, kBlock>());
      }
  }

  static constexpr int kBlock = 4;  // side of a block
  int columns_ = 0, rows_ = 0;
  std::vector<uint32_t> pixel_;
  std::vector<int32_t> slot_;
};

}  // namespace spanray
