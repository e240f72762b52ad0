// The order of the pixels of a chunk: each once, whatever its size, neighbours side by side.
#include <gtest/gtest.h>

#include <numeric>
#include <set>

#include "render/pixel_order.h"

namespace spanray {
namespace {

TEST(PixelOrder, HasEachPixelOnceForEverySize) {
  PixelOrder order;
  for (int columns = 1; columns <= 64; ++columns)
    for (int rows = 1; rows <= 16; ++rows) {
      order.make(columns, rows);
      const size_t pixels = static_cast<size_t>(columns * rows);
      ASSERT_EQ(order.pixel().size(), pixels);
      std::set<uint32_t> seen(order.pixel().begin(), order.pixel().end());
      ASSERT_EQ(seen.size(), pixels);
      for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x)
          ASSERT_EQ(order.pixel()[static_cast<size_t>(order.slot(x, y))], static_cast<uint32_t>(x) | static_cast<uint32_t>(y) << 16);
    }
}

TEST(PixelOrder, RowsToSlotsAndBack) {
  PixelOrder order;
  constexpr int kStride = 70;
  for (const auto& [columns, rows] : {std::pair{64, 16}, {60, 12}, {20, 8}, {61, 16}, {4, 3}, {3, 5}, {1, 1}, {60, 1}}) {
    order.make(columns, rows);
    std::vector<uint32_t> from(kStride * 16), slots(static_cast<size_t>(columns * rows)), back(kStride * 16, 0u);
    std::iota(from.begin(), from.end(), 1u);
    order.from_rows(from.data(), kStride, slots.data());
    for (int y = 0; y < rows; ++y)
      for (int x = 0; x < columns; ++x) ASSERT_EQ(slots[static_cast<size_t>(order.slot(x, y))], from[static_cast<size_t>(y * kStride + x)]);
    order.to_rows(slots.data(), kStride, back.data());
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < kStride; ++x) {
        const size_t i = static_cast<size_t>(y * kStride + x);
        ASSERT_EQ(back[i], x < columns && y < rows ? from[i] : 0u) << x << "," << y;
      }
  }
}

TEST(PixelOrder, SixteenSlotsAreASquareOfTheirCell) {
  PixelOrder order;
  order.make(64, 16);
  for (size_t i = 0; i < order.pixel().size(); i += 16) {
    const uint32_t first = order.pixel()[i];
    EXPECT_EQ(first & 0x00030003u, 0u);
    EXPECT_EQ((first & 0xffff) / 16, i / 256) << "cells of 16 x 16 one after the other";
    for (size_t k = 0; k < 16; ++k) EXPECT_EQ(order.pixel()[i + k] - first, k % 4 | k / 4 << 16);
  }
}

}  // namespace
}  // namespace spanray
