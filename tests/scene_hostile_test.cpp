// Hostile input that is too large to be kept as a file in tests/hostile (see hostile_files_test.cpp), or is no file at all.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "support/scene_files.h"
#include "support/scene_invariants.h"

namespace spanray {
namespace {

namespace fs = std::filesystem;

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
  const std::string v3 = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  return {
      {"index of a thousand digits", v3 + "f 1 2 " + repeat("9", 1000) + "\n", 4, "too large"},
      {"one word of a megabyte", repeat("x", 1 << 20), 1, "not a Wavefront OBJ"},
      {"number of a megabyte", "v " + repeat("1", 1 << 20) + " 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", kLoads,
       "1 triangle dropped"},
      {"zeros of a megabyte", "v 0." + repeat("0", 1 << 20) + "1 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", kLoads, ""},
      {"corner of a megabyte", v3 + "f 1 2 " + repeat("1", 1 << 20) + "\n", 4, "too large"},
      {"spaces of a megabyte", v3 + "f 1 2 " + repeat(" ", 1 << 20) + "3\n", kLoads, ""},
      {"comment of four megabytes", v3 + "#" + repeat("#", 1 << 22) + "\nf 1 2 9\n", 5, "vertex index 9"},
      {"face of 300,000 corners", v3 + "f" + repeat(" 1 2 3", 100000) + "\n", kLoads, ""},
      {"line of continuations", v3 + "f 1 2 " + repeat("\\\n", 100000) + "3\n", kLoads, ""},
      {"a million newlines", repeat("\n", 1 << 20) + "f 1\n", kLoads, "1048577: warning: 1 face with fewer than 3"},
      {"a million groups", repeat("g a\n", 1 << 20) + v3 + "f 1 2 9\n", (1 << 20) + 4, "vertex index 9"},
      {"material names of a megabyte", v3 + "usemtl " + repeat("m", 1 << 20) + "\nf 1 2 3\n", kLoads, "is not defined"},
      {"mtllib with a long name", "mtllib " + repeat("n", 5000) + "\n" + v3 + "f 1 2 3\n", kLoads, "not found"},
      {"mtllib of many words", "mtllib " + repeat("n ", 5000) + "\n" + v3 + "f 1 2 3\n", kLoads, "more messages left out"},
      {"many undefined materials",
       v3 +
           [] {
             std::string t;
             for (int i = 0; i < 5000; ++i) t += "usemtl m" + std::to_string(i) + "\nf 1 2 3\n";
             return t;
           }(),
       kLoads, "more messages left out"},
  };
}

// Convex, star-shaped, and a comb: the worst for ear clipping. Far above what is cut exactly, never slow.
TEST(HostileObj, PolygonsOfAHundredThousandCorners) {
  constexpr int kCorners = 100000;
  const TempFolder folder;
  for (const bool comb : {false, true}) {
    std::string text;
    for (int i = 0; i < kCorners; ++i)
      text += comb ? "v " + std::to_string(i) + (i % 2 == 0 ? " 0 0\n" : " 9 0\n")
                   : "v " + std::to_string(i) + " " + std::to_string(static_cast<double>(i) * i * 1e-6) + " 0\n";
    text += "f";
    for (int i = 1; i <= kCorners; ++i) text += " " + std::to_string(i);
    const Loaded l = must_load(folder.write("a.obj", text + "\n"));
    EXPECT_EQ(broken_promise(l.scene()), "");
    EXPECT_GT(l.scene().triangles.size(), static_cast<size_t>(kCorners / 2));
    EXPECT_LE(l.scene().triangles.size(), static_cast<size_t>(kCorners - 2));
  }
}

TEST(HostileObj, ErrorWithFileLineAndCauseOrASoundScene) {
  const TempFolder folder;
  const std::vector<HostileObj> cases = hostile_objs();
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
    EXPECT_EQ(broken_promise(l.scene()), "");
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
      obj + "x = \"" + repeat("y", 1 << 20),
      "obj = \"" + repeat("../", 100000) + "a.obj\"\n",
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
  const std::string cases[] = {
      "newmtl m\nmap_Kd " + repeat("-o 1 1 1 ", 50000) + "x\n",
      "newmtl m\nmap_Kd " + repeat("y", 1 << 20) + "\n",
      "newmtl " + repeat("n", 1 << 20) + "\n",
      "newmtl " + repeat("n", 1 << 20) + "\nKd -1 0 0\n",
      "newmtl m\nKd " + repeat("9", 1 << 20) + " 0 0\n",
      repeat("newmtl m\n", 20000),
      repeat("garbage\n", 20000),
  };
  for (const std::string& text : cases) {
    SCOPED_TRACE(text.substr(0, 60));
    folder.write("a.mtl", text);
    const Loaded l = must_load(folder.write("a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n"));
    EXPECT_EQ(broken_promise(l.scene()), "");
    EXPECT_EQ(l.scene().triangles.size(), 1u);
    EXPECT_LT(l.loaded.messages.size(), 300u);
    for (const std::string& m : l.loaded.messages) EXPECT_LT(m.size(), 600u);
  }
}

}  // namespace
}  // namespace spanray
