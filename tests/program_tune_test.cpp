// `tune`: the search, on costs that are made up; and the command, whose answer other commands take.
#include <gtest/gtest.h>

#include <cmath>

#include "../demo/tuner.h"
#include "support/program.h"
#include "support/small_scene.h"

namespace spanray {
namespace {

using demo::Cost;

// Made-up costs of settings: each technique has a price and takes away an error.
Cost made_up(const Settings& s) {
  Cost c{10, 1};
  if (s.shading == Shading::kPhong) c.ms += 5, c.error -= 0.1;
  if (s.shading == Shading::kGouraud) c.ms += 7, c.error -= 0.05;  // dearer and worse than Phong
  if (s.shadows == Shadows::kRay) c.ms += 40, c.error -= 0.5;
  if (s.reflections == Reflections::kRay) c.ms += 3 * s.max_bounces, c.error -= 0.1;
  c.ms *= std::sqrt(s.samples), c.error -= 0.05 * std::log2(s.samples) / 4;
  return c;
}

class Tuner : public ::testing::Test {
 protected:
  void SetUp() override {
    const Result<LoadedScene> loaded = load_scene(SPANRAY_SOURCE_DIR "/assets/spheres.toml");
    ASSERT_TRUE(loaded);
    settings_ = loaded.value().scene.settings();
    knobs_ = demo::make_knobs(loaded.value().scene, settings_);
  }
  demo::Tuned tuned(bool by_time, double budget) {
    const Result<demo::Tuned> t = demo::tune(knobs_, settings_, {by_time, budget}, [&](const Settings& s) {
      ++asked_;
      return Result<Cost>(made_up(s));
    });
    EXPECT_TRUE(t);
    return t.value();
  }
  std::vector<demo::Knob> knobs_;
  Settings settings_;
  int asked_ = 0;
};

TEST_F(Tuner, KeepsABudgetOfTimeAndUsesIt) {
  for (const double budget : {10.0, 16.0, 30.0, 58.0, 90.0, 250.0, 1000.0}) {
    asked_ = 0;
    const demo::Tuned t = tuned(true, budget);
    EXPECT_TRUE(t.kept);
    EXPECT_LE(t.cost.ms, budget);
    EXPECT_EQ(t.cost.ms, made_up(t.settings).ms);
    EXPECT_EQ(asked_, t.tried) << "nothing is measured twice";
    for (const demo::Knob& knob : knobs_)
      for (const demo::KnobChoice& choice : knob.choices) {
        Settings turned = t.settings;
        choice.set(turned);
        const Cost c = made_up(turned);
        EXPECT_FALSE(knob.absent.empty() && c.ms <= budget && c.error < t.cost.error)
            << budget << ": " << knob.name << " " << choice.word;
      }
  }
  EXPECT_EQ(tuned(true, 18).settings.shading, Shading::kPhong) << "Gouraud costs more and errs more";
  EXPECT_EQ(tuned(true, 58).settings.shadows, Shadows::kRay) << "what helps most comes first";
  EXPECT_EQ(tuned(true, 1e6).settings.samples, 16);
}

TEST_F(Tuner, KeepsABoundOnTheErrorAtTheLeastTime) {
  for (const double bound : {0.95, 0.5, 0.4, 0.31, 0.28, 0.26}) {
    const demo::Tuned t = tuned(false, bound);
    EXPECT_TRUE(t.kept) << bound;
    EXPECT_LE(t.cost.error, bound);
    EXPECT_EQ(t.settings.samples > 1, bound < 0.3) << bound << ": samples only where nothing else helps";
  }
  EXPECT_EQ(tuned(false, 0.95).settings.shadows, Shadows::kNone);
  EXPECT_LE(tuned(false, 0.31).settings.max_bounces, 1) << "more bounces are dearer and no better";
}

TEST_F(Tuner, ALittleIsEnoughWhereItKeepsTheBudget) {
  const Result<demo::Tuned> t = demo::tune(knobs_, settings_, {true, 9.95}, [](const Settings& s) {
    return Result<Cost>(Cost{s.shading == Shading::kPhong ? 9.94 : 10.0, 0.5});
  });
  ASSERT_TRUE(t);
  EXPECT_TRUE(t.value().kept);
  EXPECT_EQ(t.value().cost.ms, 9.94);
}

TEST_F(Tuner, OfSettingsThatErrAlikeTheMoreExactAreTaken) {
  const auto chosen = [&](double fast_error, double exact_ms) {
    const Result<demo::Tuned> t = demo::tune(knobs_, settings_, {true, 20}, [&](const Settings& s) {
      const bool fast = s.powers == Powers::kFast;
      return Result<Cost>(Cost{fast ? 10 : exact_ms, fast ? fast_error : 0.5});
    });
    EXPECT_TRUE(t);
    return t.value().settings.powers;
  };
  EXPECT_EQ(chosen(0.499, 11), Powers::kExact) << "that much is chance";
  EXPECT_EQ(chosen(0.4, 11), Powers::kFast) << "that much is not";
  EXPECT_EQ(chosen(0.499, 21), Powers::kFast) << "the budget comes first";
}

TEST_F(Tuner, SaysWhenNothingKeepsTheBudget) {
  const demo::Tuned slow = tuned(true, 9), bad = tuned(false, 0.2);
  EXPECT_FALSE(slow.kept);
  EXPECT_EQ(slow.cost.ms, 10);
  EXPECT_FALSE(bad.kept);
  EXPECT_NEAR(bad.cost.error, 0.25, 1e-12);
  const Result<demo::Tuned> failed =
      demo::tune(knobs_, settings_, {true, 9}, [](const Settings&) { return Result<Cost>(Error{"broken"}); });
  ASSERT_FALSE(failed);
  EXPECT_EQ(failed.error().message, "broken");
}

TEST_F(Tuner, NamesWhatElseKeepsTheBudgetTheBestFirst) {
  for (const bool by_time : {true, false}) {
    const double budget = by_time ? 58 : 0.5;
    const demo::Tuned t = tuned(by_time, budget);
    ASSERT_GE(t.others.size(), 3u);
    for (size_t i = 0; i < t.others.size(); ++i) {
      const Cost& c = t.others[i].cost;
      EXPECT_LE(by_time ? c.ms : c.error, budget);
      EXPECT_EQ(c.ms, made_up(t.others[i].settings).ms);
      EXPECT_FALSE(demo::same_settings(t.others[i].settings, t.settings));
      if (i > 0) {
        EXPECT_LE(by_time ? t.others[i - 1].cost.error : t.others[i - 1].cost.ms, by_time ? c.error : c.ms);
      }
    }
  }
}

TEST(TunerAgain, TheSecondMeasurementDecides) {
  const auto chosen = [](std::vector<Cost> costs, demo::TuneGoal goal) {
    std::vector<demo::Tried> list;
    for (const Cost& c : costs) list.push_back({Settings(), c});
    return demo::choose_again(list, goal);
  };
  EXPECT_EQ(chosen({{9, 0.1}, {8, 0.2}}, {true, 10}), 0);
  EXPECT_EQ(chosen({{11, 0.1}, {8, 0.2}, {9, 0.15}}, {true, 10}), 2)
      << "the winner was lucky: the best of those that still keep it";
  EXPECT_EQ(chosen({{11, 0.1}, {10.5, 0.2}}, {true, 10}), -1);
  EXPECT_EQ(chosen({{9, 0.1}, {8, 0.0999}}, {true, 10}), 0) << "a thousandth is noise";
  EXPECT_EQ(chosen({{10, 0.1}, {9.9, 0.1}, {11, 0.1}}, {false, 0.2}), 0) << "1 % is noise";
  EXPECT_EQ(chosen({{10, 0.1}, {9.5, 0.2}, {9.4, 0.3}}, {false, 0.2}), 1);
}

class ProgramTune : public ::testing::Test {
 protected:
  ProgramTune() : scene_(write_small_scene(folder_)) {}
  Ran run(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(),
                     {"tune", scene_, "--size", "48x32", "--camera", kSmallSceneCamera, "--frames", "2", "--grid", "2"});
    return run_program(std::move(arguments), folder_.path());
  }
  TempFolder folder_;
  std::string scene_;
};

TEST_F(ProgramTune, WhatItWritesKeepsTheBoundInRender) {
  const Ran ran = run({"--max-error", "flip=0.15", "--out", "t.toml"});
  ASSERT_EQ(0, ran.code) << ran.error;
  EXPECT_EQ(ran.out, read_text(folder_.file("t.toml")));
  EXPECT_NE(ran.out.find("[technique]\nwidth = 48\nheight = 32\n"), std::string::npos) << ran.out;
  EXPECT_NE(ran.out.find("# measured again, 30 frames of each and view in turns:\n"), std::string::npos) << ran.out;
  EXPECT_NE(ran.out.find(": these settings"), std::string::npos) << ran.out;
  EXPECT_NE(ran.out.find("plain"), std::string::npos) << "named whether it is a contender or not: " << ran.out;
  EXPECT_NE(ran.out.find("# the ground truth itself, with 4 samples a pixel, errs by flip "), std::string::npos) << ran.out;
  EXPECT_EQ(ran.error.find("this bound is below what can be known"), std::string::npos) << ran.error;
  const auto make = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin() + 1, {scene_, "--camera", kSmallSceneCamera});
    const Ran made = run_program(std::move(arguments), folder_.path());
    EXPECT_EQ(0, made.code) << made.error;
  };
  make({"reference", "--size", "48x32", "--grid", "2", "--out", "truth.png"});
  make({"render", "--settings", "t.toml", "--out", "tuned.png"});
  const Ran compared = run_program({"compare", "truth.png", "tuned.png", "--max-error", "flip=0.15"}, folder_.path());
  EXPECT_EQ(0, compared.code) << compared.out << compared.error;
  make({"render", "--settings", "t.toml", "--size", "20x10", "--out", "small.png"});  // the command line goes over the file
}

