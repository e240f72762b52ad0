#include "image/false_color.h"

#include <algorithm>
#include <cstdio>
#include <string>

namespace spanray {
namespace {

constexpr int kMinWidth = 160, kBarHeight = 10;

void put(Image& image, int x, int y, const uint8_t (&color)[3]) {
  if (x < 0 || y < 0 || x >= image.width || y >= image.height) return;
  uint8_t* const p = image.rgba.data() + 4 * (static_cast<size_t>(y) * static_cast<size_t>(image.width) + static_cast<size_t>(x));
  p[0] = color[0], p[1] = color[1], p[2] = color[2], p[3] = 255;
}

void put_mapped(Image& image, int x, int y, double value) {
  constexpr uint8_t kAnchor[9][3] = {{0, 0, 4},     {28, 16, 68},   {79, 18, 123},  {129, 37, 129}, {181, 54, 122},
                                     {229, 80, 100}, {251, 135, 97}, {254, 194, 135}, {252, 253, 191}};
  const double v = value > 0 ? std::min(value, 1.0) * 8 : 0;  // NaN is black
  const int i = std::min(static_cast<int>(v), 7);
  uint8_t color[3];
  for (int c = 0; c < 3; ++c) color[c] = static_cast<uint8_t>(kAnchor[i][c] + (v - i) * (kAnchor[i + 1][c] - kAnchor[i][c]) + 0.5);
  put(image, x, y, color);
}

// Digits and the decimal point, 5 x 7: rows from the top, the leftmost pixel in bit 4.
constexpr uint8_t kGlyph[11][7] = {
    {14, 17, 19, 21, 25, 17, 14}, {4, 12, 4, 4, 4, 4, 14},    {14, 17, 1, 2, 4, 8, 31},    {31, 2, 4, 2, 1, 17, 14},
    {2, 6, 10, 18, 31, 2, 2},     {31, 16, 30, 1, 1, 17, 14}, {6, 8, 16, 30, 17, 17, 14}, {31, 1, 2, 4, 8, 8, 8},
    {14, 17, 17, 14, 17, 17, 14}, {14, 17, 17, 15, 1, 2, 12}, {0, 0, 0, 0, 0, 12, 12}};
constexpr int kGlyphStep = 6;

void write_number(Image& image, int x, int y, const std::string& text) {
  constexpr uint8_t kWhite[3] = {230, 230, 230};
  for (const char c : text) {
    const uint8_t* const glyph = kGlyph[c == '.' ? 10 : std::clamp(c - '0', 0, 9)];
    for (int row = 0; row < 7; ++row)
      for (int column = 0; column < 5; ++column)
        if (glyph[row] >> (4 - column) & 1) put(image, x + column, y + row, kWhite);
    x += kGlyphStep;
  }
}

// At most four significant digits, without an exponent.
std::string label(double value) {
  char text[32];
  std::snprintf(text, sizeof text, value >= 100 ? "%.0f" : value >= 1 ? "%.2f" : "%.4f", value);
  std::string s = text;
  if (s.find('.') != std::string::npos) s.erase(s.find_last_not_of('0') + 1);
  if (s.back() == '.') s.pop_back();
  return s;
}

}  // namespace

Image false_color(const std::vector<float>& values, int width, int height, double most) {
  Image image;
  image.width = std::max(width, kMinWidth), image.height = height + kLegendHeight;
  image.rgba.assign(4 * static_cast<size_t>(image.width) * static_cast<size_t>(image.height), 0);
  for (size_t i = 3; i < image.rgba.size(); i += 4) image.rgba[i] = 255;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      put_mapped(image, x, y, values[static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)] / most);
  const int last = image.width - 1;
  for (int x = 0; x <= last; ++x)
    for (int y = 0; y < kBarHeight; ++y) put_mapped(image, x, height + 2 + y, static_cast<double>(x) / last);
  for (int quarter = 0; quarter <= 4; quarter += image.width < 320 ? 2 : 1) {
    const std::string text = label(most * quarter / 4);
    const int length = kGlyphStep * static_cast<int>(text.size());
    write_number(image, std::clamp(last * quarter / 4 - length / 2, 1, image.width - length), height + kBarHeight + 5, text);
  }
  return image;
}

}  // namespace spanray
