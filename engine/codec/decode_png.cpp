#include <png.h>

#include <bit>
#include <csetjmp>
#include <cstring>

#include "codec/decode.h"

namespace spanray {
namespace {

// Deflate never packs more than this: so many bytes a byte.
constexpr uint64_t kMostInflation = 1032;

// Everything that must outlive a longjmp: no C++ object lives in a frame that libpng jumps over.
struct PngReader {
  png_structp png = nullptr;
  png_infop info = nullptr;
  std::string_view bytes;
  size_t position = 0;
  int passes = 1;
  char message[128] = "damaged";

  PngReader() = default;
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;
  ~PngReader() { png_destroy_read_struct(&png, &info, nullptr); }
};

void on_error(png_structp png, png_const_charp message) {
  PngReader* reader = static_cast<PngReader*>(png_get_error_ptr(png));
  std::strncpy(reader->message, message, sizeof reader->message - 1);
  png_longjmp(png, 1);
}
void on_warning(png_structp, png_const_charp) {}

void read_bytes(png_structp png, png_bytep out, size_t count) {
  PngReader* reader = static_cast<PngReader*>(png_get_io_ptr(png));
  if (count > reader->bytes.size() - reader->position) png_error(png, "the file is truncated");
  std::memcpy(out, reader->bytes.data() + reader->position, count);
  reader->position += count;
}

// Reads up to the first pixel.
bool read_header(PngReader& reader) {
  if (setjmp(png_jmpbuf(reader.png))) return false;
  png_set_user_limits(reader.png, 0x7fffffff, 0x7fffffff);  // check_size says it more clearly
  // Color management and text are ignored, so that damage or bombs in them cannot matter.
  static const png_byte kIgnored[] = "bKGD\0cHRM\0eXIf\0gAMA\0hIST\0iCCP\0iTXt\0pCAL\0pHYs\0sBIT\0sCAL\0sPLT\0sRGB\0sTER\0tEXt\0tIME\0zTXt";
  png_set_keep_unknown_chunks(reader.png, PNG_HANDLE_CHUNK_NEVER, kIgnored, sizeof kIgnored / 5);
  png_set_read_fn(reader.png, &reader, read_bytes);
  png_read_info(reader.png, reader.info);
  return true;
}

// Before libpng makes room for rows.
Result<void> check_size(const PngReader& reader) {
  const uint64_t width = png_get_image_width(reader.png, reader.info), height = png_get_image_height(reader.png, reader.info);
  const std::string size = std::to_string(width) + " x " + std::to_string(height) + " pixels";
  if (width > kMaxImageSide || height > kMaxImageSide)
    return Error{"PNG: " + size + ", at most " + std::to_string(kMaxImageSide) + " a side are allowed"};
  // A file of a hundred bytes may claim gigabytes: those are not touched.
  if (png_get_rowbytes(reader.png, reader.info) * height / kMostInflation > reader.bytes.size())
    return Error{"PNG: the file is truncated: " + std::to_string(reader.bytes.size()) + " bytes cannot hold " + size};
  return {};
}

// Asks for 8- or 16-bit gray, gray + alpha, RGB or RGBA.
bool start(PngReader& reader) {
  if (setjmp(png_jmpbuf(reader.png))) return false;
  png_set_expand(reader.png);
  if (std::endian::native == std::endian::little) png_set_swap(reader.png);
  reader.passes = png_set_interlace_handling(reader.png);
  png_read_update_info(reader.png, reader.info);
  return true;
}

bool read_row(PngReader& reader, png_bytep row) {
  if (setjmp(png_jmpbuf(reader.png))) return false;
  png_read_row(reader.png, row, nullptr);
  return true;
}

bool read_end(PngReader& reader) {
  if (setjmp(png_jmpbuf(reader.png))) return false;
  png_read_end(reader.png, nullptr);
  return true;
}

Error png_failure(const PngReader& reader) { return Error{std::string("PNG: ") + reader.message}; }

// Rows of the finished picture, one by one: samples grow with the data, so a tiny file that claims to be huge costs little.
Result<void> read_rows(PngReader& reader, RawImage& image, size_t row_samples) {
  std::vector<uint16_t> row(row_samples);
  image.samples.reserve(row_samples * static_cast<size_t>(image.height));
  for (int y = 0; y < image.height; ++y) {
    png_bytep bytes = reinterpret_cast<png_bytep>(row.data());
    if (!read_row(reader, bytes)) return png_failure(reader);
    if (image.bits == 16)
      image.samples.insert(image.samples.end(), row.begin(), row.end());
    else
      image.samples.insert(image.samples.end(), bytes, bytes + row_samples);
  }
  return {};
}

// Interlaced: each pass refines all rows, which are therefore kept as bytes until the last.
Result<void> read_interlaced(PngReader& reader, RawImage& image, size_t row_samples) {
  const size_t row_bytes = row_samples * static_cast<size_t>(image.bits / 8);
  const size_t height = static_cast<size_t>(image.height);
  std::vector<png_byte> bytes(row_bytes * height);
  for (int pass = 0; pass < reader.passes; ++pass)
    for (size_t y = 0; y < height; ++y)
      if (!read_row(reader, bytes.data() + y * row_bytes)) return png_failure(reader);
  if (image.bits == 8) {
    image.samples.assign(bytes.begin(), bytes.end());
  } else {
    image.samples.resize(row_samples * height);
    std::memcpy(image.samples.data(), bytes.data(), bytes.size());
  }
  return {};
}

}  // namespace

Result<RawImage> decode_png(std::string_view bytes) {
  PngReader reader;
  reader.bytes = bytes;
  reader.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &reader, on_error, on_warning);
  if (reader.png != nullptr) reader.info = png_create_info_struct(reader.png);
  if (reader.info == nullptr) return Error{"PNG: not enough memory"};
  if (!read_header(reader)) return png_failure(reader);

  if (const Result<void> sized = check_size(reader); !sized) return sized.error();
  if (!start(reader)) return png_failure(reader);

  RawImage image;
  image.width = static_cast<int>(png_get_image_width(reader.png, reader.info));
  image.height = static_cast<int>(png_get_image_height(reader.png, reader.info));
  image.channels = png_get_channels(reader.png, reader.info);
  image.bits = png_get_bit_depth(reader.png, reader.info);
  const size_t row_samples = static_cast<size_t>(image.width) * static_cast<size_t>(image.channels);
  if (png_get_rowbytes(reader.png, reader.info) != row_samples * static_cast<size_t>(image.bits / 8))
    return Error{"PNG: unexpected pixel format"};
  const Result<void> rows = reader.passes > 1 ? read_interlaced(reader, image, row_samples) : read_rows(reader, image, row_samples);
  if (!rows) return rows.error();
  if (!read_end(reader)) return png_failure(reader);
  return image;
}

}  // namespace spanray
