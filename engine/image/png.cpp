#include <png.h>

#include <csetjmp>
#include <cstring>
#include <new>

#include "codec/decode.h"
#include "core/atomic_file.h"
#include "core/read_file.h"
#include "spanray/image.h"

namespace spanray {
namespace {

// Everything that must outlive a longjmp: no C++ object lives in a frame that libpng jumps over.
struct PngWriter {
  png_structp png = nullptr;
  png_infop info = nullptr;
  std::string bytes;
  char message[128] = "cannot encode";

  PngWriter() = default;
  PngWriter(const PngWriter&) = delete;
  PngWriter& operator=(const PngWriter&) = delete;
  ~PngWriter() { png_destroy_write_struct(&png, &info); }
};

void on_error(png_structp png, png_const_charp message) {
  PngWriter* writer = static_cast<PngWriter*>(png_get_error_ptr(png));
  std::strncpy(writer->message, message, sizeof writer->message - 1);
  png_longjmp(png, 1);
}
void on_warning(png_structp, png_const_charp) {}

// No exception may cross libpng's C frames.
bool append(std::string& bytes, png_bytep data, size_t count) noexcept {
  try {
    bytes.append(reinterpret_cast<const char*>(data), count);
    return true;
  } catch (const std::bad_alloc&) {
    return false;
  }
}
void write_bytes(png_structp png, png_bytep data, size_t count) {
  PngWriter* writer = static_cast<PngWriter*>(png_get_io_ptr(png));
  if (!append(writer->bytes, data, count)) png_error(png, "not enough memory");
}
void flush(png_structp) {}

// The file stays small and comes fast: one filter, a low level. The pixels are what is promised, not the bytes.
bool encode(PngWriter& writer, const Image& image, png_text* texts, int text_count) {
  if (setjmp(png_jmpbuf(writer.png))) return false;
  png_set_write_fn(writer.png, &writer, write_bytes, flush);
  png_set_compression_level(writer.png, 4);
  png_set_IHDR(writer.png, writer.info, static_cast<png_uint_32>(image.width), static_cast<png_uint_32>(image.height), 8,
               PNG_COLOR_TYPE_RGB_ALPHA, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB(writer.png, writer.info, PNG_sRGB_INTENT_PERCEPTUAL);
  if (text_count > 0) png_set_text(writer.png, writer.info, texts, text_count);
  png_write_info(writer.png, writer.info);
  for (int y = 0; y < image.height; ++y)
    png_write_row(writer.png, image.rgba.data() + 4 * static_cast<size_t>(image.width) * static_cast<size_t>(y));
  png_write_end(writer.png, writer.info);
  return true;
}

Result<void> check(const std::string& path, const Image& image) {
  if (image.width < 1 || image.height < 1 || image.width > kMaxImageSide || image.height > kMaxImageSide)
    return Error{"cannot write a picture of " + std::to_string(image.width) + " x " + std::to_string(image.height) + " pixels: 1 to " +
                     std::to_string(kMaxImageSide) + " a side", path};
  if (image.rgba.size() != 4 * static_cast<size_t>(image.width) * static_cast<size_t>(image.height))
    return Error{"cannot write a picture whose size and bytes disagree", path};
  return check_writable(path);
}

uint8_t to_8_bits(uint16_t sample, int bits) {
  return static_cast<uint8_t>(bits == 8 ? sample : (sample * 255u + 32767u) / 65535u);
}

}  // namespace

Result<void> write_png(const std::string& path, const Image& image, const std::vector<std::pair<std::string, std::string>>& text) {
  if (auto possible = check(path, image); !possible) return possible;
  std::vector<png_text> texts;
  for (const auto& [key, value] : text) {
    if (key.empty() || key.size() > 79) return Error{"PNG: a text key must have 1 to 79 characters: '" + key + "'", path};
    png_text chunk = {};
    chunk.compression = PNG_TEXT_COMPRESSION_NONE;
    chunk.key = const_cast<char*>(key.c_str());  // libpng only reads them
    chunk.text = const_cast<char*>(value.c_str());
    chunk.text_length = value.size();
    texts.push_back(chunk);
  }
  PngWriter writer;
  writer.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &writer, on_error, on_warning);
  if (writer.png != nullptr) writer.info = png_create_info_struct(writer.png);
  if (writer.info == nullptr) return Error{"PNG: not enough memory", path};
  if (!encode(writer, image, texts.data(), static_cast<int>(texts.size())))
    return Error{std::string("PNG: ") + writer.message, path};
  return write_file_atomic(path, writer.bytes);
}

Result<Image> read_png(const std::string& path) {
  const Result<std::string> bytes = read_file(path);
  if (!bytes) return bytes.error();
  if (!bytes.value().empty() && bytes.value()[0] != '\x89') return Error{"not a PNG file", path};
  const Result<RawImage> decoded = decode_image(bytes.value());
  if (!decoded) return Error{decoded.error().message, path};
  const RawImage& raw = decoded.value();
  Image image;
  image.width = raw.width;
  image.height = raw.height;
  const size_t pixels = static_cast<size_t>(raw.width) * static_cast<size_t>(raw.height), channels = static_cast<size_t>(raw.channels);
  const bool gray = raw.channels < 3, alpha = raw.channels % 2 == 0;
  try {
    image.rgba.resize(4 * pixels);
  } catch (const std::bad_alloc&) {
    return Error{"not enough memory for the picture", path};
  }
  for (size_t i = 0; i < pixels; ++i) {
    const uint16_t* sample = raw.samples.data() + i * channels;
    uint8_t* out = image.rgba.data() + 4 * i;
    for (size_t k = 0; k < 3; ++k) out[k] = to_8_bits(sample[gray ? 0 : k], raw.bits);
    out[3] = alpha ? to_8_bits(sample[channels - 1], raw.bits) : 255;
  }
  return image;
}

}  // namespace spanray
