#include "picture.h"

#include <png.h>

#include <cmath>

#include "core/atomic_file.h"

namespace spanray::assets {
namespace {

double unit(double x) { return x < 0 ? 0 : x > 1 ? 1 : x; }

void append(png_structp png, png_bytep data, png_size_t size) {
  static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(data), size);
}

}  // namespace

Picture paint_color(int width, int height, const std::function<glm::dvec3(double, double)>& srgb) {
  Picture p{width, height, 3, 8, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const glm::dvec3 c = srgb((x + 0.5) / width, (height - y - 0.5) / height);
      for (int k = 0; k < 3; ++k) p.samples.push_back(static_cast<uint16_t>(std::floor(unit(c[k]) * 255 + 0.5)));
    }
  }
  return p;
}

Picture paint_gray(int width, int height, int bits, const std::function<double(double, double)>& value) {
  Picture p{width, height, 1, bits, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const double h = unit(value((x + 0.5) / width, (height - y - 0.5) / height));
      // 16 bits: steps of 16, that is 12 bits, finer than any slope that is seen here.
      const double sample = bits == 8 ? std::floor(h * 255 + 0.5) : std::floor(h * 4095 + 0.5) * 16;
      p.samples.push_back(static_cast<uint16_t>(sample));
    }
  }
  return p;
}

Result<void> write_picture(const std::string& path, const Picture& p) {
  const size_t row_samples = static_cast<size_t>(p.width * p.channels);
  std::vector<uint8_t> bytes;  // big endian, as PNG wants it
  for (uint16_t s : p.samples) {
    if (p.bits == 16) bytes.push_back(static_cast<uint8_t>(s >> 8));
    bytes.push_back(static_cast<uint8_t>(s & 255));
  }
  std::string file;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
  if (info == nullptr || setjmp(png_jmpbuf(png)) != 0) {
    png_destroy_write_struct(&png, &info);
    return Error{"cannot encode PNG", path};
  }
  png_set_write_fn(png, &file, append, nullptr);
  png_set_compression_level(png, 9);
  png_set_IHDR(png, info, static_cast<png_uint_32>(p.width), static_cast<png_uint_32>(p.height), p.bits,
               p.channels == 1 ? PNG_COLOR_TYPE_GRAY : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  const size_t row_bytes = row_samples * static_cast<size_t>(p.bits / 8);
  for (int y = 0; y < p.height; ++y) png_write_row(png, bytes.data() + static_cast<size_t>(y) * row_bytes);
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return write_file_atomic(path, file);
}

}  // namespace spanray::assets
