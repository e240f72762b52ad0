#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "support/layers.h"

namespace spanray {
namespace {

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
