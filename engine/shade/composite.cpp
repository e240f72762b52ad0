// Translucent layers over opaque radiance.
#include <algorithm>

#include "catalog/scalar.h"
#include "shade/light.h"

namespace spanray {
namespace {
using namespace scalar;
#include "catalog/transparency/alpha.inl"
}  // namespace

// Source:   Porter and Duff 1984; far to near in one pass.
// Input:    fragments in any order.
// Contract: deterministic: the order of a slot's fragments is (t descending, id descending), whatever the batch's order.
//           Relative error of radiance <= 3 * 2^-24 a layer.
void composite(const SurfaceBatch& fragments, const int32_t* slot, const float* const fragment_radiance[3],
               const float* opaque_t, int slots, float* const radiance[3], float* transmittance) {
  // Sorted by slot first (counting), so that the comparisons run over the few layers of one slot.
  std::vector<uint32_t> start(static_cast<size_t>(slots) + 2, 0);
  const auto kept = [&](int i) {
    const int32_t s = slot[i];
    return s >= 0 && fragments.valid[i] != 0 && fragments.t[i] <= opaque_t[s];  // NaN is dropped
  };
  for (int i = 0; i < fragments.count; ++i)
    if (kept(i)) ++start[static_cast<size_t>(slot[i]) + 2];
  for (size_t s = 2; s < start.size(); ++s) start[s] += start[s - 1];
  std::vector<uint32_t> order(start.back());
  for (int i = 0; i < fragments.count; ++i)
    if (kept(i)) order[start[static_cast<size_t>(slot[i]) + 1]++] = static_cast<uint32_t>(i);

  for (int s = 0; s < slots; ++s) {
    const auto first = order.begin() + start[static_cast<size_t>(s)], last = order.begin() + start[static_cast<size_t>(s) + 1];
    std::sort(first, last, [&](uint32_t a, uint32_t b) {
      if (fragments.t[a] != fragments.t[b]) return fragments.t[a] > fragments.t[b];
      if (fragments.primitive[a] != fragments.primitive[b]) return fragments.primitive[a] > fragments.primitive[b];
      return a < b;
    });
    float through = 1.0f;
    for (auto it = first; it != last; ++it) {
      const float alpha = fragments.opacity[*it];
      for (int c = 0; c < 3; ++c)
        radiance[c][s] = transparency::alpha::over(alpha, fragment_radiance[c][*it], radiance[c][s]);
      through *= 1.0f - min_(max_(alpha, 0.0f), 1.0f);
    }
    transmittance[s] = through;
  }
}

}  // namespace spanray
