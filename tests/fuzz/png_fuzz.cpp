// PNG bytes, as they are and once more with every checksum put right, since random ones never are.
#include <zlib.h>

#include "fuzz.h"
#include "scene/texture_loader.h"

namespace spanray {
namespace {

uint32_t big_endian(const unsigned char* p) { return uint32_t{p[0]} << 24 | uint32_t{p[1]} << 16 | uint32_t{p[2]} << 8 | p[3]; }

std::string with_right_checksums(std::string png) {
  unsigned char* bytes = reinterpret_cast<unsigned char*>(png.data());
  for (size_t at = 8; at + 12 <= png.size();) {
    const size_t length = big_endian(bytes + at);
    if (length > png.size() - at - 12) break;
    const uint32_t crc = static_cast<uint32_t>(::crc32(0, bytes + at + 4, static_cast<unsigned>(length + 4)));
    for (int k = 0; k < 4; ++k) bytes[at + 8 + length + static_cast<size_t>(k)] = static_cast<unsigned char>(crc >> (24 - 8 * k));
    at += length + 12;
  }
  return png;
}

void decode(std::string_view bytes) {
  const Result<RawImage> image = decode_image(bytes);
  if (!image) return must(!image.error().message.empty() && image.error().message.size() < 400, "a message");
  const RawImage& i = image.value();
  must(i.width >= 1 && i.height >= 1 && i.width <= kMaxImageSide && i.height <= kMaxImageSide, "sides");
  must(i.samples.size() == static_cast<size_t>(i.width) * static_cast<size_t>(i.height) * static_cast<size_t>(i.channels), "samples");
  for (const uint16_t s : i.samples) must(i.bits == 16 || s <= 255, "a sample over 255");
  if (i.samples.size() > 4096) return;
  for (const bool color : {false, true}) {
    SceneData scene;
    must(bool(append_texture(i, color, scene)), "a decoded picture that is no texture");
  }
}

}  // namespace
}  // namespace spanray

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string_view bytes = spanray::text_of(data, size);
  spanray::decode(bytes);
  if (spanray::is_png(bytes)) spanray::decode(spanray::with_right_checksums(std::string(bytes)));
  return 0;
}