TEST_F(ProgramTune, BudgetsThatNothingKeeps) {
  Ran ran = run({"--max-error", "flip=0", "--out", "t.toml"});
  EXPECT_EQ(1, ran.code);
  EXPECT_NE(ran.error.find("no settings keep this budget; the nearest of "), std::string::npos) << ran.error;
  EXPECT_NE(ran.error.find("this bound is below what can be known; a larger --grid makes it finer"), std::string::npos)
      << ran.error;
  EXPECT_EQ("", ran.out);
  EXPECT_EQ("", read_text(folder_.file("t.toml")));
  EXPECT_EQ(1, run({"--max-ms", "0.001"}).code);
  EXPECT_EQ(0, run({"--max-ms", "100000"}).code);
}

TEST_F(ProgramTune, WrongUse) {
  EXPECT_EQ(2, run({}).code);
  EXPECT_EQ(2, run({"--max-ms", "5", "--max-error", "flip=1"}).code);
  EXPECT_EQ(2, run({"--max-ms", "-5"}).code);
  EXPECT_EQ(2, run({"--max-error", "flop=1"}).code);
  EXPECT_EQ(2, run({"--max-ms", "5", "--out", "t.txt"}).code);
  EXPECT_EQ(2, run({"--max-ms", "nan"}).code);
  EXPECT_EQ(2, run({"--max-ms", "5", "--shading", "flat"}).code) << "it turns that itself";
  const std::string before = read_text(scene_);
  EXPECT_EQ(2, run({"--max-ms", "100000", "--out", scene_}).code);
  EXPECT_EQ(before, read_text(scene_));
}

