#include "image/pfm.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <new>

#include "codec/decode.h"
#include "core/atomic_file.h"
#include "core/read_file.h"

namespace spanray {
namespace {

uint32_t swap_bytes(uint32_t x) { return (x >> 24) | ((x >> 8) & 0xff00u) | ((x << 8) & 0xff0000u) | (x << 24); }

// The next word of a PFM header, and exactly one white character after it (the pixels follow the last).
std::string_view next_word(std::string_view& rest) {
  const size_t end = std::min(rest.find_first_of(" \t\r\n"), rest.size());
  const std::string_view word = rest.substr(0, end);
  rest.remove_prefix(std::min(end + 1, rest.size()));
  return word;
}

template <class T> bool parse(std::string_view word, T* value) {
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), *value);
  return error == std::errc() && end == word.data() + word.size();
}

Result<FloatImage> decode_pfm(std::string_view rest) {
  const std::string_view kind = next_word(rest);
  if (kind != "PF" && kind != "Pf") return Error{"not a PFM file"};
  const size_t channels = kind == "PF" ? 3 : 1;
  FloatImage image;
  float scale = 0;
  const bool header = parse(next_word(rest), &image.width) && parse(next_word(rest), &image.height) && parse(next_word(rest), &scale);
  if (!header || scale == 0 || scale != scale) return Error{"PFM: bad header"};
  if (image.width < 1 || image.height < 1 || image.width > kMaxImageSide || image.height > kMaxImageSide)
    return Error{"PFM: " + std::to_string(image.width) + " x " + std::to_string(image.height) + " pixels, 1 to " +
                 std::to_string(kMaxImageSide) + " a side are allowed"};
  const size_t width = static_cast<size_t>(image.width), height = static_cast<size_t>(image.height);
  if (rest.size() < width * height * channels * 4) return Error{"PFM: the file is truncated"};
  const bool swap = (scale < 0) != (std::endian::native == std::endian::little);
  image.rgb.resize(3 * width * height);
  for (size_t y = 0; y < height; ++y) {
    const char* row = rest.data() + (height - 1 - y) * width * channels * 4;
    for (size_t i = 0; i < 3 * width; ++i) {
      uint32_t bits;
      std::memcpy(&bits, row + (channels == 3 ? i : i / 3) * 4, 4);
      image.rgb[y * 3 * width + i] = std::bit_cast<float>(swap ? swap_bytes(bits) : bits);
    }
  }
  return image;
}

Result<void> write_floats(const std::string& path, const char* kind, int channels, int image_width, int image_height,
                          const std::vector<float>& values) {
  const size_t row = static_cast<size_t>(channels) * static_cast<size_t>(std::max(image_width, 0));
  const size_t height = static_cast<size_t>(std::max(image_height, 0));
  if (row == 0 || height == 0 || values.size() != row * height)
    return Error{"cannot write a picture whose size and values disagree", path};
  std::string bytes = std::string(kind) + "\n" + std::to_string(image_width) + " " + std::to_string(image_height) + "\n-1.0\n";
  bytes.reserve(bytes.size() + row * height * 4);
  for (size_t y = height; y-- > 0;)
    for (size_t i = 0; i < row; ++i) {
      uint32_t bits = std::bit_cast<uint32_t>(values[y * row + i]);
      if (std::endian::native == std::endian::big) bits = swap_bytes(bits);
      char word[4];
      std::memcpy(word, &bits, 4);
      bytes.append(word, 4);
    }
  return write_file_atomic(path, bytes);
}

}  // namespace

Result<void> write_pfm(const std::string& path, const FloatImage& image) {
  return write_floats(path, "PF", 3, image.width, image.height, image.rgb);
}

Result<void> write_pfm_gray(const std::string& path, int width, int height, const std::vector<float>& values) {
  return write_floats(path, "Pf", 1, width, height, values);
}

Result<FloatImage> read_pfm(const std::string& path) {
  const Result<std::string> bytes = read_file(path);
  if (!bytes) return bytes.error();
  if (bytes.value().empty()) return Error{"the file is empty", path};
  try {
    Result<FloatImage> image = decode_pfm(bytes.value());
    if (!image) return Error{image.error().message, path};
    return image;
  } catch (const std::bad_alloc&) {
    return Error{"not enough memory for the picture", path};
  }
}

}  // namespace spanray
