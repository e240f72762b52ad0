#include "render/pixel_order.h"

#include <algorithm>

namespace spanray {

void PixelOrder::make(int columns, int rows) {
  if (columns == columns_ && rows == rows_) return;
  columns_ = rows_ = 0;  // until all is there: allocating may throw
  pixel_.clear();
  slot_.resize(static_cast<size_t>(columns * rows));
  const auto blocks = [](int begin, int end, int step, const auto& visit) {
    for (int i = begin; i < end; i += step) visit(i, std::min(i + step, end));
  };
  const auto block = [&](int x0, int x1, int y0, int y1) {
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x) {
        slot_[static_cast<size_t>(y * columns + x)] = static_cast<int32_t>(pixel_.size());
        pixel_.push_back(static_cast<uint32_t>(x) | static_cast<uint32_t>(y) << 16);
      }
  };
  blocks(0, rows, kCellSize, [&](int cell_y0, int cell_y1) {
    blocks(0, columns, kCellSize, [&](int cell_x0, int cell_x1) {
      blocks(cell_y0, cell_y1, kBlock, [&](int y0, int y1) {
        blocks(cell_x0, cell_x1, kBlock, [&](int x0, int x1) { block(x0, x1, y0, y1); });
      });
    });
  });
  columns_ = columns, rows_ = rows;
}

}  // namespace spanray
