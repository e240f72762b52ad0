// How the program ends and speaks: exit codes, wrong usage, bad input.
#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/stat.h>

#include <fstream>

#include "support/program.h"
#include "support/small_scene.h"

namespace spanray {
namespace {

class Program : public ::testing::Test {
 protected:
  void SetUp() override { scene_ = write_small_scene(folder_); }
  Ran run(std::vector<std::string> arguments, const std::vector<std::string>& environment = {}) {
    return run_program(std::move(arguments), folder_.path(), environment);
  }
  // Wrong usage: exit 2, every word in the message, nothing on standard output.
  void expect_usage(const std::vector<std::string>& arguments, const std::vector<std::string>& words) {
    expect_failure(2, arguments, words);
  }
  void expect_failure(int code, const std::vector<std::string>& arguments, const std::vector<std::string>& words) {
    const int before = folder_.entries();
    const Ran ran = run(arguments);
    std::string line;
    for (const std::string& argument : arguments) line += " " + argument;
    EXPECT_EQ(code, ran.code) << line << "\n" << ran.error;
    EXPECT_EQ("", ran.out) << line;
    for (const std::string& word : words) EXPECT_NE(std::string::npos, ran.error.find(word)) << line << "\n" << ran.error;
    EXPECT_EQ(before, folder_.entries()) << line << ": a file was left behind";
  }
  TempFolder folder_;
  std::string scene_;
};

using ProgramUsage = Program;
using ProgramBadInput = Program;

TEST_F(ProgramUsage, VersionAndHelpGoToStandardOutput) {
  const Ran version = run({"--version"});
  EXPECT_EQ(0, version.code);
  for (const char* word : {"spanray ", "numeric_contract ", "compiler ", "instruction_sets scalar"})
    EXPECT_NE(std::string::npos, version.out.find(word)) << version.out;
  EXPECT_EQ("", version.error);
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{"--help"}, {"render", "--help"}, {"walk", "--help"}}) {
    const Ran help = run(arguments);
    EXPECT_EQ(0, help.code);
    EXPECT_NE("", help.out);
    EXPECT_EQ("", help.error);
  }
}

TEST_F(ProgramUsage, WrongUsageNamesItselfAndExitsWith2) {
  expect_usage({}, {"command is missing", "walk", "render"});
  expect_usage({"rendr", scene_}, {"rendr", "render"});
  expect_usage({"render", scene_, "--out", "a.png", "--shadws", "ray"}, {"--shadws", "--shadows"});
  expect_usage({"render", scene_, "--out", "a.png", "--shading", "phnog"}, {"--shading", "phnog", "flat|gouraud|phong"});
  expect_usage({"render", scene_, "--out", "a.png", "--normals", "interpoled"}, {"--normals", "did you mean 'interpolated'"});
  expect_usage({"render", scene_, "--out", "a.png", "--powers", "exakt"}, {"--powers", "fast|exact"});
  expect_usage({"render", scene_, "--out", "a.png", "--shading-rate", "4x4"}, {"--shading-rate", "2x2|1x1"});
  expect_usage({"render", scene_, "--out", "a.png", "--shadow-terminator", "on"}, {"--shadow-terminator", "off|lifted"});
  expect_usage({"render", scene_, "more", "--out", "a.png"}, {"more"});
  expect_usage({"render"}, {"SCENE"});
  expect_usage({"render", scene_}, {"nothing to do"});
  expect_usage({"render", scene_, "--out"}, {"--out"});
  expect_usage({"render", scene_, "--out", "a.jpg"}, {".png", "a.jpg"});
  expect_usage({"render", scene_, "--hash", "--stats", "-"}, {"standard output"});
  expect_usage({"render", scene_, "--depth", "a.pfm", "--radiance", "./a.pfm"}, {"a.pfm"});
  expect_usage({"render", scene_, "--stats", scene_}, {"the scene itself"});
}

