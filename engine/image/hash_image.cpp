#include "core/hash.h"
#include "spanray/image.h"

namespace spanray {

uint64_t hash_image(const Image& image) {
  Hash hash;
  hash.add_word(static_cast<uint64_t>(image.width)).add_word(static_cast<uint64_t>(image.height));
  return hash.add(image.rgba.data(), image.rgba.size()).value();
}

}  // namespace spanray
