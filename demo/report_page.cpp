#include "report_page.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "core/counted.h"
#include "core/number_text.h"
#include "presets.h"
#include "report_html.h"
#include "report_plan.h"
#include "report_plot.h"
#include "report_style.h"
#include "truth.h"

namespace spanray::demo {
namespace {

const Measured& setting(const Report& r, int i) { return r.trade.settings[static_cast<size_t>(i)]; }
std::string name_of(const Report& r, int i) { return escape_html(setting(r, i).candidate.name); }

// What the errors of this page are worth.
std::string truth_error(const Report& r) {
  const Metrics& own = r.trade.truth_error;
  const int grid = r.options.grid, other = second_grid(grid);
  const auto near = std::count_if(r.trade.settings.begin(), r.trade.settings.end(),
                                  [&](const Measured& m) { return m.error.*kRankedBy < 2 * own.*kRankedBy; });
  std::string text = "<p>The ground truth has " + std::to_string(grid * grid) +
                     " samples a pixel, and <b>errs itself</b>: from a second one, with " + std::to_string(other * other) +
                     " samples at other places, it is FLIP <b>" + short_number(own.flip) + "</b> away";
  for (const MetricWord& word : kMetricWords)
    if (word.value != kRankedBy) text += std::string(", ") + word.name + " " + short_number(own.*word.value);
  text += ". Errors as small as that are not known; a larger <code>--grid</code> makes it less.</p>\n";
  if (near > 0)
    text += "<p class=\"warn\">" + std::to_string(near) + (near == 1 ? " setting errs" : " settings err") +
            " by less than twice the error of the ground truth itself: which of them is better is not known.</p>\n";
  return text;
}

// What the times of this page are worth: half of the interval that has the median, by the frames of the setting.
std::string times_error(const Report& r) {
  std::vector<double> shares;
  for (const Measured& m : r.trade.settings) {
    const MedianInterval known = m.interval_ms();
    shares.push_back(50 * (known.high - known.low) / m.median_ms());
  }
  return "<p>Medians of " + counted(static_cast<uint64_t>(r.options.frames), "frame", "frames") + " are known to &plusmn;<b>" +
         short_number(median(shares)) + " %</b> here, to &plusmn;" +
         short_number(*std::max_element(shares.begin(), shares.end())) +
         " % at worst (half of the 95 % interval of the median, by rank, as if frames were independent; the middle of all "
         "settings). Which of two settings is faster is not known where they differ by less, nor then which beats which; more "
         "<code>--frames</code> and a quieter machine make it less.</p>\n";
}

std::string summary(const Report& r) {
  const Measured& plain = r.trade.settings[0];
  const std::vector<Cost> all = costs(r);
  const auto best = std::min_element(all.begin(), all.end(), [](const Cost& a, const Cost& b) { return a.error < b.error; });
  const auto fastest = std::min_element(all.begin(), all.end(), [](const Cost& a, const Cost& b) { return a.ms < b.ms; });
  std::string text = "<p>With every technique exact and one sample a pixel a frame takes <b>" + milliseconds(all[0].ms) +
                     " ms</b> (median; " + milliseconds(plain.p95_ms()) + " at the 95th percentile) and errs by FLIP <b>" +
                     short_number(all[0].error) + "</b> against the ground truth";
  if (plain.error_alone && plain.wrong_ids) {
    const double pixels = static_cast<double>(r.job.settings.width) * r.job.settings.height;
    text += ". Against the reference that has one sample at each pixel's center, too, it errs by <b>" +
            short_number(plain.error_alone->flip) + "</b> (" + std::to_string(*plain.wrong_ids) + " of " +
            std::to_string(static_cast<long>(pixels)) + " pixels see another triangle, " +
            short_number(100 * plain.error_alone->over_1) + " % are more than 1 of 255 off)";
    if (plain.error_alone->flip < 0.5 * plain.error.flip) text += ": the rest is aliasing";
  }
  text += ".</p>\n<p>The fastest setting, <i>" + name_of(r, static_cast<int>(fastest - all.begin())) + "</i>, takes " +
          milliseconds(fastest->ms) + " ms and errs by " + short_number(fastest->error) + "; the one that errs least, <i>" +
          name_of(r, static_cast<int>(best - all.begin())) + "</i>, takes " + milliseconds(best->ms) + " ms and errs by " +
          short_number(best->error) + ".</p>\n";
  text += truth_error(r);
  const auto disturbed = std::count_if(r.trade.settings.begin(), r.trade.settings.end(),
                                       [](const Measured& m) { return m.p95_ms() > 1.5 * m.median_ms(); });
  if (disturbed > 0)
    text +=
        "<p class=\"warn\">Of " + std::to_string(disturbed) +
        " settings the 95th percentile is more than 1.5 times the median: other programs were at work, or the frames too few.</p>\n";
  return text + times_error(r);
}

// The plot of one metric, and its front as a table: the same numbers in both.
std::string plot_of(const Report& r, const MetricWord& word) {
  std::vector<Cost> points;
  for (const Measured& m : r.trade.settings) points.push_back({m.median_ms(), m.error.*word.value});
  const std::vector<int> beaten = dominated_by(points);
  std::vector<PlotPoint> plot;
  std::vector<int> front;
  for (size_t i = 0; i < points.size(); ++i) {
    plot.push_back({points[i], r.trade.settings[i].candidate.id, r.trade.settings[i].candidate.name, beaten[i] < 0});
    if (beaten[i] < 0) front.push_back(static_cast<int>(i));
  }
  std::stable_sort(front.begin(), front.end(), [&](int a, int b) { return setting(r, a).median_ms() < setting(r, b).median_ms(); });
  const std::string unit = *word.unit != 0 ? std::string(" (") + word.unit + ")" : "";
  std::string text = std::string("<div class=\"plot\" id=\"plot-") + word.name + "\"" + (word.value == kRankedBy ? "" : " hidden") + "><div class=\"wide\">" +
                     scatter_plot(plot, word.name + unit, r.trade.truth_error.*word.value) + "</div><h3>The front, by " + word.name +
                     "</h3>\n<div class=\"wide\"><table>" + head({"Setting", "number", "median ms", "p95 ms", (word.name + unit).c_str()});
  for (size_t k = 0; k < front.size(); ++k) {
    const Measured& m = setting(r, front[k]);
    text += "<tr class=\"pick\" data-id=\"" + escape_html(m.candidate.id) + "\">" + cell(name_of(r, front[k]), "text") +
            cell(std::to_string(k + 1), "front") + cell(milliseconds(m.median_ms())) + cell(milliseconds(m.p95_ms())) +
            cell(m.error.*word.value) + "</tr>\n";
  }
  return text + "</table></div></div>\n";
}

std::string scatter(const Report& r) {
  std::string text =
      "<h2>Error against time</h2>\n<p>Each point is a setting. Filled and numbered: the Pareto front, settings that no other "
      "one beats in both; the table under the plot names them. Hollow: some other setting is as fast and errs less, or as little and is faster. A "
      "click shows the picture below. Error by <select id=\"metric\">";
  for (const MetricWord& word : kMetricWords)
    if (!word.more_is_better)
      text += std::string("<option") + (word.value == kRankedBy ? " selected" : "") + ">" + word.name + "</option>";
  text += "</select>; all tables but this one rank by flip.</p>\n";
  for (const MetricWord& word : kMetricWords)
    if (!word.more_is_better) text += plot_of(r, word);
  return text;
}

std::string pareto_cell(const Report& r, size_t i) {
  return r.dominated[i] < 0 ? cell("on the front", "front won") : cell("beaten by " + name_of(r, r.dominated[i]), "beaten");
}

// name: as it stands under the heading of its group.
std::string setting_row(const Report& r, size_t i, const std::string& name) {
  const Measured &m = r.trade.settings[i], &plain = r.trade.settings[0];
  const double ratio = m.median_ms() / plain.median_ms();
  const Metrics& e = m.error;
  std::string text = "<tr class=\"pick" + std::string(i == 0 ? " plain" : "") + "\" data-id=\"" + escape_html(m.candidate.id) +
                     "\">" + cell(escape_html(name), "text") + cell(milliseconds(m.median_ms())) +
                     cell(milliseconds(m.p95_ms())) + cell(hundredths(ratio) + " x");
  text += cell(m.wrong_ids ? std::to_string(*m.wrong_ids) : "–") + cell(e.flip) +
          cell(m.error_alone ? short_number(m.error_alone->flip) : "–") + cell(e.max) + cell(e.p99_9) +
          cell(short_number(100 * e.over_1) + " %") + cell(e.rmse_linear) + cell(e.relmse) + cell(e.psnr_db) + cell(e.ssim);
  return text + pareto_cell(r, i) + "</tr>\n";
}

std::string knob_table(const Report& r) {
  std::string text =
      "<h2>Knob by knob</h2>\n<p>Each row turns one knob of the plain settings (the first row). Errors are those of the "
      "picture as shown, against the ground "
      "truth with its many samples; <i>FLIP alone</i> is against the reference with one sample at each pixel's center, so that "
      "it counts what the technique "
      "errs and not the lack of samples. <i>Wrong ids</i>: pixels whose center sees another triangle than the reference "
      "says.</p>\n<div class=\"wide\"><table>" +
      head({"Setting", "median ms", "p95 ms", "of plain", "wrong ids", "FLIP", "FLIP alone", "max", "p99.9", "off by &gt; 1",
            "RMSE linear", "relMSE", "PSNR dB", "SSIM", over_text("Pareto")});
  text += setting_row(r, 0, r.trade.settings[0].candidate.name);
  const auto rows_of = [&](const std::string& group) {
    std::string rows;
    for (size_t i = 1; i < r.trade.settings.size(); ++i)
      if (const Candidate& c = r.trade.settings[i].candidate; c.group == group)
        rows += setting_row(r, i, c.name.starts_with(group + ": ") ? c.name.substr(group.size() + 2) : c.name);
    return rows;
  };
  for (const Knob& knob : r.knobs) {
    text += "<tr class=\"group\"><td colspan=\"15\">" + escape_html(knob.name) + " <span>" + escape_html(knob.what) +
            (knob.absent.empty() ? "; plain: " + escape_html(knob.choices[knob.plain].word)
                                 : ". Not measured: " + escape_html(knob.absent)) +
            "</span></td></tr>\n";
    text += rows_of(knob.name);
  }
  if (const std::string presets = rows_of("preset"); !presets.empty())
    text += "<tr class=\"group\"><td colspan=\"15\">preset <span>those that equal no other row</span></td></tr>\n" + presets;
  text +=
      "<tr class=\"group\"><td colspan=\"15\">ladder <span>from every knob at its cheapest to every knob exact, one after the "
      "other; steps that equal a row above are left out</span></td></tr>\n" +
      rows_of("ladder");
  return text + "</table></div>\n";
}

std::string preset_table(const Report& r) {
  std::string text =
      "<h2>The presets</h2>\n<p>What <code>--preset</code> of <code>render</code> and <code>walk</code> costs and errs on this "
      "scene.</p>\n<div class=\"wide\"><table>" +
      head({"Preset", "median ms", "p95 ms", "FLIP", "RMSE linear", "PSNR dB", over_text("Pareto"), over_text("what it asks for")});
  for (const Preset& preset : kPresets)
    for (size_t i = 0; i < r.trade.settings.size(); ++i) {
      const Measured& m = r.trade.settings[i];
      if (m.candidate.preset != preset.name) continue;
      text += "<tr class=\"pick\" data-id=\"" + escape_html(m.candidate.id) + "\">" + cell(preset.name, "text") +
              cell(milliseconds(m.median_ms())) + cell(milliseconds(m.p95_ms())) + cell(m.error.flip) +
              cell(m.error.rmse_linear) + cell(m.error.psnr_db) +
              pareto_cell(r, i) + cell(preset.what, "text") + "</tr>\n";
    }
  return text + "</table></div>\n";
}

std::string stage_table(const Report& r) {
  std::string text =
      "<h2>Where the time goes</h2>\n<p>Median milliseconds of each stage. Stages inside tiles are thread time divided by the "
      "number of threads, so a row adds up to less "
      "than its frame where threads wait, for each other or, on a busy machine, for a processor; medians of stages are of "
      "different frames, so it may also add up to a little more. Building the trees happens once a scene, is measured once, and "
      "is not part of a frame.</p>\n<div "
      "class=\"wide\"><table><tr><th class=\"text\">Setting</th>";
  for (const auto& stage : kStages) text += std::string("<th>") + stage.name + "</th>";
  text += "</tr>\n";
  for (const Measured& m : r.trade.settings) {
    text += "<tr>" + cell(escape_html(m.candidate.name), "text");
    for (const auto& stage : kStages) {
      const double ms = stage.time == &StageTimes::bvh_build ? m.bvh_build_ms : m.median_ms(stage.time);
      text += cell(ms == 0 ? "–" : milliseconds(ms));
    }
    text += "</tr>\n";
  }
  return text + "</table></div>\n";
}

// budgets: those of a table that have no row, since no setting keeps them.
std::string kept_by_none(const char* what, const std::string& budgets, const char* unit) {
  if (budgets.empty()) return "";
  return std::string("<p>No setting of this report keeps a ") + what + " of " + budgets + unit + ".</p>\n";
}

std::string budget_tables(const Report& r) {
  const std::vector<Cost> points = costs(r);
  const auto row = [&](const std::string& budget, int i) {
    return "<tr class=\"pick\" data-id=\"" + escape_html(setting(r, i).candidate.id) + "\">" + cell(name_of(r, i), "text") +
           cell(budget) + cell(milliseconds(points[static_cast<size_t>(i)].ms)) + cell(points[static_cast<size_t>(i)].error) +
           "</tr>\n";
  };
  std::string text =
      "<h2>Equal time, equal error</h2>\n<h3>The least error for a budget of time</h3>\n<div class=\"wide\"><table>" +
      head({"Setting", "budget, ms", "median ms", "FLIP"});
  std::string none;
  int last = -1;
  for (const double ms : {1., 2., 4., 8., 16., 33., 50., 66., 100., 150., 200., 300., 500., 1000., 2000., 5000.}) {
    const int i = best_within_time(points, ms);
    if (i >= 0 && i != last) text += row(number_text(ms), i);
    if (i < 0) none += (none.empty() ? "" : ", ") + number_text(ms);
    last = i;
  }
  text += "</table></div>\n" + kept_by_none("budget", none, " ms") + "<h3>The least time for a bound on the error</h3>\n<div class=\"wide\"><table>" +
          head({"Setting", "FLIP at most", "median ms", "FLIP"});
  none.clear(), last = -1;
  for (const double error :
       {0.5, 0.3, 0.2, 0.15, 0.1, 0.07, 0.05, 0.03, 0.02, 0.015, 0.01, 0.007, 0.005, 0.003, 0.002, 0.001}) {
    const int i = fastest_within_error(points, error);
    if (i >= 0 && i != last) text += row(number_text(error), i);
    if (i < 0) none += (none.empty() ? "" : ", ") + number_text(error);
    last = i;
  }
  return text + "</table></div>\n" + kept_by_none("bound", none, "") + "<p class=\"dim\">Budgets and bounds that some setting keeps, but the same as that of the row before, are left out.</p>\n";
}

const char* const kPictures = R"html(<h2 id="pictures">Pictures</h2>
<p><label>Left of the bar <select id="left"></select></label> <label>Right of it <select id="right"></select></label></p>
<noscript><p class="warn">Choosing and sliding need scripts. Without them, the pictures are in the folder of this page: picture-truth.png, and
picture-NAME.png, flip-NAME.png and error-NAME.png of each setting. All plots are shown.</p></noscript>
<div class="needs-script"><div id="slider" class="slider"><img id="under" alt="left picture" draggable="false"><img id="over" class="over" alt="right picture" draggable="false"><div id="bar" class="bar"></div></div>
<input id="where" type="range" min="0" max="100" step="0.1" value="50" aria-label="where the bar stands">
<p><span class="dim"><span id="name-left"></span> | <span id="name-right"></span></span></p>
<div class="pair"><figure><img id="pair-picture" alt="picture"><figcaption id="pair-name"></figcaption></figure>
<figure><img id="pair-flip" alt="FLIP map"><figcaption>its FLIP against the ground truth: black equal, pale yellow 1</figcaption></figure></div></div>
<p class="dim">Differences of codes are in the folder of this page, as error-NAME.png (pale yellow is 64 of 255 or more).</p>
)html";

std::string machine_section(const Report& r) {
  std::string text = "<h2>To repeat this</h2>\n<div class=\"wide\"><table>\n";
  for (const auto& [key, value] : r.machine)
    text += "<tr>" + cell(escape_html(key), "text") + cell("<code>" + escape_html(value) + "</code>", "text") + "</tr>\n";
  return text +
         "</table></div>\n<p>How the renderer does where arithmetic is hard, on this machine: <code>spanray report --hard-cases --out DIR</code>.</p>\n<p>All numbers stand in <code>report.csv</code> and <code>report.json</code> beside this page, with "
         "every digit; the pictures as PNG. Errors are those that "
         "<code>spanray compare picture-truth.png picture-NAME.png</code> prints.</p>\n";
}

// In a script, "</" must not appear; JSON strings allow "<\/".
std::string script_string(const std::string& text) {
  std::string out = nlohmann::json(text).dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
  for (size_t at = 0; (at = out.find("</", at)) != std::string::npos;) out.insert(at + 1, "\\");
  return out;
}

}  // namespace

