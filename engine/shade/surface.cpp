#include "shade/surface.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace spanray {
namespace {

constexpr size_t kVectorWords = 16;  // one widest vector, 64 bytes

}  // namespace

SurfaceBatch::SurfaceBatch() { resize(0); }

void SurfaceBatch::resize(int n, uint32_t written, int with_lights) {
  static_assert(sizeof(float) == sizeof(uint32_t));
  struct Vector { float** field; uint32_t needs; };
  const Vector vectors[] = {{position, 0}, {geometric_normal, 0}, {normal, kSurfaceNormal}, {view, kSurfaceView},
                            {weight, kSurfaceWeight}, {diffuse, 0}, {specular, 0}, {dpdx, kSurfaceFootprint}, {dpdy, kSurfaceFootprint},
                            {ambient, kSurfaceAmbient}, {emission, kSurfaceEmission}, {mirror, kSurfaceMirror}, {lift, kSurfaceLift}, {smooth_normal, kSurfaceLift}};
  struct Scalar { float** field; uint32_t needs; };
  const Scalar scalars[] = {{&position_error, 0}, {&t, kSurfaceDepth}, {&shininess, 0}, {&opacity, 0}};
  uint32_t** const words[] = {&pixel, &ray, &primitive, &material, &valid};
  constexpr size_t kFields = 3 * std::size(decltype(vectors){}) + std::size(decltype(scalars){}) + std::size(decltype(words){});

  count = n, fields = written, lights = with_lights;
  plane_lanes = surface_lanes = {};
  exact.clear();
  // One vector past count even where count fills its last one: kernels that start at any entry may run over by one vector.
  stride_ = (static_cast<size_t>(n) / kVectorWords + 2) * kVectorWords;
  const size_t stride = stride_;
  storage_.resize(stride * (kFields + 1 + 2 * static_cast<size_t>(lights)));
  float* next = storage_.data();
  const auto take = [&] { return std::exchange(next, next + stride); };
  float* const zeros = take();
  std::fill_n(zeros, stride, 0.0f);
  const auto take_if = [&](uint32_t needs) { return (needs & ~fields) == 0 ? take() : zeros; };
  for (const Vector& v : vectors)
    for (int k = 0; k < 3; ++k) v.field[k] = take_if(v.needs);
  for (const Scalar& s : scalars) *s.field = take_if(s.needs);
  // Words live in the block of floats; kernels move both with the same untyped vector loads and stores.
  for (uint32_t** w : words) *w = reinterpret_cast<uint32_t*>(take());
  triangle_light_ = next;
}

}  // namespace spanray
