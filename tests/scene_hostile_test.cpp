// Hostile and broken input: an error with file, line and cause, or a scene that keeps every invariant. Never a crash or a hang.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <random>

#include "support/encode_fixture.h"
#include "support/scene_files.h"

namespace spanray {
namespace {

namespace fs = std::filesystem;

// Everything that scene_data.h promises.
void check_invariants(const SceneData& s) {
  ASSERT_FALSE(s.materials.empty());
  ASSERT_FALSE(s.cameras.empty());
  ASSERT_EQ(s.materials.size(), s.material_names.size());
  ASSERT_EQ(s.cameras.size(), s.camera_names.size());
  ASSERT_EQ(s.textures.size(), s.texture_names.size());
  ASSERT_LE(s.lights.size(), static_cast<size_t>(kMaxLights));
  for (const Vertex& v : s.vertices) {
    double length = 0;
    for (int k = 0; k < 3; ++k) {
      ASSERT_TRUE(std::isfinite(v.position[k]) && std::isfinite(v.normal[k]));
      ASSERT_TRUE(s.bounds_min[k] <= v.position[k] && v.position[k] <= s.bounds_max[k]);
      length += static_cast<double>(v.normal[k]) * v.normal[k];
    }
    ASSERT_NEAR(length, 1, 1e-6);
    ASSERT_TRUE(std::isfinite(v.uv[0]) && std::isfinite(v.uv[1]));
  }
  for (const Triangle& t : s.triangles) {
    ASSERT_LT(material_of(t), s.materials.size());
    for (const uint32_t i : t.vertex) ASSERT_LT(i, s.vertices.size());
  }
  for (const Material& m : s.materials) {
    for (const float* c : {m.ambient, m.diffuse, m.specular, m.emission, m.mirror})
      for (int k = 0; k < 3; ++k) ASSERT_TRUE(c[k] >= 0 && std::isfinite(c[k]));
    ASSERT_TRUE(m.opacity >= 0 && m.opacity <= 1 && m.shininess >= 0 && m.shininess <= 1e4f);
    for (const int32_t use : {m.map_ambient, m.map_diffuse, m.map_specular, m.map_shininess, m.map_emission, m.map_opacity,
                              m.map_bump, m.map_normal}) {
      ASSERT_LT(use, static_cast<int32_t>(s.texture_uses.size()));
      ASSERT_GE(use, -1);
    }
  }
  for (const TextureUse& u : s.texture_uses) ASSERT_TRUE(u.texture >= 0 && static_cast<size_t>(u.texture) < s.textures.size());
  for (const Camera& c : s.cameras)
    for (int k = 0; k < 3; ++k) ASSERT_TRUE(std::isfinite(c.eye[k]) && std::isfinite(c.target[k]) && c.near_plane > 0);
}

std::string repeat(const std::string& text, int count) {
  std::string out;
  for (int i = 0; i < count; ++i) out += text;
  return out;
}

constexpr int kLoads = -1;  // as a line: the scene loads
struct HostileObj {
  const char* name;
  std::string text;
  int line;
  const char* says;
};

// `says` is part of the error, or of some message of a scene that loads.
std::vector<HostileObj> hostile_objs() {
  const std::string v3 = "v 0 0 0\nv 1 0 0\nv 0 1 0\n", vt = "vt 0 0\n", vn = "vn 0 0 1\n";
  return {
      {"vertex index too large", v3 + "f 1 2 4\n", 4, "vertex index 4 out of range"},
      {"huge index", v3 + "f 1 2 999999999\n", 4, "out of range"},
      {"index that wraps 32 bits to 1", v3 + "f 4294967297 2 3\n", 4, "too large"},
      {"index that wraps 64 bits", v3 + "f 18446744073709551617 2 3\n", 4, "too large"},
      {"index of a thousand digits", v3 + "f 1 2 " + repeat("9", 1000) + "\n", 4, "too large"},
      {"INT_MIN", v3 + "f 1 2 -2147483648\n", 4, "too large"},
      {"negative index too far", v3 + "f -1 -2 -4\n", 4, "vertex index -4 out of range"},
      {"negative index before any vertex", "f -1 -2 -3\n" + v3, 1, "out of range"},
      {"negative index far", v3 + "f -1 -2 -999999999\n", 4, "out of range"},
      {"zero index", v3 + "f 0 1 2\n", 4, "index 0"},
      {"minus zero index", v3 + "f -0 1 2\n", 4, "index 0"},
      {"uv index too large", v3 + vt + "f 1/1 2/2 3/1\n", 5, "texture coordinate index 2 out of range"},
      {"uv index without uvs", v3 + "f 1/1 2/1 3/1\n", 4, "texture coordinate"},
      {"uv index zero", v3 + vt + "f 1/0 2/1 3/1\n", 5, "index 0"},
      {"negative uv index too far", v3 + vt + "f 1/-2 2/1 3/1\n", 5, "texture coordinate"},
      {"normal index too large", v3 + vn + "f 1//1 2//1 3//2\n", 5, "normal index 2 out of range"},
      {"negative normal index too far", v3 + vn + "f 1//-9 2//1 3//1\n", 5, "normal"},
      {"four indices", v3 + vt + vn + "f 1/1/1/1 2/1/1 3/1/1\n", 6, "more than three"},
      {"corner of letters", v3 + "f a b c\n", 4, "face corner 'a'"},
      {"corner with a fraction", v3 + "f 1.5 2 3\n", 4, "face corner"},
      {"corner of slashes", v3 + "f // // //\n", 4, "face corner"},
      {"corner that starts with a slash", v3 + vt + "f /1 2 3\n", 5, "face corner"},
      {"vertex of letters", "v 0 zero 0\n", 1, "'zero' is not a number"},
      {"decimal comma", "\nv 0,5 0 0\n", 2, "'0,5' is not a number"},
      {"hexadecimal", "v 0x10 0 0\n", 1, "not a number"},
      {"two coordinates", "v 0 0\n", 1, "needs 3 numbers"},
      {"no coordinates", "v\n", 1, "needs 3 numbers"},
      {"eight coordinates", "v 1 2 3 4 5 6 7 8\n", 1, "at most 7"},
      {"normal of two", "vn 0 0\n", 1, "needs 3"},
      {"empty uv", "vt\n", 1, "needs 1"},
      {"two signs", "v --1 0 0\n", 1, "not a number"},
      {"exponent alone", "v 1e 0 0\n", 1, "not a number"},
      {"NUL byte", v3 + std::string("f 1 2 3\0 4\n", 11), 4, "binary"},
      {"binary garbage",
       std::string("\x7f"
                   "ELF\2\1\1\0\0\0\0\0\0\0\0\0",
                   16),
       1, "binary"},
      {"a PNG named obj", "\x89PNG\r\n\x1a\nxyz\n", 1, "not a Wavefront OBJ"},
      {"a STL named obj", "solid cube\nfacet normal 0 0 1\n", 1, "not a Wavefront OBJ"},
      {"an XML file", "<?xml version=\"1.0\"?>\n<scene/>\n", 1, "not a Wavefront OBJ"},
      {"one word of a megabyte", repeat("x", 1 << 20), 1, "not a Wavefront OBJ"},
      {"number of a megabyte", "v " + repeat("1", 1 << 20) + " 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", kLoads,
       "1 triangle dropped"},
      {"zeros of a megabyte", "v 0." + repeat("0", 1 << 20) + "1 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", kLoads, ""},
      {"corner of a megabyte", v3 + "f 1 2 " + repeat("1", 1 << 20) + "\n", 4, "too large"},
      {"spaces of a megabyte", v3 + "f 1 2 " + repeat(" ", 1 << 20) + "3\n", kLoads, ""},
      {"face of 300,000 corners", v3 + "f" + repeat(" 1 2 3", 100000) + "\n", kLoads, ""},
      {"line of continuations", v3 + "f 1 2 " + repeat("\\\n", 100000) + "3\n", kLoads, ""},
      {"continuation at the end", v3 + "f 1 2 3\\", kLoads, ""},
      {"a million newlines", repeat("\n", 1 << 20) + "f 1\n", kLoads, "1048577: warning: 1 face with fewer than 3"},
      {"truncated in a number", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nv 1 0 -", 5, "not a number"},
      {"truncated in a face", v3 + "f 1 2", kLoads, "fewer than 3 corners"},
      {"faces with no corner", v3 + "f\nf 1\nf 1 2\nf 1 2 3\n", kLoads, "a.obj:4: warning: 3 faces"},
      {"zero area", v3 + "f 1 1 2\nf 1 2 2\n", kLoads, "2 triangles have no area"},
      {"all one point", "v 1 2 3\nf 1 1 1\nf 1 1 1 1 1\n", kLoads, ""},
      {"only NaN", "v nan nan nan\nf 1 1 1\n", kLoads, "1 triangle dropped"},
      {"largest floats", "v 3.4e38 -3.4e38 0\nv -3.4e38 3.4e38 0\nv 0 0 3.4e38\nf 1 2 3\n", kLoads, ""},
      {"denormals", "v 1e-45 0 0\nv 0 1e-45 0\nv 0 0 1e-45\nf 1 2 3\n", kLoads, ""},
      {"no vertex", "# empty\n", kLoads, "no triangles"},
      {"only spaces", " \n\t\n", kLoads, "no triangles"},
      {"unknown statements", v3 + "curv2 1 2\nxyzzy\nf 1 2 3\n", kLoads,
       "a.obj:4: warning: 2 lines with unknown statements ignored, first 'curv2'"},
      {"material names of a megabyte", v3 + "usemtl " + repeat("m", 1 << 20) + "\nf 1 2 3\n", kLoads, "is not defined"},
      {"material without a name", v3 + "usemtl\nf 1 2 3\n", kLoads, ""},
      {"mtllib without a name", "mtllib\n" + v3 + "f 1 2 3\n", kLoads, "a.obj:1: warning: material library"},
      {"mtllib outside", "mtllib /etc/passwd\n" + v3 + "f 1 2 3\n", kLoads, "outside"},
      {"mtllib above", "mtllib ../../../../etc/passwd\n" + v3 + "f 1 2 3\n", kLoads, "a.obj:1: warning: material library"},
      {"mtllib is the obj", "mtllib a.obj\n" + v3 + "usemtl m\nf 1 2 3\n", kLoads, "unknown statements"},
      {"mtllib is a folder", "mtllib .\n" + v3 + "f 1 2 3\n", kLoads, "directory"},
      {"mtllib with a long name", "mtllib " + repeat("n", 5000) + "\n" + v3 + "f 1 2 3\n", kLoads, "not found"},
      {"mtllib through many folders", "mtllib " + repeat("x/../", 1000) + "a.mtl\n" + v3 + "f 1 2 3\n", kLoads,
       "a.obj:1: warning"},
      {"many mtllib", repeat("mtllib a.mtl\n", 1000), 257, "mtllib"},
      {"many undefined materials",
       v3 +
           [] {
             std::string t;
             for (int i = 0; i < 5000; ++i) t += "usemtl m" + std::to_string(i) + "\nf 1 2 3\n";
             return t;
           }(),
       kLoads, "more messages left out"},
      {"smoothing of letters", v3 + "s many\nf 1 2 3\n", kLoads, "a.obj:4: warning: smoothing"},
      {"smoothing huge", v3 + "s 99999999999\nf 1 2 3\n", kLoads, "a.obj:4: warning: smoothing"},
      {"percent signs", v3 + "usemtl %s%n%d\nf 1 2 3\n", kLoads, "'%s%n%d'"},
      {"escape codes", v3 + "usemtl \x1b[31mred\nf 1 2 3\n", kLoads, "'?[31mred'"},
  };
}

TEST(HostileObj, ErrorWithFileLineAndCauseOrASoundScene) {
  const TempFolder folder;
  const std::vector<HostileObj> cases = hostile_objs();
  EXPECT_GE(cases.size(), 40u);
  for (const HostileObj& c : cases) {
    SCOPED_TRACE(c.name);
    const std::string path = folder.write("a.obj", c.text);
    if (c.line != kLoads) {
      const Error e = must_fail(path);
      EXPECT_EQ(e.line, c.line) << e.to_string();
      EXPECT_EQ(e.file, path);
      EXPECT_NE(e.message.find(c.says), std::string::npos) << e.to_string();
      EXPECT_LT(e.message.size(), 300u);
      continue;
    }
    const Loaded l = must_load(path);
    check_invariants(l.scene());
    EXPECT_GE(l.count({c.says}), 1) << l.all_messages();
    EXPECT_LT(l.loaded.messages.size(), 300u);
  }
}

TEST(HostileFiles, WhatIsNoReadableFile) {
  const TempFolder folder;
  fs::create_directory(folder.file("folder.obj"));
  fs::create_symlink("nowhere.obj", folder.file("dangling.obj"));
  fs::create_symlink("loop.obj", folder.file("loop.obj"));
  const struct {
    std::string path;
    const char* says;
  } cases[] = {
      {folder.file("missing.obj"), "no such file"},
      {folder.file("missing.toml"), "no such file"},
      {folder.file("missing.gltf"), "no such file"},
      {folder.file("folder.obj"), "directory"},
      {folder.path(), "directory"},
      {"", "no such file"},
      {folder.write("empty.obj", ""), "empty"},
      {folder.write("empty.toml", ""), "empty"},
      {folder.write("scene.gltf", "{}"), ".obj or .toml"},
      {folder.write("noextension", "v 0 0 0"), ".obj or .toml"},
      {folder.file("dangling.obj"), "no such file"},
      {folder.file("loop.obj"), "no such file"},
      {"/dev/null", "not a regular file"},
      {std::string("a\0b.obj", 7), ""},
      {std::string(100000, 'x') + ".obj", "no such file"},
  };
  for (const auto& c : cases) {
    const Error e = must_fail(c.path);
    EXPECT_NE(e.message.find(c.says), std::string::npos) << e.to_string();
    EXPECT_EQ(e.file, c.path);
  }
}

TEST(HostileFiles, OptionsOutOfRange) {
  const TempFolder folder;
  const std::string path = folder.write("a.obj", "v 0 0 0\n");
  for (const double angle : {-1.0, 181.0, std::nan("")}) {
    LoadOptions options;
    options.crease_angle_degrees = angle;
    EXPECT_NE(must_fail(path, options).message.find("crease angle"), std::string::npos);
  }
}

TEST(HostileToml, DeepWideAndTruncated) {
  const TempFolder folder;
  folder.write("a.obj", "v 0 0 0\n");
  const std::string obj = "obj = \"a.obj\"\n";
  const std::string cases[] = {
      obj + "x = " + repeat("[", 100000),
      obj + "x = " + repeat("[", 100000) + repeat("]", 100000),
      obj + "x = " + repeat("{a=", 10000) + "1" + repeat("}", 10000),
      obj + "[" + repeat("a.", 50000) + "a]\n",
      obj + "[" + repeat("a.", 4000000) + "a]\n",
      obj + "[" + repeat("a.", 1000) + "a]\n" + repeat("b.", 1000) + "b = " + repeat("{c.c.c = [", 8) + "1" + repeat("]}", 8) +
          "\n",
      obj + "\"" + repeat("k", 1 << 20) + "\" = 1\n",
      obj + "background = [" + repeat("0,", 1 << 18) + "]\n",
      obj + "[=",
      obj + "[.a]",
      obj + "x = {=}",
      obj + "x = \"" + repeat("y", 1 << 20),
      obj + "x = 1e999999999999999999\n",
      obj + "x = 99999999999999999999999\n",
      obj + "[[camera]]\nname = \"\"\"",
      obj + std::string("x = \"\0\"\n", 8),
      "obj = \"" + repeat("../", 100000) + "a.obj\"\n",
      "obj = \"a\\u0000.obj\"\n",
      "obj = \".\"\n",
      "obj = \"s.toml\"\n",
      "obj = \"/dev/zero\"\n",
      "obj = {}\n",
      "\xff\xfe"
      "o\0b\0j\0",
      repeat("#", 1 << 20),
      "[technique]\nshading = \"" + repeat("q", 1 << 20) + "\"\n" + obj,
  };
  for (const std::string& text : cases) {
    const Error e = must_fail(folder.write("s.toml", text));
    EXPECT_FALSE(e.file.empty()) << e.to_string();
    EXPECT_GT(e.line, 0) << e.to_string().substr(0, 200);
    EXPECT_LT(e.message.size(), 400u) << e.message.substr(0, 100);
  }
}

TEST(HostileMtl, AnythingLoadsWithWarnings) {
  const TempFolder folder;
  fs::create_directory(folder.file("f.png"));
  const std::string cases[] = {
      "",
      "newmtl",
      "newmtl\nKd 1 0 0\n",
      "Kd 1 0 0\n",
      "newmtl m\nKd\n",
      "newmtl m\nKd 1e999 nan -inf\n",
      "newmtl m\nillum -2147483649\n",
      "newmtl m\nillum 1e30\n",
      "newmtl m\nNs -1e38\nNi 0\nd nan\nTr 5\n",
      "newmtl m\nmap_Kd f.png\n",
      "newmtl m\nmap_Kd .\n",
      "newmtl m\nmap_Kd ..\n",
      "newmtl m\nmap_Kd /dev/zero\n",
      "newmtl m\nmap_Kd a.obj\n",
      "newmtl m\nmap_Kd -s -s -s x\n",
      "newmtl m\nmap_Kd -mm nan inf x.png\n",
      "newmtl m\nmap_Kd -\n",
      "newmtl m\nmap_Kd " + repeat("-o 1 1 1 ", 50000) + "x\n",
      "newmtl m\nmap_Kd " + repeat("y", 1 << 20) + "\n",
      "newmtl " + repeat("n", 1 << 20) + "\n",
      repeat("newmtl m\n", 20000),
      repeat("garbage\n", 20000),
      std::string("\0\1\2\3\4\5newmtl m\nKd 1\0 1 1\n", 26),
      "newmtl m\nKd 1 1 1\\\n",
      "newmtl m\nbump -bm\n",
      "newmtl m\nmap_d -imfchan\n",
  };
  for (const std::string& text : cases) {
    SCOPED_TRACE(text.substr(0, 60));
    folder.write("a.mtl", text);
    const Loaded l = must_load(folder.write("a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n"));
    check_invariants(l.scene());
    EXPECT_EQ(l.scene().triangles.size(), 1u);
    EXPECT_LT(l.loaded.messages.size(), 300u);
    for (const std::string& m : l.loaded.messages) EXPECT_LT(m.size(), 600u);
  }
}

// Valid files with random bytes changed, removed, repeated or cut off: they load soundly or fail with a message.
TEST(HostileMutations, KeepTheInvariantsOrFail) {
  const TempFolder folder;
  folder.write("t.png", encode_png_fixture({}, {std::string("\1\2\3", 3)}));
  const std::string files[3] = {
      "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.5 1e0\nvt 0 0\nvt 1 1\nvn 0 0 1\nusemtl m\ns 1\nf 1/1/1 2/2/1 "
      "3/1/1 4/2/1\ns off\nf -1 -2 -3\nf 1//1 2//1 5//1\n",
      "newmtl m\nKa 1 1 1\nKd 0.5 0.5 0.5\nKs 1 1 1\nNs 10\nd 0.5\nillum 3\nmap_Kd -s 2 2 1 -o 0.5 0 0 t.png\nbump -bm 2 "
      "-imfchan r t.png\nnewmtl n\nTr 0.25\n",
      "obj = \"a.obj\"\nbackground = [0, 0.5, 1]\n[[camera]]\nname = \"c\"\neye = [0, 1, 3]\ntarget = [0, 1, 0]\nfov_y = "
      "40\n[[light]]\nkind = \"point\"\nposition = [1, 1, 1]\nintensity = [1, 2, 3]\n"
      "[[path]]\ntime = 0\neye = [0, 0, 1]\ntarget = [0, 0, 0]\n[technique]\nshading = \"flat\"\nmax_bounces = "
      "3\n[material.m]\nopacity = 0.5\n"};
  constexpr const char* kNames[3] = {"a.obj", "a.mtl", "s.toml"};
  constexpr std::string_view kInteresting = "0123456789.-+/\\ \n\r\t#\"[]={}enfv,\x00\xff";
  std::mt19937 rng(20240601);
  const char* more = std::getenv("SPANRAY_FUZZ_ROUNDS");  // for longer runs under the sanitizers
  const int rounds = more != nullptr ? std::atoi(more) : 3000;
  int loaded = 0, failed = 0;
  for (int round = 0; round < rounds; ++round) {
    const size_t target = static_cast<size_t>(round % 3);
    std::string text = files[target];
    for (uint32_t edits = 1 + rng() % 4; edits > 0 && !text.empty(); --edits) {
      const size_t at = rng() % text.size();
      switch (rng() % 5) {
        case 0:
          text[at] = kInteresting[rng() % kInteresting.size()];
          break;
        case 1:
          text.erase(at, 1 + rng() % 8);
          break;
        case 2:
          text.insert(at, 1, kInteresting[rng() % kInteresting.size()]);
          break;
        case 3:
          text.insert(at, text.substr(rng() % text.size(), rng() % 40));
          break;
        default:
          if (rng() % 8 == 0) text.resize(at);
          break;
      }
    }
    for (size_t i = 0; i < 3; ++i) folder.write(kNames[i], i == target ? text : files[i]);
    const Result<LoadedScene> result = load_scene(folder.file("s.toml"));
    if (result) {
      ++loaded;
      check_invariants(result.value().scene.data());
    } else {
      ++failed;
      EXPECT_FALSE(result.error().file.empty() || result.error().message.empty()) << text;
    }
    if (::testing::Test::HasFailure()) {
      std::printf("round %d of seed 20240601:\n%s\n", round, text.c_str());
      break;
    }
  }
  EXPECT_GT(loaded, 500);
  EXPECT_GT(failed, 500);
}

}  // namespace
}  // namespace spanray