TEST_F(ProgramTune, SaysThatTheTechniquesOfASettingsFileDoNotCount) {
  folder_.write("s.toml", "[technique]\nshadows = \"none\"\n");
  const Ran ran = run({"--max-ms", "100000", "--settings", "s.toml"});
  EXPECT_EQ(0, ran.code) << ran.error;
  EXPECT_NE(ran.error.find("tune turns every technique itself: of s.toml only "), std::string::npos) << ran.error;
}

TEST_F(ProgramTune, ASettingsFileIsChecked) {
  const auto render = [&](const std::string& text) {
    folder_.write("s.toml", text);
    return run_program({"render", scene_, "--settings", "s.toml", "--hash", "--size", "8x8"}, folder_.path());
  };
  EXPECT_EQ(0, render("[technique]\nshadows = \"none\"\nsamples = 4\n").code);
  EXPECT_EQ(0, render("").code);
  for (const auto& [text, says] : {std::pair<std::string, std::string>{"[technique]\nshadows = \"some\"\n", "s.toml:2: "},
                                   {"[technique]\nsamples = 3\n", "s.toml:2: "},
                                   {"[technique]\nshadow = \"none\"\n", "s.toml:2: "},
                                   {"obj = \"a.obj\"\n", "s.toml:1: "},
                                   {"technique = 1\n", "s.toml:1: "},
                                   {"[technique\n", "s.toml:1: "}}) {
    const Ran ran = render(text);
    EXPECT_EQ(1, ran.code) << text;
    EXPECT_NE(ran.error.find(says), std::string::npos) << ran.error;
  }
  const Ran missing = run_program({"render", scene_, "--settings", "no.toml", "--hash"}, folder_.path());
  EXPECT_EQ(1, missing.code);
  EXPECT_NE(missing.error.find("no.toml"), std::string::npos);
}

}  // namespace
}  // namespace spanray
