// JPEG bytes. Sides are kept under 256 pixels: larger pictures are more of the same, at a thousandth of the rounds.
#include "codec/decode.h"
#include "fuzz.h"

namespace {

std::string with_small_sides(std::string jpeg) {
  for (size_t at = 0; at + 9 < jpeg.size(); ++at) {
    const unsigned char marker = static_cast<unsigned char>(jpeg[at + 1]);
    const bool frame = jpeg[at] == '\xff' && marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
    if (frame) jpeg[at + 5] = jpeg[at + 7] = 0;
  }
  return jpeg;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using spanray::must;
  const auto image = spanray::decode_jpeg(with_small_sides(std::string(spanray::text_of(data, size))));
  if (!image) return must(!image.error().message.empty() && image.error().message.size() < 400, "a message"), 0;
  const spanray::RawImage& i = image.value();
  must(i.width >= 1 && i.height >= 1 && i.width <= spanray::kMaxImageSide && i.height <= spanray::kMaxImageSide, "sides");
  must(i.channels == 1 || i.channels == 3, "channels");
  must(i.samples.size() == static_cast<size_t>(i.width) * static_cast<size_t>(i.height) * static_cast<size_t>(i.channels), "samples");
  for (const uint16_t s : i.samples) must(s <= 255, "a sample over 255");
  return 0;
}
