#include "shade/surface.h"

#include <iterator>
#include <utility>

namespace spanray {
namespace {

constexpr size_t kVectorWords = 16;  // one widest vector, 64 bytes

}  // namespace

SurfaceBatch::SurfaceBatch() { resize(0); }

void SurfaceBatch::resize(int n) {
  static_assert(sizeof(float) == sizeof(uint32_t));
  float** const vectors[] = {position, geometric_normal, normal, view, weight, dpdx, dpdy,
                             ambient, diffuse, specular, emission, mirror};
  float** const scalars[] = {&position_error, &t, &shininess, &opacity};
  uint32_t** const words[] = {&pixel, &ray, &primitive, &material, &valid};
  constexpr size_t kFields = 3 * std::size(decltype(vectors){}) + std::size(decltype(scalars){}) + std::size(decltype(words){});

  count = n;
  // One vector past count even where count fills its last one: kernels that start at any entry may run over by one vector.
  const size_t stride = (static_cast<size_t>(n) / kVectorWords + 2) * kVectorWords;
  storage_.resize(stride * kFields);
  float* next = storage_.data();
  const auto take = [&] { return std::exchange(next, next + stride); };
  for (float** v : vectors)
    for (int k = 0; k < 3; ++k) v[k] = take();
  for (float** s : scalars) *s = take();
  // Words live in the block of floats; kernels move both with the same untyped vector loads and stores.
  for (uint32_t** w : words) *w = reinterpret_cast<uint32_t*>(take());
}

}  // namespace spanray
