// MTL files: every field, every option, and what is missing or wrong.
#include <gtest/gtest.h>

#include <filesystem>

#include "math/color.h"
#include "support/encode_fixture.h"
#include "support/scene_files.h"

namespace spanray {
namespace {

namespace fs = std::filesystem;

// A triangle with material `m`, its MTL given by `mtl`.
class MaterialTest : public ::testing::Test {
 protected:
  Loaded load(const std::string& mtl, const LoadOptions& options = {}) {
    folder_.write("a.mtl", mtl);
    return must_load(folder_.write("a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n"), options);
  }
  Material material(const std::string& lines) {
    const Loaded l = load("newmtl m\n" + lines);
    EXPECT_EQ(l.scene().materials.size(), 1u);
    return l.scene().materials.at(0);
  }
  // rgb(a) of a 2 x 1 PNG.
  void write_png(const std::string& name, const std::string& pixels = std::string("\x10\x20\x30\x40\x50\x60", 6)) {
    PngFixture f;
    f.width = 2;
    if (pixels.size() == 8) f.color = PNG_COLOR_TYPE_RGBA;
    folder_.write(name, encode_png_fixture(f, {pixels}));
  }
  TempFolder folder_;
};

bool equal3(const float* v, float r, float g, float b) { return v[0] == r && v[1] == g && v[2] == b; }

TEST_F(MaterialTest, AllNumbers) {
  const Material m = material(
      "Ka 0.1 0.2 0.3\n\tKd 0.4 0.5 0.6 # comment\nKs 0.7 0.8 0.9\nKe 1 2 3\nTf 0.5 0.25 0.125\nNs 42.5\nNi 1.33\nd 1\nillum "
      "2\n");
  EXPECT_TRUE(equal3(m.ambient, 0.1f, 0.2f, 0.3f));
  EXPECT_TRUE(equal3(m.diffuse, 0.4f, 0.5f, 0.6f));
  EXPECT_TRUE(equal3(m.specular, 0.7f, 0.8f, 0.9f));
  EXPECT_TRUE(equal3(m.emission, 1, 2, 3));
  EXPECT_TRUE(equal3(m.transmission_filter, 0.5f, 0.25f, 0.125f));
  EXPECT_TRUE(equal3(m.mirror, 0, 0, 0));
  EXPECT_EQ(m.shininess, 42.5f);
  EXPECT_EQ(m.index_of_refraction, 1.33f);
  EXPECT_EQ(m.transparency, static_cast<int32_t>(MaterialTransparency::kOpaque));
}

TEST_F(MaterialTest, AbsentFieldsHaveTheirDefaults) {
  EXPECT_TRUE(equal3(material("").diffuse, 0.8f, 0.8f, 0.8f));
  EXPECT_TRUE(equal3(material("Kd 0.1 0.2 0.3\n").ambient, 0.1f, 0.2f, 0.3f));
  EXPECT_TRUE(equal3(material("Kd 0.1 0.2 0.3\nKa 0 0 0\n").ambient, 0.1f, 0.2f, 0.3f));
  EXPECT_TRUE(equal3(material("Kd 0.5\n").diffuse, 0.5f, 0.5f, 0.5f));
  write_png("t.png");
  EXPECT_TRUE(equal3(material("map_Kd t.png\n").diffuse, 1, 1, 1));
}

TEST_F(MaterialTest, IllumDecidesWhatIsModelled) {
  const std::string colors = "Kd 0.5 0.5 0.5\nKs 0.2 0.3 0.4\n";
  for (const int illum : {3, 5, 8})
    EXPECT_TRUE(equal3(material(colors + "illum " + std::to_string(illum)).mirror, 0.2f, 0.3f, 0.4f)) << illum;
  for (const int illum : {0, 1, 2, 4, 6, 7, 9, 10})
    EXPECT_TRUE(equal3(material(colors + "illum " + std::to_string(illum)).mirror, 0, 0, 0)) << illum;
  EXPECT_TRUE(equal3(material(colors + "illum 1\n").specular, 0, 0, 0));
  EXPECT_TRUE(equal3(material("Ks 2 2 2\nillum 3\n").mirror, 1, 1, 1)) << "Y12: throughput never grows";
  const Material constant = material(colors + "Ke 1 0 0\nillum 0\n");
  EXPECT_TRUE(equal3(constant.emission, 1.5f, 0.5f, 0.5f));
  EXPECT_TRUE(equal3(constant.diffuse, 0, 0, 0) && equal3(constant.ambient, 0, 0, 0) && equal3(constant.specular, 0, 0, 0));
  EXPECT_EQ(load("newmtl m\nillum 10\n").count({"a.mtl:2:", "illum 10"}), 1);
  EXPECT_EQ(load("newmtl m\n\nillum 77\n").count({"a.mtl:3:", "illum 77"}), 1);
  EXPECT_EQ(load("newmtl m\nillum 1.5\n").count({"a.mtl:2:", "illum 1.5"}), 1);
}

TEST_F(MaterialTest, OpacityFromDAndTr) {
  const int32_t alpha = static_cast<int32_t>(MaterialTransparency::kAlpha);
  EXPECT_EQ(material("d 0.25\n").opacity, 0.25f);
  EXPECT_EQ(material("d 0.25\n").transparency, alpha);
  EXPECT_EQ(material("d -halo 0.25\n").opacity, 0.25f);
  EXPECT_EQ(material("Tr 0.25\n").opacity, 0.75f);
  EXPECT_EQ(material("illum 4\nd 0.5\n").transparency, alpha);
  for (const char* both : {"newmtl m\nd 1\nTr 1\n", "newmtl m\nTr 1\nd 1\n"}) {
    const Loaded l = load(both);
    EXPECT_EQ(l.scene().materials[0].opacity, 1.0f);
    EXPECT_EQ(l.count({"a.mtl:", "disagree"}), 1) << l.all_messages();
  }
  EXPECT_EQ(load("newmtl m\nd 0.3\nTr 0.7\n").count({"disagree"}), 0);
  EXPECT_EQ(load("newmtl m\nd 7\n").scene().materials[0].opacity, 1.0f);
}

TEST_F(MaterialTest, MapDIsAMask) {
  write_png("t.png");
  const Loaded l = load("newmtl m\nd 0.5\nmap_d t.png\n");
  EXPECT_EQ(l.scene().materials[0].transparency, static_cast<int32_t>(MaterialTransparency::kMask));
  EXPECT_EQ(l.scene().materials[0].opacity, 1.0f);
  EXPECT_EQ(l.count({"a.mtl:2:", "map_d"}), 1);
  EXPECT_EQ(l.scene().texture_uses[0].channel, -1);
  write_png("alpha.png", std::string("\1\2\3\0\1\2\3\377", 8));
  const Loaded with_alpha = load("newmtl m\nmap_d alpha.png\n");
  EXPECT_EQ(with_alpha.scene().texture_uses[0].channel, 3);
  EXPECT_EQ(load("newmtl m\nmap_d -imfchan r alpha.png\n").scene().texture_uses[0].channel, 0);
  const Loaded missing = load("newmtl m\nmap_d nowhere.png\n");
  EXPECT_EQ(missing.scene().materials[0].transparency, static_cast<int32_t>(MaterialTransparency::kOpaque));
}

TEST_F(MaterialTest, ValuesOutOfRangeAreClampedWithAWarning) {
  const Loaded l = load("newmtl m\nKd 2 0.5 -1\nNs 1e30\nKs -1 0 0\n");
  const Material& m = l.scene().materials[0];
  EXPECT_TRUE(equal3(m.diffuse, 1, 0.5f, 0));
  EXPECT_EQ(m.shininess, 1e4f);
  EXPECT_TRUE(equal3(m.specular, 0, 0, 0));
  EXPECT_EQ(l.count({"a.mtl:2:", "Kd"}), 2) << l.all_messages();
  EXPECT_EQ(l.count({"a.mtl:3:", "Ns"}), 1);
  EXPECT_EQ(material("Ns -5\n").shininess, 0.0f);
}

TEST_F(MaterialTest, WordsAndNotFiniteNumbersAreLeftOutWithAWarning) {
  const Loaded l = load("newmtl m\nKd nan 0 0\nKs red\nNs inf\nNi\nKe spectral x.rfl\nd 1e99\n");
  const Material& m = l.scene().materials[0];
  EXPECT_TRUE(equal3(m.diffuse, 0.8f, 0.8f, 0.8f));
  EXPECT_EQ(m.shininess, 1.0f);
  for (int line = 2; line <= 7; ++line)
    EXPECT_EQ(l.count({("a.mtl:" + std::to_string(line) + ":").c_str()}), 1) << line << "\n" << l.all_messages();
}

TEST_F(MaterialTest, AllMapsAndOptions) {
  for (const char* n : {"1.png", "2.png", "3.png"}) write_png(n);
  const Loaded l = load(
      "newmtl m\nmap_Ka 1.png\nmap_Kd -o 0.5 -0.25 0 -s 2 3 1 -clamp on 2.png\nmap_Ks -mm 0.25 0.5 3.png\nmap_Ns -imfchan g "
      "1.png\nmap_Ke 2.png\n"
      "map_d -imfchan l 3.png\nmap_Bump -bm 0.125 1.png\nnorm -blendu off -cc on 2.png\n");
  ASSERT_EQ(l.count({"warning"}), 0) << l.all_messages();
  const Material& m = l.scene().materials[0];
  const auto use = [&](int32_t slot) { return l.scene().texture_uses.at(static_cast<size_t>(slot)); };
  EXPECT_EQ(use(m.map_diffuse).offset[0], 0.5f);
  EXPECT_EQ(use(m.map_diffuse).offset[1], -0.25f);
  EXPECT_EQ(use(m.map_diffuse).scale[0], 2.0f);
  EXPECT_EQ(use(m.map_diffuse).scale[1], 3.0f);
  EXPECT_EQ(use(m.map_diffuse).clamp, 1);
  EXPECT_EQ(use(m.map_ambient).clamp, 0);
  EXPECT_EQ(use(m.map_specular).base, 0.25f);
  EXPECT_EQ(use(m.map_specular).gain, 0.5f);
  EXPECT_EQ(use(m.map_shininess).channel, 1);
  EXPECT_EQ(use(m.map_opacity).channel, 4);
  EXPECT_EQ(use(m.map_bump).bump_multiplier, 0.125f);
  // 1.png and 3.png as color and as data, 2.png too: each file once a kind.
  EXPECT_EQ(l.scene().textures.size(), 6u);
  EXPECT_EQ(use(m.map_shininess).texture, use(m.map_bump).texture);
  EXPECT_NE(use(m.map_ambient).texture, use(m.map_bump).texture);
  EXPECT_EQ(use(m.map_diffuse).texture, use(m.map_emission).texture);
}

TEST_F(MaterialTest, AmbientFollowsTheDiffuseTexture) {
  write_png("t.png");
  const Material m = material("map_Kd t.png\n");
  EXPECT_GE(m.map_diffuse, 0);
  EXPECT_EQ(m.map_ambient, -1);  // shares map_Kd
  EXPECT_EQ(material("map_Kd t.png\nmap_Ka t.png\n").map_ambient, -1) << "the same map";
  EXPECT_GE(material("map_Kd t.png\nmap_Ka -s 2 t.png\n").map_ambient, 0) << "one of its own";
}

TEST_F(MaterialTest, OptionsThatAreWrongOrUnknown) {
  write_png("t.png");
  EXPECT_EQ(load("newmtl m\nmap_Kd -nonsense t.png\n").count({"a.mtl:2:", "-nonsense"}), 1);
  EXPECT_EQ(load("newmtl m\nmap_Kd -s t.png\n").count({"a.mtl:2:", "-s"}), 1);
  EXPECT_EQ(load("newmtl m\nmap_Kd -imfchan q t.png\n").count({"a.mtl:2:", "-imfchan"}), 1);
  EXPECT_EQ(load("newmtl m\nmap_Kd -s 1 1 1\n").count({"a.mtl:2:"}), 1);
  EXPECT_EQ(load("newmtl m\nmap_Kd\n").count({"a.mtl:2:", "without a file name"}), 1);
  EXPECT_EQ(load("newmtl m\nmap_Kd -o\n").count({"a.mtl:2:", "without a"}), 2);
}

TEST_F(MaterialTest, FileNamesAsOtherSystemsWriteThem) {
  fs::create_directories(folder_.file("Textures/Deep"));
  write_png("Textures/Deep/Stone Wall.PNG");
  for (const char* name : {"Textures/Deep/Stone Wall.PNG", "textures\\deep\\stone wall.png", "TEXTURES//deep/./Stone Wall.png",
                           "\"Textures/Deep/Stone Wall.PNG\"", ".\\Textures\\..\\textures\\Deep\\stone WALL.png",
                           "-s 2 2 textures\\deep\\stone wall.png", "Textures/Deep/Stone Wall.PNG # wall"}) {
    const Loaded l = load(std::string("newmtl m\r\nmap_Kd ") + name + "\r\n");
    EXPECT_GE(l.scene().materials[0].map_diffuse, 0) << name << "\n" << l.all_messages();
  }
}

TEST_F(MaterialTest, TheExactNameWinsOverAnotherCase) {
  write_png("T.png", std::string("\0\0\0\0\0\0", 6));
  write_png("t.png", std::string("\377\377\377\377\377\377", 6));
  EXPECT_EQ(load("newmtl m\nmap_Kd t.png\n").scene().texels[0].r, 65535);
  EXPECT_EQ(load("newmtl m\nmap_Kd T.png\n").scene().texels[0].r, 0);
}

TEST_F(MaterialTest, FilesOutsideTheFolderNeedPermission) {
  const TempFolder other;
  PngFixture f;
  const std::string outside = other.write("o.png", encode_png_fixture(f, {std::string("\1\2\3", 3)}));
  fs::create_symlink(outside, folder_.file("link.png"));
  const std::string up = "../" + fs::path(other.path()).filename().string() + "/o.png";
  LoadOptions permitted;
  permitted.allow_outside = true;
  for (const std::string& name : {outside, up, std::string("link.png")}) {
    const Loaded refused = load("newmtl m\nmap_Kd " + name + "\n");
    EXPECT_EQ(refused.scene().textures.size(), 0u) << name;
    EXPECT_EQ(refused.count({"a.mtl:2:", "outside"}), 1) << refused.all_messages();
    EXPECT_EQ(load("newmtl m\nmap_Kd " + name + "\n", permitted).scene().textures.size(), 1u) << name;
  }
  EXPECT_EQ(load("newmtl m\nmap_Kd C:\\textures\\x.png\n").count({"a.mtl:2:", "outside"}), 1);
}

TEST_F(MaterialTest, MissingOrBrokenTexturesAreWarningsWithFileLineAndCause) {
  write_png("good.png");
  folder_.write("text.png", "this is no picture");
  folder_.write("empty.png", "");
  fs::create_directory(folder_.file("folder.png"));
  std::string bytes = encode_png_fixture({}, {std::string("\1\2\3", 3)});
  folder_.write("short.png", bytes.substr(0, bytes.size() / 2));
  const Loaded l =
      load("newmtl m\nmap_Kd none.png\nmap_Ks text.png\nmap_Ke empty.png\nmap_Ns folder.png\nbump short.png\nnorm good.png\n");
  for (int line = 2; line <= 6; ++line)
    EXPECT_EQ(l.count({"warning", ("a.mtl:" + std::to_string(line) + ":").c_str()}), 1) << l.all_messages();
  const Material& m = l.scene().materials[0];
  EXPECT_EQ(m.map_diffuse, -1);
  EXPECT_EQ(m.map_bump, -1);
  EXPECT_GE(m.map_normal, 0);
  EXPECT_EQ(l.scene().textures.size(), 1u);
}

TEST_F(MaterialTest, LibrariesAndNamesThatAreMissing) {
  const Loaded no_library = must_load(
      folder_.write("b.obj", "mtllib none.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n\nusemtl gone\nf 1 2 3\nusemtl gone\nf 3 2 1\n"));
  EXPECT_EQ(no_library.count({"b.obj:1:", "none.mtl"}), 1) << no_library.all_messages();
  EXPECT_EQ(no_library.count({"b.obj:6:", "'gone'"}), 1);
  EXPECT_EQ(no_library.scene().materials.size(), 1u);
  const Loaded l = load("newmtl other\nKd 1 0 0\n");
  EXPECT_EQ(l.count({"a.obj:5:", "'m'"}), 1);
  EXPECT_EQ(l.scene().materials.size(), 2u);
  EXPECT_EQ(material_of(l.scene().triangles[0]), 1u);
}

TEST_F(MaterialTest, LibrariesWithSpacesSeveralNamesAndOtherCase) {
  folder_.write("My Materials.MTL", "newmtl m\nKd 1 0 0\n");
  folder_.write("two.mtl", "newmtl n\nKd 0 1 0\nnewmtl m\nKd 0 0 1\n");
  const std::string tail = "\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n";
  for (const char* line : {"mtllib my materials.mtl", "mtllib .\\My Materials.MTL", "mtllib \"My Materials.MTL\""}) {
    const Loaded l = must_load(folder_.write("b.obj", line + tail));
    EXPECT_TRUE(equal3(l.scene().materials[0].diffuse, 1, 0, 0)) << line << l.all_messages();
  }
  folder_.write("one.mtl", "newmtl m\nKd 1 0 0\n");
  const Loaded both = must_load(folder_.write("c.obj", "mtllib one.mtl two.mtl one.mtl" + tail));
  EXPECT_EQ(both.scene().materials.size(), 2u);
  EXPECT_EQ(both.count({"two.mtl:3:", "defined twice"}), 1) << both.all_messages();
  EXPECT_TRUE(equal3(both.scene().materials[0].diffuse, 1, 0, 0));
}

TEST_F(MaterialTest, I8_TexelsOfColorsEncodeToTheirBytesAgain) {
  PngFixture f;
  f.width = 256;
  std::string row;
  for (int i = 0; i < 256; ++i) row += std::string(3, static_cast<char>(i));
  folder_.write("ramp.png", encode_png_fixture(f, {row}));
  const Loaded l = load("newmtl m\nmap_Kd ramp.png\nmap_bump ramp.png\n");
  const SceneData& s = l.scene();
  const Texture &color = s.textures.at(0), &data = s.textures.at(1);
  EXPECT_EQ(s.texture_uses.at(1).channel, 1) << "gray: one channel of a height map is enough";
  EXPECT_EQ(color.levels, 9);
  const int32_t rows = s.height_rows.at(1).offset[0];
  EXPECT_EQ(s.height_rows.at(0).offset[0], -1);
  for (int i = 0; i < 258; ++i) EXPECT_EQ(s.heights[static_cast<size_t>(rows + i)], i % 256 * 257) << i;
  for (int i = 0; i < 256; ++i) {
    const Texel c = s.texels[static_cast<size_t>(color.offset[0] + i)], d = s.texels[static_cast<size_t>(data.offset[0] + i)];
    EXPECT_EQ(srgb8_from_linear(static_cast<float>(c.g) / 65535.0f), i);
    EXPECT_EQ(d.b, i * 257);
    EXPECT_EQ(c.a, 65535);
  }
}

}  // namespace
}  // namespace spanray
