#include <gtest/gtest.h>

#include "spanray/settings_text.h"

namespace spanray {
namespace {

template <class E> void check_round_trip(int count) {
  ASSERT_EQ(static_cast<int>(enum_names<E>().size()), count);
  for (int i = 0; i < count; ++i) {
    const E value = static_cast<E>(i);
    EXPECT_STRNE(enum_text(value), "?");
    EXPECT_EQ(enum_from_text<E>(enum_text(value)), value);
  }
  EXPECT_STREQ(enum_text(static_cast<E>(count)), "?");
  EXPECT_FALSE(enum_from_text<E>("").has_value());
  EXPECT_FALSE(enum_from_text<E>("nonsense").has_value());
}

TEST(SettingsText, EveryValueHasOneWordAndTheWordGivesItBack) {
  check_round_trip<Isa>(5);
  check_round_trip<Shading>(3);
  check_round_trip<Shadows>(2);
  check_round_trip<Reflections>(2);
  check_round_trip<Visibility>(2);
  check_round_trip<Filter>(3);
  check_round_trip<Transparency>(4);
  check_round_trip<Culling>(2);
  check_round_trip<Antialiasing>(2);
  check_round_trip<Normals>(2);
  check_round_trip<Powers>(2);
  check_round_trip<ShadingRate>(2);
  check_round_trip<TreeQuality>(2);
  check_round_trip<LightGridUse>(3);
  check_round_trip<ShadowTerminator>(2);
}

TEST(SettingsText, WordsOfTheCommandLine) {
  EXPECT_EQ(enum_choices<Shading>(), "flat|gouraud|phong");
  EXPECT_EQ(enum_choices<Transparency>(), "scene|none|alpha|screen-door");
  EXPECT_EQ(enum_choices<Normals>(), "interpolated|renormalized");
  EXPECT_EQ(enum_choices<Powers>(), "fast|exact");
  EXPECT_EQ(enum_choices<ShadingRate>(), "2x2|1x1");
  EXPECT_EQ(enum_choices<ShadowTerminator>(), "off|lifted");
  EXPECT_EQ(enum_from_text<Transparency>("screen-door"), Transparency::kScreenDoor);
  EXPECT_FALSE(enum_from_text<Shading>("Phong").has_value());
}

TEST(SettingsText, NearestWordIsOfferedOnlyIfNear) {
  const std::vector<std::string> known = enum_words<Shading>();
  EXPECT_EQ(nearest_word("pohng", known), "phong");
  EXPECT_EQ(nearest_word("Gourad", known), "gouraud");
  EXPECT_EQ(nearest_word("wireframe", known), "");
  EXPECT_EQ(nearest_word("fov", {"eye", "fov_y"}), "fov_y");
  EXPECT_EQ(nearest_word("f", {"eye", "fov_y"}), "");
  EXPECT_EQ(nearest_word(std::string(1000000, 'p'), known), "");
  EXPECT_EQ(did_you_mean("flt", known), " (did you mean 'flat'?)");
  EXPECT_EQ(did_you_mean("xyz", known), "");
}

}  // namespace
}  // namespace spanray
