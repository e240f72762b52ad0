// Hostile files through the program: exit 1 with one clear message on stderr and nothing on stdout, soon; never a signal.
#include <gtest/gtest.h>

#include <sys/stat.h>

#include <filesystem>

#include "support/expectations.h"
#include "support/program.h"

namespace spanray {
namespace {

namespace fs = std::filesystem;

const std::string kFolder = SPANRAY_SOURCE_DIR "/tests/hostile/";

class ProgramHostile : public ::testing::Test {
 protected:
  Ran run(std::vector<std::string> arguments) { return run_program(std::move(arguments), folder_.path(), {}, 20); }
  std::string copy(const std::string& file) {
    for (const auto& entry : fs::directory_iterator(kFolder + "support"))
      fs::copy(entry.path(), folder_.path(), fs::copy_options::skip_existing);
    const std::string name = fs::path(file).filename().string();
    fs::copy(kFolder + file, folder_.file(name), fs::copy_options::skip_existing);
    return name;
  }
  TempFolder folder_;
};

// Every eighth file of the corpus: what the loaders do with all of them, hostile_files_test.cpp checks in one process.
TEST_F(ProgramHostile, RenderSaysWhatTheLoaderSays) {
  int number = 0, failed = 0, rendered = 0;
  for (const Expectation& e : read_expectations(kFolder + "expectations.txt")) {
    const bool scene = e.file.starts_with("obj/") || e.file.starts_with("toml/");
    if (!scene || number++ % 8 != 0) continue;
    SCOPED_TRACE(e.file);
    const Ran r = run({"render", copy(e.file), "--size", "8x8", "--hash"});
    EXPECT_EQ(r.code, e.outcome == "fails" ? 1 : 0) << r.error;
    EXPECT_EQ(r.out.size(), e.outcome == "fails" ? 0u : 17u);
    EXPECT_NE(r.error.find(e.says), std::string::npos) << r.error;
    ++(r.code == 0 ? rendered : failed);
  }
  EXPECT_GE(failed, 10);
  EXPECT_GE(rendered, 10);
}

TEST_F(ProgramHostile, ScenesTooLargeOrTooSmallForACameraAreNamed) {
  const char* const kCorners[][2] = {{"1e25", "camera coordinate"}, {"1e-20", "near plane"}};
  for (const auto& [corner, says] : kCorners) {
    const std::string x(corner);
    folder_.write("a.obj", "v 0 0 0\nv " + x + " 0 0\nv 0 " + x + " 0\nf 1 2 3\n");
    for (const std::vector<std::string>& command :
         {std::vector<std::string>{"render", "a.obj", "--size", "8x8", "--hash"}, {"why", "a.obj", "1,1", "--size", "8x8"}}) {
      const Ran r = run(command);
      EXPECT_EQ(r.code, 1) << command[0];
      EXPECT_NE(r.error.find("error: a.obj: no camera for this scene: " + std::string(says)), std::string::npos) << r.error;
    }
    EXPECT_EQ(run({"info", "a.obj"}).code, 0) << "it says how large the scene is";
  }
}

TEST_F(ProgramHostile, CompareNamesTheFileThatItCannotRead) {
  for (const char* file : {"png/crc_data.png", "png/largest_interlaced_without_data.png", "compare/ladder_nested_closed.json",
                           "compare/ladder_only_overflow.json", "compare/cut.pfm"}) {
    const std::string name = copy(file);
    const Ran r = run({"compare", name, name});
    EXPECT_EQ(r.code, 1) << file;
    EXPECT_NE(r.error.find(name), std::string::npos) << r.error;
  }
}

TEST_F(ProgramHostile, WhatIsNoFileIsNotWaitedFor) {
  ASSERT_EQ(0, ::mkfifo(folder_.file("pipe.obj").c_str(), 0600));
  ASSERT_EQ(0, ::mkfifo(folder_.file("pipe.json").c_str(), 0600));
  fs::create_directory(folder_.file("folder.obj"));
  fs::create_symlink("/dev/zero", folder_.file("zero.obj"));
  fs::create_symlink("/dev/zero", folder_.file("zero.json"));
  fs::create_symlink("loop.obj", folder_.file("loop.obj"));
  for (const char* scene : {"pipe.obj", "folder.obj", "zero.obj", "loop.obj", "/dev/stdin", "."}) {
    const Ran r = run({"render", scene, "--hash"});
    EXPECT_EQ(r.code, 1) << scene << ": " << r.error;
    EXPECT_NE(r.error.find(scene), std::string::npos) << r.error;
  }
  for (const char* ladder : {"pipe.json", "zero.json"}) EXPECT_EQ(run({"compare", ladder, ladder}).code, 1) << ladder;
}

TEST_F(ProgramHostile, AllowOutsideLetsTexturesLieElsewhere) {
  const TempFolder other;
  fs::copy(kFolder + "support/t.png", other.file("t.png"));
  folder_.write("a.mtl", "newmtl m\nmap_Kd " + other.file("t.png") + "\n");
  folder_.write("a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1\n");
  const Ran refused = run({"info", "a.obj"}), allowed = run({"info", "a.obj", "--allow-outside"});
  EXPECT_EQ(refused.code, 0);
  EXPECT_NE(refused.out.find("outside the scene's folder (see --allow-outside)"), std::string::npos) << refused.out;
  EXPECT_NE(refused.out.find("textures     0"), std::string::npos) << refused.out;
  EXPECT_EQ(allowed.code, 0);
  EXPECT_NE(allowed.out.find("textures     1"), std::string::npos) << allowed.out;
}

}  // namespace
}  // namespace spanray