std::string report_page(const Report& r, const std::vector<PageImage>& images, const std::string& mask_png) {
  const std::string title = "Speed against error: " + escape_html(std::filesystem::path(r.scene_path).filename().string());
  std::string page =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" content=\"width=device-width, "
      "initial-scale=1\">\n<title>" +
      title + "</title>\n<style>" + kReportStyle + "</style><noscript><style>" + kReportStyleWithoutScript + "</style></noscript></head>\n<body>\n<h1>" + title + "</h1>\n<p class=\"dim\">";
  page += std::to_string(r.job.settings.width) + " x " + std::to_string(r.job.settings.height) + " pixels, " +
          std::to_string(r.job.scene.triangle_count()) + " triangles, " + counted(r.job.scene.light_count(), "light", "lights") + "; " + std::to_string(r.trade.settings.size()) + " settings, " + counted(static_cast<uint64_t>(r.options.frames), "frame", "frames") +
          " each. FLIP is 0 for pictures that nobody can tell apart and 1 for the greatest difference there is.</p>\n";
  page += summary(r) + scatter(r) + preset_table(r) + knob_table(r) + kPictures + mask_section(r.mask, mask_png) +
          budget_tables(r) + stage_table(r) + plan_section(r) + machine_section(r);
  page += "<script>\nconst IMAGES = {\n";
  for (const PageImage& image : images) {
    page += script_string(image.id) + ": {name: " + script_string(image.name) + ", picture: \"data:image/png;base64," +
            base64(image.picture_png) + "\"";
    if (!image.flip_png.empty()) page += ", flip: \"data:image/png;base64," + base64(image.flip_png) + "\"";
    page += "},\n";
  }
  page += "};\nconst FIRST = " + script_string(r.trade.settings[0].candidate.id) + ";\n" + kReportScript +
          "</script>\n</body></html>\n";
  return page;
}

}  // namespace spanray::demo