TEST_F(ProgramUsage, NumbersAreCheckedBeforeLoading) {
  const std::string missing = "missing.obj";  // would be exit 1
  for (const char* size : {"0x10", "10x0", "-1x5", "10", "10x", "x10", "10x10x10", "1e3x4", "16385x1", "1x16385", "99999999999x1", "10 x10"})
    expect_usage({"render", missing, "--hash", "--size", size}, {"--size", size});
  for (const char* camera : {"1,2,3", "1,2,3,4,5,6,7,8", "1,2,3,4,5,6,x", "1,2,3,4,5,6,", "1,2,3,4,5,6,0", "1,2,3,4,5,6,180", "1,2,3,4,5,6,179.5", "1,2,3,1,2,3,40",
                             "1,2,3,4,5,6,40,0", "1,2,3,4,5,6,40,0,0,0", "1,2,3,4,5,6,40,0,1,0,0", "1,2,3,4,5,6,40,0,1,0,1,1",
                             "nan,2,3,4,5,6,40", "1,2,inf,4,5,6,40", "1e999,2,3,4,5,6,40"})
    expect_usage({"render", missing, "--hash", "--camera", camera}, {"--camera"});
  expect_usage({"render", missing, "--hash", "--threads", "-1"}, {"--threads"});
  expect_usage({"render", missing, "--hash", "--threads", "many"}, {"--threads"});
  expect_usage({"render", missing, "--hash", "--max-bounces", "65"}, {"--max-bounces"});
  expect_usage({"render", missing, "--hash", "--frames", "0"}, {"--frames"});
  expect_usage({"render", missing, "--hash", "--warmup", "-1"}, {"--warmup"});
  expect_usage({"render", missing, "--hash", "--isa", "sse9"}, {"--isa", "sse4"});
  expect_usage({"why", missing, "3"}, {"X,Y"});
  expect_usage({"why", missing, "3,4,5"}, {"X,Y"});
}

TEST_F(ProgramUsage, WhatThisVersionLacksSaysSo) {
  expect_usage({"render", scene_, "--out", "a.png", "--shadows", "map"}, {"--shadows", "this version has no `map`"});
  expect_usage({"render", scene_, "--out", "a.png", "--reflections", "env"}, {"--reflections", "this version has no `env`"});
}

TEST_F(ProgramUsage, APresetIsTheTechniquesThatItNames) {
  const auto hash = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"render", scene_, "--hash", "--size", "48x32", "--camera", kSmallSceneCamera});
    const Ran ran = run(arguments);
    EXPECT_EQ(0, ran.code) << ran.error;
    return ran.out;
  };
  const std::string draft = hash({"--preset", "draft"});
  EXPECT_EQ(draft, hash({"--shadows", "none", "--reflections", "none", "--no-bump", "--filter", "bilinear"}));
  EXPECT_EQ(hash({"--preset", "balanced"}), hash({"--max-bounces", "1", "--samples", "4"}));
  EXPECT_EQ(hash({"--preset", "exact"}), hash({"--samples", "16", "--antialiasing", "supersample"}));
  EXPECT_NE(draft, hash({"--preset", "balanced"}));
  EXPECT_EQ(hash({"--shadows", "ray", "--preset", "draft"}), hash({"--preset", "draft", "--shadows", "ray"})) << "options go over it, wherever they stand";
  EXPECT_NE(draft, hash({"--preset", "draft", "--shadows", "ray"}));
  folder_.write("s.toml", "[technique]\nshadows = \"none\"\n");
  expect_usage({"render", scene_, "--hash", "--preset", "exakt"}, {"--preset", "did you mean 'exact'"});
  expect_usage({"render", scene_, "--hash", "--preset", "draft", "--settings", "s.toml"}, {"--preset", "--settings"});
  expect_usage({"report", scene_, "--out", "d", "--preset", "draft"}, {"--preset"});
}

TEST_F(ProgramUsage, ACameraThatTheSceneLacksIsNamedWithThoseItHas) {
  expect_usage({"render", scene_, "--hash", "--camera", "balcony"}, {"balcony", "it has"});
}

TEST_F(ProgramBadInput, MissingAndWrongFilesExitWith1) {
  for (const char* command : {"render", "info"}) {
    std::vector<std::string> tail = std::string(command) == "render" ? std::vector<std::string>{"--hash"} : std::vector<std::string>{};
    const auto with = [&](const std::string& scene) {
      std::vector<std::string> arguments = {command, scene};
      arguments.insert(arguments.end(), tail.begin(), tail.end());
      return arguments;
    };
    expect_failure(1, with("missing.obj"), {"missing.obj"});
    expect_failure(1, with("missing.toml"), {"missing.toml"});
    expect_failure(1, with(folder_.path()), {folder_.path()});
    expect_failure(1, with("room.mtl"), {"room.mtl"});
  }
  folder_.write("bad.toml", "mesh = [[[");
  expect_failure(1, {"info", "bad.toml"}, {"bad.toml:1"});
}

TEST_F(ProgramBadInput, OutputsThatCannotBeWrittenFailBeforeLoading) {
  // The scene is missing too: the message is about the output, so that was looked at first.
  expect_failure(1, {"render", "missing.obj", "--out", "no/such/a.png"}, {"no/such/a.png", "does not exist"});
  expect_failure(1, {"render", "missing.obj", "--stats", "no/a.json"}, {"no/a.json"});
  std::filesystem::create_directory(folder_.file("folder.png"));
  expect_failure(1, {"render", "missing.obj", "--out", "folder.png"}, {"folder.png", "folder"});
}

