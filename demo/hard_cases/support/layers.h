#pragma once
#include <vector>

#include "support/test_surfaces.h"

namespace spanray {

// Translucent fragments over the opaque surfaces of some rays, filled by hand, and what compositing makes of them.
struct Layers {
  SurfaceBatch fragments;
  std::vector<int32_t> slot;
  TestRadiance light{0};
  std::vector<float> opaque_t, transmittance;
  TestRadiance out{0};

  Layers(int count, int slots) : slot(static_cast<size_t>(count), 0), light(count), opaque_t(static_cast<size_t>(slots), INFINITY),
                                 transmittance(static_cast<size_t>(slots), -1.0f), out(slots) {
    clear_surfaces(fragments, count);
    for (int i = 0; i < count; ++i) fragments.valid[i] = 1, fragments.primitive[i] = static_cast<uint32_t>(i);
  }
  void set(int i, float t, float alpha, float radiance) {
    fragments.t[i] = t, fragments.opacity[i] = alpha;
    for (auto& c : light.channel) c[static_cast<size_t>(i)] = radiance;
  }
  void run() {
    const float* const in[3] = {light.channel[0].data(), light.channel[1].data(), light.channel[2].data()};
    composite(fragments, slot.data(), in, opaque_t.data(), static_cast<int>(opaque_t.size()), out.at().p, transmittance.data());
  }
};

}  // namespace spanray
