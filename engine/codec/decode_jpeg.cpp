#include <csetjmp>
#include <cstddef>
#include <cstdio>
#include <jpeglib.h>
#include <jerror.h>

#include "codec/decode.h"

namespace spanray {
namespace {

constexpr int kMaxScans = 100;  // encoders make about 10; a progressive bomb repeats scans over a large picture for ever
// A block of 8 x 8 samples takes a bit or more, and covers at most 4 x 4 times as many pixels.
constexpr uint64_t kMostPixelsAByte = 8 * 64 * 16;

// Everything that must outlive a longjmp: no C++ object lives in a frame that libjpeg jumps over.
struct JpegReader {
  jpeg_decompress_struct jpeg = {};
  jpeg_error_mgr errors = {};
  jpeg_progress_mgr progress = {};
  std::jmp_buf jump;
  char message[JMSG_LENGTH_MAX] = "damaged";
  bool created = false;

  JpegReader() = default;
  JpegReader(const JpegReader&) = delete;
  JpegReader& operator=(const JpegReader&) = delete;
  ~JpegReader() { if (created) jpeg_destroy_decompress(&jpeg); }
};

JpegReader& reader_of(j_common_ptr jpeg) { return *static_cast<JpegReader*>(jpeg->client_data); }

[[noreturn]] void on_error(j_common_ptr jpeg) {
  JpegReader& reader = reader_of(jpeg);
  jpeg->err->format_message(jpeg, reader.message);
  std::longjmp(reader.jump, 1);
}
[[noreturn]] void fail(j_common_ptr jpeg, const char* message) {
  JpegReader& reader = reader_of(jpeg);
  std::snprintf(reader.message, sizeof reader.message, "%s", message);
  std::longjmp(reader.jump, 1);
}
// libjpeg fills what is missing with gray and only warns; we say that the file is truncated.
void on_message(j_common_ptr jpeg, int level) {
  if (level < 0 && (jpeg->err->msg_code == JWRN_JPEG_EOF || jpeg->err->msg_code == JWRN_HIT_MARKER))
    fail(jpeg, "the file is truncated or damaged");
}
void on_progress(j_common_ptr jpeg) {
  if (jpeg->is_decompressor && reinterpret_cast<j_decompress_ptr>(jpeg)->input_scan_number > kMaxScans)
    fail(jpeg, "too many scans");
}

bool read_header(JpegReader& reader, std::string_view bytes) {
  reader.jpeg.err = jpeg_std_error(&reader.errors);
  reader.errors.error_exit = on_error;
  reader.errors.emit_message = on_message;
  reader.jpeg.client_data = &reader;
  if (setjmp(reader.jump)) return false;
  jpeg_create_decompress(&reader.jpeg);
  reader.created = true;
  reader.progress.progress_monitor = on_progress;
  reader.jpeg.progress = &reader.progress;
  jpeg_mem_src(&reader.jpeg, reinterpret_cast<const unsigned char*>(bytes.data()), static_cast<unsigned long>(bytes.size()));
  return jpeg_read_header(&reader.jpeg, TRUE) == JPEG_HEADER_OK;
}

bool start(JpegReader& reader) {
  if (setjmp(reader.jump)) return false;
  reader.jpeg.out_color_space = reader.jpeg.num_components == 1 ? JCS_GRAYSCALE : JCS_RGB;
  // Fixed, whatever the library's defaults: these decide the samples.
  reader.jpeg.dct_method = JDCT_ISLOW;
  reader.jpeg.do_fancy_upsampling = TRUE;
  reader.jpeg.do_block_smoothing = FALSE;
  return jpeg_start_decompress(&reader.jpeg) == TRUE;
}

bool read_row(JpegReader& reader, JSAMPLE* row) {
  if (setjmp(reader.jump)) return false;
  return jpeg_read_scanlines(&reader.jpeg, &row, 1) == 1;
}

bool finish(JpegReader& reader) {
  if (setjmp(reader.jump)) return false;
  return jpeg_finish_decompress(&reader.jpeg) == TRUE;
}

Error jpeg_failure(const JpegReader& reader) { return Error{std::string("JPEG: ") + reader.message}; }

}  // namespace

Result<RawImage> decode_jpeg(std::string_view bytes) {
  JpegReader reader;
  if (!read_header(reader, bytes)) return jpeg_failure(reader);
  const JDIMENSION width = reader.jpeg.image_width, height = reader.jpeg.image_height;
  if (width > kMaxImageSide || height > kMaxImageSide)
    return Error{"JPEG: " + std::to_string(width) + " x " + std::to_string(height) + " pixels, at most " +
                 std::to_string(kMaxImageSide) + " a side are allowed"};
  if (uint64_t{width} * height > bytes.size() * kMostPixelsAByte)
    return Error{"JPEG: the file is truncated: " + std::to_string(bytes.size()) + " bytes cannot hold " + std::to_string(width) +
                 " x " + std::to_string(height) + " pixels"};
  if (reader.jpeg.num_components != 1 && reader.jpeg.num_components != 3)
    return Error{"JPEG: " + std::to_string(reader.jpeg.num_components) + " color components (CMYK?) are not supported"};
  if (!start(reader)) return jpeg_failure(reader);

  RawImage image;
  image.width = static_cast<int>(width);
  image.height = static_cast<int>(height);
  image.channels = reader.jpeg.output_components;
  std::vector<JSAMPLE> row(static_cast<size_t>(width) * static_cast<size_t>(image.channels));
  image.samples.reserve(row.size() * height);
  for (JDIMENSION y = 0; y < height; ++y) {
    if (!read_row(reader, row.data())) return jpeg_failure(reader);
    image.samples.insert(image.samples.end(), row.begin(), row.end());
  }
  if (!finish(reader)) return jpeg_failure(reader);
  return image;
}

}  // namespace spanray
