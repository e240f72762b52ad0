// `report`: its numbers agree with each other and with what its pictures say, and its page needs nothing but itself.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "../demo/knobs.h"
#include "../demo/pareto.h"
#include "../demo/presets.h"
#include "../demo/report_plot.h"
#include "../demo/stage_times.h"
#include "image/metrics.h"
#include "support/program.h"
#include "support/small_scene.h"

namespace spanray {
namespace {

using demo::Cost;

TEST(ReportPareto, WhoBeatsWhom) {
  //                               0        1        2        3        4        5
  const std::vector<Cost> points = {{10, 5}, {20, 3}, {20, 4}, {30, 3}, {40, 1}, {10, 5}};
  EXPECT_EQ(demo::dominated_by(points), (std::vector<int>{-1, -1, 1, 1, -1, -1})) << "equal points do not beat each other";
  EXPECT_EQ(demo::best_within_time(points, 9), -1);
  EXPECT_EQ(demo::best_within_time(points, 20), 1);
  EXPECT_EQ(demo::best_within_time(points, 39), 1) << "of equal errors the fastest";
  EXPECT_EQ(demo::best_within_time(points, 1000), 4);
  EXPECT_EQ(demo::fastest_within_error(points, 0.5), -1);
  EXPECT_EQ(demo::fastest_within_error(points, 3), 1);
  EXPECT_EQ(demo::fastest_within_error(points, 100), 0);
}

TEST(ReportTimes, WhereTheMedianLies) {
  std::vector<double> values;
  for (int i = 30; i > 0; --i) values.push_back(i);
  demo::MedianInterval known = demo::median_interval(values);  // the 10th and the 21st: 95.7 %, as tables have it
  EXPECT_EQ(known.low, 10);
  EXPECT_EQ(known.high, 21);
  values.resize(6);  // 30 to 25: 96.9 %
  known = demo::median_interval(values);
  EXPECT_EQ(known.low, 25);
  EXPECT_EQ(known.high, 30);
  known = demo::median_interval({3, 1, 2});
  EXPECT_EQ(known.low, 1);
  EXPECT_EQ(known.high, 3);
  EXPECT_EQ(demo::median_interval({}).high, 0);
  values.assign(10000, 7);
  EXPECT_EQ(demo::median_interval(values).low, 7) << "2^-10000 is no double";
}

TEST(ReportPlot, ScalesAreLogarithmicAndNamesAreEscaped) {
  const std::string svg = demo::scatter_plot(
      {{{1, 0.01}, "a", "<a> & \"b\"", true}, {{10, 0.1}, "b", "b", false}, {{100, 0}, "c", "c", false}}, "flip", 0.001);
  EXPECT_NE(svg.find("&lt;a&gt; &amp; &quot;b&quot;"), std::string::npos);
  EXPECT_EQ(svg.find("<a>"), std::string::npos);
  const auto number = [&](const char* id, const std::string& what) {
    const size_t circle = svg.find(std::string("data-id=\"") + id + "\"");
    return std::stod(svg.substr(svg.find(what + "=\"", circle) + what.size() + 2));
  };
  EXPECT_NEAR(number("b", "cx") - number("a", "cx"), number("c", "cx") - number("b", "cx"), 0.2) << "equal factors, equal ways";
  EXPECT_LT(number("b", "cy"), number("a", "cy")) << "up is worse";
  EXPECT_GE(number("c", "cy"), number("a", "cy")) << "an error of 0 has no logarithm: the bottom";
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
}

class ReportKnobs : public ::testing::Test {
 protected:
  static Scene load(const std::string& path) {
    Result<LoadedScene> loaded = load_scene(path);
    EXPECT_TRUE(loaded);
    return loaded ? loaded.value().scene : Scene();
  }
};

TEST_F(ReportKnobs, EveryChoiceOfEveryUsefulKnobIsMeasuredOnce) {
  const Scene scene = load(SPANRAY_SOURCE_DIR "/assets/gauze.toml");
  Settings settings = scene.settings();
  settings.max_bounces = 3;
  const std::vector<demo::Knob> knobs = demo::make_knobs(scene, settings);
  const std::vector<demo::Candidate> list = demo::make_candidates(knobs, settings);
  std::map<std::string, int> ids;
  for (const demo::Candidate& c : list) ++ids[c.id];
  for (const auto& [id, count] : ids) EXPECT_EQ(count, 1) << id;
  for (size_t i = 0; i < list.size(); ++i)
    for (size_t j = 0; j < i; ++j)
      EXPECT_FALSE(demo::same_settings(list[i].settings, list[j].settings)) << list[i].id << " " << list[j].id;
  const Settings plain = demo::plain_settings(knobs, settings), exact = demo::exact_settings(knobs, settings);
  EXPECT_TRUE(demo::same_settings(list[0].settings, plain));
  EXPECT_EQ(plain.samples, 1);
  EXPECT_EQ(exact.samples, 16);
  for (const Settings& s : {plain, exact}) {
    EXPECT_TRUE(s.shading == Shading::kPhong && s.shadows == Shadows::kRay && s.filter == Filter::kTrilinear && s.textures &&
                s.bump);
    EXPECT_EQ(s.max_bounces, 3);
  }
  for (const demo::Candidate& c :
       list)  // knobs that do nothing here stay where they are: no setting is measured under two names
    for (const demo::Knob& knob : knobs) {
      Settings turned = c.settings;
      knob.choices[knob.plain].set(turned);
      EXPECT_TRUE(knob.absent.empty() || demo::same_settings(turned, c.settings)) << c.id << " " << knob.name;
    }
  size_t useful = 0;
  for (const demo::Knob& knob : knobs) {
    if (!knob.absent.empty()) continue;
    ++useful;
    for (const demo::KnobChoice& choice : knob.choices) {
      Settings turned = plain;
      choice.set(turned);
      EXPECT_EQ(std::count_if(list.begin(), list.end(), [&](const auto& c) { return demo::same_settings(c.settings, turned); }),
                1)
          << knob.name << " " << choice.word;
    }
  }
  EXPECT_GE(useful, 6u);
}

TEST(ReportPlot, NumbersStandApartAndZeroHasItsOwnRow) {
  std::vector<demo::PlotPoint> points;
  for (int i = 0; i < 12; ++i) points.push_back({{10 + 0.1 * i, 0.5 - 0.001 * i}, std::to_string(i), "p", true});  // a crowd
  points.push_back({{40, 0}, "zero", "zero", true});
  const std::string svg = demo::scatter_plot(points, "flip", 0);
  std::vector<std::pair<double, double>> at;
  const std::string word = "<text class=\"number\" x=\"";
  for (size_t p = svg.find(word); p != std::string::npos; p = svg.find(word, p + 1)) {
    const size_t y = svg.find("y=\"", p);
    at.emplace_back(std::stod(svg.substr(p + word.size())), std::stod(svg.substr(y + 3)));
  }
  ASSERT_EQ(at.size(), 13u);
  for (size_t i = 0; i < at.size(); ++i)
    for (size_t k = 0; k < i; ++k)
      EXPECT_TRUE(std::abs(at[i].first - at[k].first) >= 9 || std::abs(at[i].second - at[k].second) >= 12.9) << i << " " << k;
  EXPECT_NE(svg.find("class=\"leader\""), std::string::npos);
  EXPECT_NE(svg.find("no error at all (not on the scale)"), std::string::npos);
  points.pop_back();
  EXPECT_EQ(demo::scatter_plot(points, "flip", 0).find("no error at all"), std::string::npos);
}

TEST_F(ReportKnobs, EveryPresetIsMeasuredAsTheCommandLineHasIt) {
  const Scene scene = load(SPANRAY_SOURCE_DIR "/assets/gauze.toml");
  const std::vector<demo::Knob> knobs = demo::make_knobs(scene, scene.settings());
  const std::vector<demo::Candidate> list = demo::make_candidates(knobs, scene.settings());
  for (const demo::Preset& preset : demo::kPresets) {
    const auto found = std::find_if(list.begin(), list.end(), [&](const demo::Candidate& c) { return c.preset == preset.name; });
    ASSERT_NE(found, list.end()) << preset.name;
    Settings asked = scene.settings();
    preset.set(asked);
    Renderer renderer;
    Framebuffer ours, theirs;
    Settings measured = found->settings;
    for (Settings* s : {&asked, &measured}) s->width = 48, s->height = 32;
    ASSERT_TRUE(renderer.render(scene, scene.cameras()[0], asked, ours) && renderer.render(scene, scene.cameras()[0], measured, theirs));
    EXPECT_EQ(ours.color.rgba, theirs.color.rgba) << preset.name;
  }
}

TEST_F(ReportKnobs, KnobsThatTheSceneHasNoUseForSayWhy) {
  const TempFolder folder;
  folder.write("a.mtl", "newmtl m\nKd 0.5 0.5 0.5\nillum 1\n");
  const Scene scene = load(folder.write("a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n"));
  std::map<std::string, std::string> absent;
  for (const demo::Knob& knob : demo::make_knobs(scene, scene.settings())) absent[knob.name] = knob.absent;
  EXPECT_EQ(absent["shading"], "");
  EXPECT_EQ(absent["shadows"], "");
  EXPECT_EQ(absent["samples"], "");
  EXPECT_EQ(absent["reflections"], "no material mirrors");
  EXPECT_EQ(absent["powers"], "no lit material has a highlight");
  EXPECT_EQ(absent["normals"], "each triangle has one normal");
  EXPECT_EQ(absent["shading-rate"], "");
  EXPECT_EQ(absent["shadow-terminator"], "each triangle has one normal");
  for (const char* name : {"filter", "textures", "bump", "transparency"})
    EXPECT_NE(absent[name].find("no material"), std::string::npos) << name;
}

using Row = std::map<std::string, std::string>;

// Fields may be quoted, as that of the name is.
std::vector<Row> read_csv(const std::string& path) {
  std::vector<std::vector<std::string>> lines;
  const std::string text = read_text(path);
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (const char c : text) {
    if (c == '"')
      quoted = !quoted;
    else if (c == ',' && !quoted)
      fields.emplace_back();
    else if (c == '\n' && !quoted)
      lines.push_back(fields), fields.assign(1, "");
    else
      fields.back() += c;
  }
  std::vector<Row> rows;
  for (size_t i = 1; i < lines.size(); ++i) {
    EXPECT_EQ(lines[i].size(), lines[0].size());
    Row& row = rows.emplace_back();
    for (size_t k = 0; k < lines[0].size(); ++k) row[lines[0][k]] = lines[i][k];
  }
  return rows;
}

size_t count_of(const std::string& text, const std::string& word) {
  size_t count = 0;
  for (size_t at = 0; (at = text.find(word, at)) != std::string::npos; at += word.size()) ++count;
  return count;
}

TEST(ProgramReport, ItsNumbersAreThoseOfItsPictures) {
  const TempFolder folder;
  write_small_scene(folder);
  std::filesystem::rename(folder.file("room.obj"), folder.file("a<b>&.obj"));
  const Ran ran = run_program({"report", "a<b>&.obj", "--size", "48x32", "--camera", kSmallSceneCamera, "--out", "out/deep",
                               "--frames", "6", "--warmup", "1", "--grid", "2"},
                              folder.path());
  ASSERT_EQ(0, ran.code) << ran.error;
  EXPECT_EQ(ran.out.find("out/deep/report.html\nthe ground truth itself errs by max "), 0u) << ran.out;
  const std::string out = folder.file("out/deep/");
  const std::vector<Row> rows = read_csv(out + "report.csv");
  const nlohmann::json json = nlohmann::json::parse(read_text(out + "report.json"));
  ASSERT_GE(rows.size(), 12u);
  ASSERT_EQ(rows.size(), json["settings"].size());

  Parallel parallel(1);
  const Result<Image> truth = read_png(out + "picture-truth.png"), center = read_png(out + "picture-truth-center.png");
  ASSERT_TRUE(truth && center);
  std::vector<Cost> costs;
  for (size_t i = 0; i < rows.size(); ++i) {
    Row row = rows[i];
    SCOPED_TRACE(row["id"]);
    const nlohmann::json& setting = json["settings"][i];
    EXPECT_EQ(row["id"], setting["id"]);
    const Result<Image> picture = read_png(out + "picture-" + row["id"] + ".png");
    ASSERT_TRUE(picture);
    const Result<Metrics> m = measure_pictures(truth.value(), picture.value(), parallel),
                          alone = measure_pictures(center.value(), picture.value(), parallel);
    ASSERT_TRUE(m && alone);
    for (const MetricWord& word : kMetricWords) {
      EXPECT_EQ(std::stod(row[word.name]), m.value().*word.value) << word.name;
      EXPECT_EQ(row[std::string("truth_") + word.name], rows[0].at(std::string("truth_") + word.name));
      const std::string text = row[std::string("alone_") + word.name];
      EXPECT_EQ(text.empty(), row["samples"] != "1");
      if (!text.empty()) {
        EXPECT_EQ(std::stod(text), alone.value().*word.value) << word.name;
      }
    }
    const std::vector<double> frames = setting["frame_ms"];
    EXPECT_EQ(frames.size(), 6u);
    EXPECT_EQ(std::stod(row["median_ms_frame"]), demo::median(frames));
    EXPECT_EQ(std::stod(row["p95_ms_frame"]), demo::percentile_95(frames));
    EXPECT_EQ(setting["median_interval_ms"][0], demo::median_interval(frames).low);
    EXPECT_EQ(setting["median_interval_ms"][1], demo::median_interval(frames).high);
    costs.push_back({std::stod(row["median_ms_frame"]), std::stod(row["flip"])});
    for (const char* map : {"flip-", "error-"}) EXPECT_TRUE(read_png(out + map + row["id"] + ".png"));
    EXPECT_EQ(row["wrong_ids"].empty(), row["samples"] != "1");
    if (!row["wrong_ids"].empty() && row["transparency"] == "scene") {  // else panes are seen that were seen through
      EXPECT_LE(std::stoi(row["wrong_ids"]), 48 * 32 / 20);
    }
  }
  for (const char* grid : {"2", "3"})  // the truth, and the second one that tells what the first errs
    ASSERT_EQ(0, run_program({"reference", "a<b>&.obj", "--size", "48x32", "--camera", kSmallSceneCamera, "--max-bounces",
                              rows[0].at("max_bounces"), "--grid", grid, "--out", std::string("truth") + grid + ".png"},
                             folder.path())
                     .code);
  const Result<Image> first = read_png(folder.file("truth2.png")), second = read_png(folder.file("truth3.png"));
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first.value().rgba, truth.value().rgba);
  const Result<Metrics> own = measure_pictures(second.value(), first.value(), parallel);
  ASSERT_TRUE(own);
  EXPECT_GT(own.value().flip, 0);
  for (const MetricWord& word : kMetricWords) {
    EXPECT_EQ(std::stod(rows[0].at(std::string("truth_") + word.name)), own.value().*word.value) << word.name;
    EXPECT_EQ(json["truth_error"][word.name], own.value().*word.value) << word.name;
  }