TEST_F(ProgramBadInput, NoFileIsHalfWritten) {
  // An older file survives a frame that cannot be rendered, and no temporary is left.
  folder_.write("a.png", "old");
  expect_failure(1, {"render", "missing.obj", "--out", "a.png", "--stats", "a.json", "--ladder", "l.json"}, {"missing.obj"});
  EXPECT_EQ("old", read_text(folder_.file("a.png")));
}

TEST_F(ProgramBadInput, WalkWithoutADisplayNamesRender) {
  const Ran ran = run({"walk", scene_, "--frames", "1"}, {"DISPLAY", "WAYLAND_DISPLAY", "SDL_VIDEODRIVER", "ASAN_OPTIONS=detect_leaks=0"});
  EXPECT_EQ(1, ran.code) << ran.error;
  EXPECT_NE(std::string::npos, ran.error.find("spanray render")) << ran.error;
}

TEST_F(ProgramBadInput, StrictTurnsWarningsIntoErrors) {
  folder_.write("bare.obj", "usemtl none\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_EQ(0, run({"render", "bare.obj", "--size", "8x8", "--hash"}).code);
  for (const char* command : {"render", "info"}) {
    std::vector<std::string> arguments = {command, "bare.obj", "--strict"};
    if (std::string(command) == "render") arguments.insert(arguments.end(), {"--size", "8x8", "--hash"});
    expect_failure(1, arguments, {"bare.obj:1: warning: material 'none' is not defined", "--strict: 1 warning"});
  }
  const Ran notes = run({"render", scene_, "--size", "8x8", "--hash", "--strict"});
  EXPECT_EQ(0, notes.code) << "a default light or camera is no warning: " << notes.error;
  EXPECT_NE(std::string::npos, notes.error.find("no light given")) << notes.error;
}

TEST_F(ProgramBadInput, OutputsGoThroughLinks) {
  namespace fs = std::filesystem;
  fs::create_directory(folder_.file("real"));
  fs::create_symlink("real/a.png", folder_.file("there.png"));
  ASSERT_EQ(0, ::mkfifo(folder_.file("pipe").c_str(), 0600));
  const int pipe = ::open(folder_.file("pipe").c_str(), O_RDWR);  // so that the writer need not wait for a reader
  ASSERT_GE(pipe, 0);
  fs::create_symlink("pipe", folder_.file("pipe.png"));
  fs::create_symlink("loop.png", folder_.file("loop.png"));
  const std::vector<std::string> render = {"render", scene_, "--size", "8x8", "--out"};
  const auto out = [&](const char* name) {
    std::vector<std::string> arguments = render;
    arguments.emplace_back(name);
    return run(arguments);
  };
  for (int i = 0; i < 2; ++i) {  // a link to nothing, then to a file
    const Ran ran = out("there.png");
    EXPECT_EQ(0, ran.code) << ran.error;
    EXPECT_TRUE(fs::is_symlink(folder_.file("there.png")));
    EXPECT_TRUE(fs::is_regular_file(folder_.file("real/a.png")));
  }
  EXPECT_EQ(0, out("pipe.png").code);
  EXPECT_TRUE(fs::is_symlink(folder_.file("pipe.png")));
  EXPECT_TRUE(fs::is_fifo(folder_.file("pipe")));
  const std::string picture = read_text(folder_.file("real/a.png"));
  std::string piped(picture.size(), '\0');
  EXPECT_EQ(static_cast<ssize_t>(picture.size()), ::read(pipe, piped.data(), piped.size()));
  EXPECT_TRUE(picture == piped && !picture.empty());
  ::close(pipe);
  EXPECT_EQ(0, out("loop.png").code);
  EXPECT_TRUE(fs::is_regular_file(folder_.file("loop.png"))) << "a circle points to nothing: it is replaced";
  EXPECT_EQ(1, std::distance(fs::directory_iterator(folder_.file("real")), fs::directory_iterator())) << "a temporary was left";
}

TEST_F(ProgramBadInput, AFullDiskIsAnError) {
  std::ofstream full("/dev/full");
  if (!full) GTEST_SKIP() << "no /dev/full";
  Process process({"/bin/sh", "-c", std::string("exec '") + SPANRAY_PROGRAM + "' info room.obj > /dev/full"}, folder_.path());
  ASSERT_TRUE(process.wait(60));
  EXPECT_EQ(1, process.code());
  EXPECT_NE(std::string::npos, process.error().find("standard output"));
}

}  // namespace
}  // namespace spanray
