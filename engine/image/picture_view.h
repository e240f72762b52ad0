// A picture as metrics read it: linear light and display values, whatever file it came from. Alpha is not looked at.
#pragma once
#include <algorithm>
#include <cmath>

#include "image/color_spaces.h"
#include "image/pfm.h"
#include "spanray/image.h"

namespace spanray {

// Points to the picture, which must outlive it.
class PictureView {
 public:
  PictureView(const Image& image) : width(image.width), height(image.height), bytes_(&image) {}
  PictureView(const FloatImage& image) : width(image.width), height(image.height), floats_(&image) {}

  const int width, height;

  // Linear RGB; of a FloatImage as it stands, which may be over 1 or below 0.
  Color3 linear(int x, int y) const {
    const size_t i = index(x, y);
    if (bytes_ != nullptr) {
      const uint8_t* p = bytes_->rgba.data() + 4 * i;
      return {table().linear[p[0]], table().linear[p[1]], table().linear[p[2]]};
    }
    const float* p = floats_->rgb.data() + 3 * i;
    return {p[0], p[1], p[2]};
  }
  // Linear RGB that a display can show: held in [0, 1].
  Color3 shown(int x, int y) const {
    const Color3 c = linear(x, y);
    return {clamp(c.x), clamp(c.y), clamp(c.z)};
  }
  // sRGB code, 0 to 255; whole numbers for an Image, not rounded for a FloatImage.
  Color3 code(int x, int y) const {
    if (bytes_ != nullptr) {
      const uint8_t* p = bytes_->rgba.data() + 4 * index(x, y);
      return {double(p[0]), double(p[1]), double(p[2])};
    }
    const Color3 c = shown(x, y);
    return {255 * srgb_from_linear(c.x), 255 * srgb_from_linear(c.y), 255 * srgb_from_linear(c.z)};
  }
  // Size and storage agree.
  bool consistent() const {
    if (width < 0 || height < 0) return false;
    const size_t n = static_cast<size_t>(width) * static_cast<size_t>(height);
    return bytes_ != nullptr ? bytes_->rgba.size() == 4 * n : floats_->rgb.size() == 3 * n;
  }

 private:
  struct Table { double linear[256]; };
  static const Table& table() {
    static const Table made = [] {
      Table t;
      for (int i = 0; i < 256; ++i) t.linear[i] = linear_from_srgb_exact(i / 255.0);
      return t;
    }();
    return made;
  }
  static double clamp(double v) { return std::min(std::max(v, 0.0), 1.0); }
  size_t index(int x, int y) const { return static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x); }

  const Image* bytes_ = nullptr;
  const FloatImage* floats_ = nullptr;
};

}  // namespace spanray
