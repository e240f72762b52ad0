#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "support/test_surfaces.h"

namespace spanray {
namespace {

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

TEST(Composite, T3_256LayersWithinOneStepOfDouble) {
  TestRandom random(1);
  double worst = 0;
  for (int trial = 0; trial < 50; ++trial) {
    const double top = trial % 2 ? 1.0 : 0.05;  // opaque stacks, and glassy ones where each layer is seen
    Layers l(256, 1);
    std::vector<int> by_t(256);
    for (int i = 0; i < 256; ++i) l.set(i, static_cast<float>(random.uniform(1, 2)), static_cast<float>(random.uniform(0, top)),
                                        static_cast<float>(random.uniform(0, 2)));
    l.out.channel[0][0] = l.out.channel[1][0] = l.out.channel[2][0] = 0.7f;
    std::iota(by_t.begin(), by_t.end(), 0);
    std::sort(by_t.begin(), by_t.end(), [&](int a, int b) {
      return l.fragments.t[a] != l.fragments.t[b] ? l.fragments.t[a] > l.fragments.t[b] : a > b;
    });
    double want = 0.7f, through = 1;
    for (const int i : by_t) {
      const double a = l.fragments.opacity[i];
      want = a * l.light.channel[0][static_cast<size_t>(i)] + (1 - a) * want;
      through *= 1 - a;
    }
    l.run();
    worst = std::max(worst, l.out.max_encoded_difference(0, glm::dvec3(want)));
    EXPECT_NEAR(l.out.channel[2][0], want, 256 * 0x1p-23);
    EXPECT_NEAR(l.transmittance[0], through, through * 256 * 0x1p-23 + 1e-36);
  }
  EXPECT_LE(worst, 1.0 / 255);
}

TEST(Composite, T2_CoplanarLayersFollowTheirIds) {
  TestRandom random(2);
  std::vector<int> place(20);
  std::iota(place.begin(), place.end(), 0);
  float want = 0;
  for (int trial = 0; trial < 30; ++trial) {
    // The same twenty layers in any order of the batch: equal t, ids 0 to 19, the lowest on top.
    Layers l(20, 1);
    for (int id = 0; id < 20; ++id) {
      const int i = place[static_cast<size_t>(id)];
      l.set(i, 3.0f, 0.5f, static_cast<float>(id + 1));
      l.fragments.primitive[i] = static_cast<uint32_t>(id);
    }
    l.run();
    if (trial == 0) {
      want = l.out.channel[0][0];
      float by_hand = 0;
      for (int id = 19; id >= 0; --id) by_hand = 0.5f * static_cast<float>(id + 1) + 0.5f * by_hand;
      EXPECT_EQ(want, by_hand);
    }
    EXPECT_EQ(l.out.channel[0][0], want);
    for (size_t i = 19; i > 0; --i) std::swap(place[i], place[static_cast<size_t>(random.below(static_cast<int>(i) + 1))]);
  }
}

TEST(Composite, T5_AlphaZeroAndOneAreIdentities) {
  const float odd[] = {0.0f, -0.0f, INFINITY, 1e-45f, 3e38f, 0.1f};
  for (const float behind : odd)
    for (const float layer : odd) {
      for (const float alpha : {0.0f, 1.0f}) {
        Layers l(1, 1);
        l.set(0, 1, alpha, layer);
        for (auto& c : l.out.channel) c[0] = behind;
        l.run();
        const float want = alpha == 0 ? behind : layer;
        for (auto& c : l.out.channel) EXPECT_EQ(std::memcmp(&c[0], &want, 4), 0) << behind << " " << layer << " " << alpha;
        EXPECT_EQ(l.transmittance[0], 1 - alpha);
      }
    }
  // Any stack under an opaque layer does not matter; transparent layers in between do not either.
  TestRandom random(3);
  Layers with(9, 1), without(4, 1);
  for (int i = 0; i < 4; ++i) {
    const float t = static_cast<float>(i + 1), alpha = i == 2 ? 1.0f : 0.3f, light = static_cast<float>(random.uniform());
    with.set(2 * i, t, alpha, light);
    with.set(2 * i + 1, t + 0.5f, 0.0f, 99.0f);
    without.set(i, t, alpha, light);
  }
  with.set(8, 9.0f, 0.7f, 1e30f);
  with.run(), without.run();
  EXPECT_TRUE(with.out == without.out);
  EXPECT_EQ(with.transmittance[0], 0);
}

TEST(Composite, DropsWhatIsBehindAndWhatHasNoSlot) {
  Layers l(6, 3);
  l.opaque_t = {2.0f, 5.0f, INFINITY};
  l.out.channel[0] = {0.25f, 0.25f, 0.25f};
  for (int i = 0; i < 6; ++i) l.set(i, 2.0f, 0.5f, 1.0f);
  l.slot = {0, 0, -1, 0, 0, 1};
  l.fragments.t[1] = 2.0000002f;  // behind
  l.fragments.t[3] = NAN;
  l.fragments.valid[4] = 0;
  l.run();
  EXPECT_EQ(l.out.channel[0][0], 0.625f) << "a fragment at the very depth of the opaque surface is seen";
  EXPECT_EQ(l.out.channel[0][1], 0.625f);
  EXPECT_EQ(l.out.channel[0][2], 0.25f);
  EXPECT_EQ(l.transmittance, (std::vector<float>{0.5f, 0.5f, 1.0f}));
  Layers none(0, 2);
  none.run();
  EXPECT_EQ(none.transmittance, (std::vector<float>{1.0f, 1.0f}));
}

TEST(Composite, SlotsDoNotDependOnTheOrderOfTheBatch) {
  TestRandom random(4);
  constexpr int kCount = 3000, kSlots = 300;
  Layers a(kCount, kSlots), b(kCount, kSlots);
  std::vector<int> place(kCount);
  std::iota(place.begin(), place.end(), 0);
  for (size_t i = kCount - 1; i > 0; --i) std::swap(place[i], place[static_cast<size_t>(random.below(static_cast<int>(i) + 1))]);
  for (int i = 0; i < kCount; ++i) {
    const int j = place[static_cast<size_t>(i)];
    const float t = static_cast<float>(random.below(10) + 1), alpha = static_cast<float>(random.uniform()), light = static_cast<float>(random.uniform());
    a.set(i, t, alpha, light), b.set(j, t, alpha, light);
    a.slot[static_cast<size_t>(i)] = b.slot[static_cast<size_t>(j)] = random.below(kSlots);
    a.fragments.primitive[i] = b.fragments.primitive[j] = static_cast<uint32_t>(i);
  }
  for (int s = 0; s < kSlots; ++s) a.opaque_t[static_cast<size_t>(s)] = b.opaque_t[static_cast<size_t>(s)] = static_cast<float>(random.below(12));
  a.run(), b.run();
  EXPECT_TRUE(a.out == b.out);
  EXPECT_EQ(a.transmittance, b.transmittance);
}

}  // namespace
}  // namespace spanray
