// `reference --paths`: the command, its accumulation file, and how it stops.
#include <gtest/gtest.h>

#include <algorithm>

#include "image/pfm.h"
#include "support/program.h"
#include "support/small_scene.h"

namespace spanray {
namespace {

class ProgramPaths : public ::testing::Test {
 protected:
  Ran run(std::vector<std::string> arguments) const {
    const auto given = [&](const char* option) {
      return std::find(arguments.begin(), arguments.end(), option) != arguments.end();
    };
    if (!given("--size")) arguments.insert(arguments.end(), {"--size", "24x16"});
    if (!given("--camera")) arguments.insert(arguments.end(), {"--camera", kSmallSceneCamera});
    arguments.insert(arguments.begin(), {"reference", scene_});
    return run_program(std::move(arguments), folder_.path());
  }
  std::string bytes(const std::string& file) const { return read_text(folder_.file(file)); }
  // The run ends with 1 and says this.
  void expect_refused(std::vector<std::string> arguments, const std::string& words) const {
    const Ran ran = run(std::move(arguments));
    EXPECT_EQ(1, ran.code);
    EXPECT_NE(std::string::npos, ran.error.find(words)) << ran.error << "\nlacks: " << words;
  }
  TempFolder folder_;
  const std::string scene_ = write_small_scene(folder_);
};

TEST_F(ProgramPaths, ContinuedRunsGiveTheSameBytesAsOne) {
  const Ran whole = run({"--paths", "9", "--out", "whole.pfm", "--accumulate", "whole_sums.pfm", "--threads", "1"});
  ASSERT_EQ(0, whole.code) << whole.error;
  EXPECT_EQ("", whole.out);
  EXPECT_NE(std::string::npos, whole.error.find("ambient light is left out")) << whole.error;
  EXPECT_NE(std::string::npos, whole.error.find("9 viewing rays a pixel; standard error")) << whole.error;
  for (const char* paths : {"2", "2", "3", "9"}) {
    const Ran part = run({"--paths", paths, "--out", "parts.pfm", "--accumulate", "sums.pfm", "--threads", "3"});
    ASSERT_EQ(0, part.code) << part.error;
  }
  EXPECT_EQ(bytes("whole.pfm"), bytes("parts.pfm"));
  EXPECT_EQ(bytes("whole_sums.pfm"), bytes("sums.pfm"));
  const Result<FloatImage> picture = read_pfm(folder_.file("whole.pfm")), sums = read_pfm(folder_.file("sums.pfm"));
  ASSERT_TRUE(picture && sums);
  EXPECT_EQ(picture.value().rgb, sums.value().rgb) << "the accumulation file is a picture, too";
  EXPECT_EQ(0, run({"--paths", "9", "--out", "whole.png"}).code);
  EXPECT_EQ(0, run_program({"compare", "whole.pfm", "whole.png"}, folder_.path()).code);
  EXPECT_EQ(0, run({"--paths", "9", "--out", "other.pfm", "--seed", "1"}).code);
  EXPECT_NE(bytes("whole.pfm"), bytes("other.pfm"));
}

TEST_F(ProgramPaths, AFileOfAnotherPictureIsRefused) {
  ASSERT_EQ(0, run({"--paths", "3", "--out", "a.png", "--accumulate", "sums.pfm"}).code);
  const std::string before = bytes("sums.pfm");
  const auto with = [](std::vector<std::string> more) {
    if (more.empty() || more[0] != "--paths") more.insert(more.begin(), {"--paths", "4"});
    more.insert(more.begin(), {"--out", "b.png", "--accumulate", "sums.pfm"});
    return more;
  };
  expect_refused(with({"--seed", "5"}), "sums.pfm: holds paths of another picture: seed=0 there, seed=5 here");
  expect_refused(with({"--depth", "3"}), "depth=64 there, depth=3 here");
  expect_refused(with({"--branching", "2"}), "branching=1 there, branching=2 here");
  expect_refused(with({"--next-event", "off"}), "next_event=on there, next_event=off here");
  expect_refused(with({"--russian-roulette", "off"}), "russian_roulette=on there, russian_roulette=off here");
  expect_refused(with({"--size", "16x24"}), "24 16 pixels there, 16 24 here");
  expect_refused(with({"--camera", "0.5,1.5,4.5,0,0.6,0,51"}), "camera=");
  expect_refused(with({"--time", "1"}), "time=0 there, time=1 here");
  expect_refused(with({"--no-bump"}), "bump=on there, bump=off here");
  expect_refused(with({"--paths", "2"}), "holds 3 viewing rays a pixel, more than --paths 2");
  folder_.write("room.mtl", "newmtl floor\nKd 0.1 0.1 0.1\nnewmtl mirror\nnewmtl glass\nnewmtl red\n");
  expect_refused(with({}), "scene_hash=");
  EXPECT_EQ(before, bytes("sums.pfm"));
  EXPECT_FALSE(std::filesystem::exists(folder_.file("b.png")));
}

TEST_F(ProgramPaths, ATruncatedOrDamagedFileIsRefused) {
  ASSERT_EQ(0, run({"--paths", "2", "--out", "a.pfm", "--accumulate", "sums.pfm"}).code);
  const std::string good = bytes("sums.pfm");
  const std::vector<std::string> on = {"--paths", "3", "--out", "b.png", "--accumulate", "sums.pfm"};
  const size_t text = good.find("spanray paths 1");
  ASSERT_NE(std::string::npos, text);
  for (const size_t length : {size_t{4}, size_t{100}, text - 1 - 6, text + 7, text + 40, text + 300, good.size() / 2,
                              good.size() - 9, good.size() - 1}) {
    folder_.write("sums.pfm", good.substr(0, length));
    expect_refused(on, "sums.pfm: the file is truncated");
  }
  folder_.write("sums.pfm", "");
  expect_refused(on, "sums.pfm: not a file that --accumulate wrote");
  std::filesystem::copy_file(folder_.file("a.pfm"), folder_.file("sums.pfm"),
                             std::filesystem::copy_options::overwrite_existing);
  expect_refused(on, "a picture without sums");
  for (const size_t at : {size_t{60}, good.size() - 100, good.size() - 1}) {
    std::string bad = good;
    bad[at] = static_cast<char>(bad[at] ^ 1);
    folder_.write("sums.pfm", bad);
    expect_refused(on, "sums.pfm: the file is damaged");
  }
  folder_.write("sums.pfm", good + "more");
  expect_refused(on, "sums.pfm: the file is damaged");
  folder_.write("sums.pfm", good);
  EXPECT_EQ(0, run(on).code);
}

TEST_F(ProgramPaths, StopsBySignalWithWhatItHasAndGoesOnFromThere) {
  for (const int signal : {SIGTERM, SIGINT}) {
    Process process({SPANRAY_PROGRAM, "reference", scene_, "--size", "24x16", "--camera", kSmallSceneCamera, "--paths",
                     "100000000", "--out", "stopped.pfm", "--accumulate", "sums.pfm"},
                    folder_.path());
    for (int i = 0; i < 3000 && process.error().find("paths: ") == std::string::npos; ++i) ::usleep(10000);
    ::usleep(100000);
    process.send(signal);
    ASSERT_TRUE(process.wait(60));
    EXPECT_EQ(1, process.code()) << process.error();
    const std::string said = process.error(), words = "stopped after ";
    const size_t at = said.find(words);
    ASSERT_NE(std::string::npos, at) << said;
    const uint32_t done = static_cast<uint32_t>(std::stoul(said.substr(at + words.size())));
    ASSERT_GT(done, 0u);
    const std::string more = std::to_string(done + 2);
    ASSERT_EQ(0, run({"--paths", more, "--out", "continued.pfm", "--accumulate", "sums.pfm"}).code);
    ASSERT_EQ(0, run({"--paths", more, "--out", "whole.pfm"}).code);
    EXPECT_EQ(bytes("whole.pfm"), bytes("continued.pfm"));
    ASSERT_EQ(0, run({"--paths", std::to_string(done), "--out", "whole.pfm"}).code);
    EXPECT_EQ(bytes("whole.pfm"), bytes("stopped.pfm")) << "what it had";
    std::filesystem::remove(folder_.file("sums.pfm"));
  }
}

TEST_F(ProgramPaths, WrongUsage) {
  for (const auto& wrong : {std::vector<std::string>{"--paths", "0"},
                            {"--paths", "-1"},
                            {"--paths", "many"},
                            {"--paths", "2", "--depth", "-1"},
                            {"--paths", "2", "--depth", "1025"},
                            {"--paths", "2", "--branching", "0"},
                            {"--paths", "2", "--next-event", "maybe"},
                            {"--paths", "2", "--seed", "-3"},
                            {"--paths", "2", "--grid", "2"},
                            {"--depth", "2"},
                            {"--seed", "2"},
                            {"--accumulate", "s.pfm"},
                            {"--paths", "2", "--accumulate", "./a.pfm"}}) {
    std::vector<std::string> arguments = wrong;
    arguments.insert(arguments.end(), {"--out", "a.pfm"});
    const Ran ran = run(arguments);
    EXPECT_EQ(2, ran.code) << wrong[0] << " " << wrong[1] << "\n" << ran.error;
    EXPECT_FALSE(std::filesystem::exists(folder_.file("a.pfm")));
  }
  expect_refused({"--paths", "2", "--out", "a.pfm", "--accumulate", "no/s.pfm"},
                 "no/s.pfm: cannot write: the folder no does not exist");
}

}  // namespace
}  // namespace spanray