  const auto beats = [&](size_t a, size_t b) {
    return costs[a].ms <= costs[b].ms && costs[a].error <= costs[b].error &&
           (costs[a].ms < costs[b].ms || costs[a].error < costs[b].error);
  };
  for (size_t i = 0; i < rows.size(); ++i) {
    const std::string by = rows[i].at("dominated_by");
    bool any = false, named = false;
    for (size_t k = 0; k < rows.size(); ++k) any |= beats(k, i), named |= beats(k, i) && rows[k].at("id") == by;
    EXPECT_EQ(any, !by.empty()) << i;
    EXPECT_EQ(any, named) << i;
  }

  const auto median_of = [&](const std::string& id) {
    for (const Row& row : rows)
      if (row.at("id") == id) return std::stod(row.at("median_ms_frame"));
    return std::nan("");
  };
  size_t priced = 0;
  for (const nlohmann::json& line : json["plan_costs"]) {
    priced += line["ms"].is_number();
    if (line["stage"] == "shadow rays") {
      EXPECT_TRUE(line["needed"]);
      EXPECT_EQ(line["ms"], median_of("plain") - median_of("shadows-none"));
    } else if (line["stage"] == "primary rays") {
      EXPECT_FALSE(line["needed"]);
      EXPECT_EQ(line["ms"], median_of("visibility-ray") - median_of("plain"));
    }
  }
  EXPECT_GE(priced, 4u);
  EXPECT_EQ(json["plan_costs"].size(), json["plan"].size());

