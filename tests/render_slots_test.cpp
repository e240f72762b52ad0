// Hits and slots: packing and spreading on every instruction set against a model; and the shortcuts of a frame of which only bytes are wanted
// (chunks that show nothing but background, bytes instead of radiance brought to the slots) show what frames without them show.
#include <gtest/gtest.h>

#include "core/aligned.h"
#include "render/slots_kernel.h"
#include "support/sphere_scenes.h"

namespace spanray {
namespace {

struct Slots {
  AlignedBuffer<uint32_t> primitive, pixel;
  std::vector<uint32_t> hits;  // slots

  Slots(int count, double share, TestRandom& random) : primitive(static_cast<size_t>(count)), pixel(static_cast<size_t>(count)) {
    for (size_t i = 0; i < static_cast<size_t>(count); ++i) {
      const bool hit = random.uniform(0, 1) < share;
      primitive[i] = hit ? random.bits() >> 1 : kNoPrimitive, pixel[i] = random.bits();
      if (hit) hits.push_back(static_cast<uint32_t>(i));
    }
  }
};

void check_slots(Isa isa, int count, const Slots& s) {
  constexpr uint32_t kGuard = 0xdeadbeef;
  const size_t n = static_cast<size_t>(count), padding = 16;
  std::vector<uint32_t> slot(n + padding + 1, kGuard), primitive = slot, pixel = slot, words = slot;
  ASSERT_EQ(pick_slots(isa, s.primitive.data(), s.pixel.data(), count, slot.data(), primitive.data(), pixel.data()), static_cast<int>(s.hits.size()));
  for (size_t k = 0; k < s.hits.size(); ++k) {
    ASSERT_EQ(slot[k], s.hits[k]);
    ASSERT_EQ(primitive[k], s.primitive[s.hits[k]]);
    ASSERT_EQ(pixel[k], s.pixel[s.hits[k]]);
  }
  AlignedBuffer<uint32_t> values(s.hits.size());
  for (size_t k = 0; k < s.hits.size(); ++k) values[k] = s.pixel[s.hits[k]];
  spread_hits(isa, s.primitive.data(), count, values.data(), 7u, words.data());
  for (size_t i = 0; i < n; ++i) ASSERT_EQ(words[i], s.primitive[i] == kNoPrimitive ? 7u : s.pixel[i]) << i;
  for (const auto* out : {&slot, &primitive, &pixel, &words}) ASSERT_EQ(out->back(), kGuard) << "wrote past the padding";
}

TEST(Slots, PackAndSpreadAsAModel) {
  for (const Isa isa : supported_isas()) {
    SCOPED_TRACE(isa_name(isa));
    TestRandom random(1);
    for (int count = 0; count <= 70; ++count)
      for (const double share : {0.0, 0.1, 0.5, 0.9, 1.0}) check_slots(isa, count, Slots(count, share, random));
    for (int i = 0; i < 50; ++i) check_slots(isa, 1024, Slots(1024, random.uniform(0, 1), random));
  }
}

TEST(Slots, FloatsKeepTheirBits) {
  for (const Isa isa : supported_isas()) {
    SCOPED_TRACE(isa_name(isa));
    TestRandom random(2);
    const Slots s(300, 0.6, random);
    AlignedBuffer<float> values(s.hits.size()), out(300);
    for (size_t k = 0; k < s.hits.size(); ++k) values[k] = -0.5f * static_cast<float>(k);
    spread_hits(isa, s.primitive.data(), 300, values.data(), 0.25f, out.data());
    size_t k = 0;
    for (size_t i = 0; i < 300; ++i) ASSERT_EQ(out[i], s.primitive[i] == kNoPrimitive ? 0.25f : values[k++]);
  }
}

Image picture(Renderer& renderer, const Scene& scene, const Camera& camera, const Settings& settings, bool with_depth) {
  Framebuffer out;
  FrameRequest request;
  request.depth = with_depth;  // no shortcut then
  const auto stats = renderer.render(scene, camera, settings, out, request);
  EXPECT_TRUE(stats) << stats.error().to_string();
  return std::move(out.color);
}

// One renderer for all: what a frame leaves behind is none of the next one's.
void expect_same_bytes(const Scene& scene, const Camera& camera) {
  Renderer renderer;
  for (const Reflections reflections : {Reflections::kNone, Reflections::kRay})
    for (const Transparency transparency : {Transparency::kNone, Transparency::kScene})
      for (const ShadingRate rate : {ShadingRate::k1x1, ShadingRate::k2x2})
        for (const int samples : {1, 4})
          for (const Visibility visibility : {Visibility::kRaster, Visibility::kRay}) {
            Settings s = test_settings(203, 129);
            s.reflections = reflections, s.transparency = transparency, s.shading_rate = rate, s.samples = samples, s.visibility = visibility;
            EXPECT_EQ(picture(renderer, scene, camera, s, false).rgba, picture(renderer, scene, camera, s, true).rgba) << camera.eye[2] << " " << samples;
          }
}

// A crowd, near and far away: most chunks see nothing then.
TEST(Slots, PicturesOfBytesAloneAreThoseOfFramesWithAllElse) {
  const Scene scene = crowd();
  for (const double distance : {3.0, 9.0, 40.0}) expect_same_bytes(scene, from_to({0.3, 1.2, distance}, {0, 0.4, 0}));
}

TEST(Slots, APaneOfGlassBeforeNothingIsSeen) {
  Material glass;
  glass.opacity = 0.4f, glass.transparency = static_cast<int32_t>(MaterialTransparency::kAlpha);
  SceneData scene = make_test_scene({soup_triangle({-1, -1, 0}, {1, -1, 0}, {0, 1, 0})}, {glass});
  add_sun(scene, {0, 0, -1});
  expect_same_bytes(finish(std::move(scene)), from_to({0, 0, 4}, {0, 0, 0}));
}

}  // namespace
}  // namespace spanray
