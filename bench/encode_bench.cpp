// Linear radiance to sRGB bytes, one thread.
#include "frozen_frame.h"
#include "image/encode.h"

namespace spanray::bench {
namespace {

void encode(benchmark::State& state) {
  constexpr int kCount = 1280;
  AlignedBuffer<float> channel[3];
  uint32_t random = 1;
  for (auto& c : channel) {
    c.resize(kCount);
    for (float& value : c) random = random * 1664525u + 1013904223u, value = static_cast<float>(random >> 8) * (1.2f / 16777216.0f);
  }
  const float* const rows[3] = {channel[0].data(), channel[1].data(), channel[2].data()};
  std::vector<uint8_t> rgba(4 * kCount);
  for (auto _ : state) {
    for (int y = 0; y < 720; ++y) encode_row(isa_of(state), rows, kCount, rgba.data());
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * kCount * 720);  // pixels
}
BENCHMARK(encode)->Apply(each_isa);

}  // namespace
}  // namespace spanray::bench