  const std::string page = read_text(out + "report.html");
  EXPECT_EQ(page.find("http"), std::string::npos) << "nothing from elsewhere";
  EXPECT_EQ(page.find("<b>&."), std::string::npos) << "the name of the scene is escaped";
  EXPECT_NE(page.find("a&lt;b&gt;&amp;.obj"), std::string::npos);
  EXPECT_EQ(count_of(page, "data:image/png;base64,"), 1 + 2 * rows.size() + 1)
      << "truth, settings and their maps, the mask's widths";
  const nlohmann::json& ambiguity = json["ambiguity"];
  EXPECT_EQ(ambiguity["outside"], 0);
  EXPECT_GT(ambiguity["share_over_8"], 0);
  EXPECT_LT(ambiguity["share_over_8"], 0.1);
  EXPECT_GE(ambiguity["share_over_3"], ambiguity["share_over_8"]);
  EXPECT_TRUE(read_png(out + "mask-width.png"));
  EXPECT_EQ(ambiguity["outside_by"], 0);
  EXPECT_NE(page.find("All pixels of the plain setting's picture are within"), std::string::npos);
  // Nobody may take a bound that nothing keeps for one that the last row keeps.
  for (const Cost& cost : costs) ASSERT_GT(cost.error, 0.001);
  EXPECT_NE(page.find("No setting of this report keeps a bound of "), std::string::npos);
  EXPECT_NE(page.find("0.001.</p>"), std::string::npos);
  for (const Row& row : rows) EXPECT_GE(count_of(page, demo::escape_html(row.at("name"))), 2u) << row.at("name");
  for (const char* word : {"<svg", "no material has one", "Not modelled", "scene hash", "numeric contract", "48x32",
                           "beaten by", "errs itself", "class=\"truth\"", "The presets", "<noscript>", "6 frames each", "saves, ms",
                           "1 light;", "are known to &plusmn;", "all trees are built once"})
    EXPECT_NE(page.find(word), std::string::npos) << word;
}

TEST(ProgramReport, WrongUse) {
  const TempFolder folder;
  const std::string scene = write_small_scene(folder);
  folder.write("file", "");
  EXPECT_EQ(2, run_program({"report", scene}, folder.path()).code);
  EXPECT_EQ(2, run_program({"report", scene, "--out", "d", "--frames", "0"}, folder.path()).code);
  const Ran ran = run_program({"report", scene, "--out", "file"}, folder.path());
  EXPECT_EQ(1, ran.code);
  EXPECT_NE(ran.error.find("file: cannot make this folder"), std::string::npos) << ran.error;
  EXPECT_EQ(1, run_program({"report", "missing.obj", "--out", "d"}, folder.path()).code);
}

}  // namespace
}  // namespace spanray
