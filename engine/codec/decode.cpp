#include "codec/decode.h"

#include <new>

#include "core/read_file.h"

namespace spanray {

bool is_png(std::string_view bytes) { return bytes.substr(0, 8) == std::string_view("\x89PNG\r\n\x1a\n", 8); }
bool is_jpeg(std::string_view bytes) { return bytes.substr(0, 3) == "\xff\xd8\xff"; }

Result<RawImage> decode_image(std::string_view bytes) {
  if (bytes.empty()) return Error{"the file is empty"};
  try {
    if (is_png(bytes)) return decode_png(bytes);
    if (is_jpeg(bytes)) return decode_jpeg(bytes);
  } catch (const std::bad_alloc&) {
    return Error{"not enough memory for the picture"};
  }
  if (bytes.size() < 8 && std::string_view("\x89PNG\r\n\x1a\n", 8).substr(0, bytes.size()) == bytes)
    return Error{"PNG: the file is truncated"};
  return Error{"neither a PNG nor a JPEG file"};
}

Result<RawImage> decode_image_file(const std::string& path) {
  const Result<std::string> bytes = read_file(path);
  if (!bytes) return bytes.error();
  Result<RawImage> image = decode_image(bytes.value());
  if (!image) return Error{image.error().message, path};
  return image;
}

}  // namespace spanray
