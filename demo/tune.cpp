// spanray tune: the cheapest settings that keep a budget of time or error, along the scene's camera path.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>

#include <CLI/CLI.hpp>

#include "command.h"
#include "core/atomic_file.h"
#include "core/counted.h"
#include "core/hash.h"
#include "frame_options.h"
#include "metric_limit.h"
#include "progress_line.h"
#include "trade.h"
#include "tune_views.h"
#include "tuner.h"

namespace spanray::demo {
namespace {

struct TuneCommand {
  FrameOptions frame;
  std::string out;
  double max_ms = 0;
  std::vector<MetricLimit> limits;  // one at most
  int views = 3, frames = 10, grid = 4;
};

// evidence: lines of comment.
std::string settings_toml(const Job& job, const Settings& settings, const std::string& evidence) {
  std::string text = evidence + "# For --settings of `spanray render` and `spanray walk`. Scene " +
                     hash_text(job.scene.hash()) + ".\n[technique]\n";
  for (const auto& [key, value] : settings_words(settings)) {
    if (key == "size")
      text += "width = " + std::to_string(settings.width) + "\nheight = " + std::to_string(settings.height) + "\n";
    else if (key == "textures" || key == "bump")
      text += key + " = " + (value == "on" ? "true" : "false") + "\n";
    else if (value.find_first_not_of("-+.0123456789e") == std::string::npos)
      text += key + " = " + value + "\n";
    else
      text += key + " = \"" + value + "\"\n";
  }
  return text;
}

std::string number4(double v) {
  char text[40];
  std::snprintf(text, sizeof text, "%.4g", v);
  return text;
}

std::string cost_text(const Cost& cost, const MetricWord& metric) {
  return number4(cost.ms) + " ms, " + metric.name + " " + number4(as_error(metric, cost.error));
}

std::string evidence_text(const Cost& cost, const MetricWord& metric, size_t views, const Settings& s) {
  return "tuned: " + cost_text(cost, metric) + " at " + std::to_string(s.width) + "x" + std::to_string(s.height) +
         (views == 1 ? "" : ", each of the worst of " + std::to_string(views) + " views");
}

std::string words_text(const Settings& settings) {
  std::string text;
  for (const auto& [name, value] : settings_words(settings)) text += (text.empty() ? "" : ", ") + name + " " + value;
  return text;
}

// What `other` sets otherwise than `these`.
std::string difference_text(const Settings& these, const Settings& other) {
  std::string text;
  const auto words = settings_words(these), others = settings_words(other);
  for (size_t i = 0; i < words.size(); ++i)
    if (words[i].second != others[i].second) text += (text.empty() ? "" : ", ") + others[i].first + " " + others[i].second;
  return text;
}

constexpr size_t kContenders = 3;  // that are measured beside each other a second time
constexpr int kMostRounds = 4;     // of contenders, until one keeps the budget again
constexpr int kFramesAgain = 30;   // of each contender and view, at least

// The winner is declared only after a second measurement, in turns with the next best and with the plain settings: the first
// was taken alone, and a search over many settings prefers those that were lucky.
struct Declared {
  Tuned tuned;
  std::string evidence;  // lines of comment
};
Result<Declared> declare(const Job& job, const std::vector<TunedView>& views, const std::vector<Knob>& knobs,
                         const Tuned& found, const TuneGoal& goal, const MetricWord& metric, int frames,
                         ProgressLine& progress) {
  Declared out{found, ""};
  out.tuned.kept = false;
  std::vector<Tried> list = {{found.settings, found.cost}};
  list.insert(list.end(), found.others.begin(), found.others.end());
  const Settings plain = plain_settings(knobs, job.settings);
  for (size_t first = 0; first < std::min(list.size(), kContenders * kMostRounds) && !out.tuned.kept; first += kContenders) {
    std::vector<Tried> contenders(list.begin() + static_cast<ptrdiff_t>(first),
                                  list.begin() + static_cast<ptrdiff_t>(std::min(first + kContenders, list.size())));
    std::vector<Settings> settings;
    for (const Tried& t : contenders) settings.push_back(t.settings);
    if (std::none_of(settings.begin(), settings.end(), [&](const Settings& s) { return same_settings(s, plain); }))
      settings.push_back(plain);
    const Result<std::vector<Timed>> times =
        time_in_turns(job, views, settings, frames, [&](double f) { progress.show("measuring the best again, in turns", f); });
    if (!times) return times.error();
    for (size_t i = 0; i < contenders.size(); ++i) contenders[i].cost.ms = times.value()[i].median_ms;
    const int chosen = choose_again(contenders, goal);
    const auto sooner = [](const Tried& a, const Tried& b) { return a.cost.ms < b.cost.ms; };
    const Tried& best = chosen >= 0 ? contenders[static_cast<size_t>(chosen)]
                                    : *std::min_element(contenders.begin(), contenders.end(), sooner);
    if (chosen >= 0 || first == 0 || best.cost.ms < out.tuned.cost.ms)
      out.tuned.settings = best.settings, out.tuned.cost = best.cost, out.tuned.kept = chosen >= 0;
    out.evidence += "# measured again, " + std::to_string(frames) + " frames of each and view in turns" +
                    (chosen >= 0 ? ":\n" : ", and none keeps the budget:\n");
    for (size_t i = 0; i < settings.size(); ++i) {
      const bool contends = i < contenders.size();
      const std::string name = same_settings(settings[i], plain) ? "plain" : "";
      const std::string what = chosen >= 0 && static_cast<int>(i) == chosen
                                   ? "these settings" + (name.empty() ? "" : ", " + name)
                                   : (name.empty() ? "with " : name + ": ") + difference_text(best.settings, settings[i]);
      out.evidence +=
          "#   " + number4(times.value()[i].median_ms) + " ms (95th percentile " + number4(times.value()[i].p95_ms) + ")" +
          (contends ? ", " + std::string(metric.name) + " " + number4(as_error(metric, contenders[i].cost.error)) : "") + ": " +
          (what == "with " ? words_text(best.settings) : what) + "\n";
    }
  }
  return out;
}

// Where the ground truth itself errs as much as the bound allows, keeping the bound says little.
std::string truth_text(double own_error, const MetricWord& metric, int grid) {
  return "the ground truth itself, with " + std::to_string(grid * grid) + " samples a pixel, errs by " + metric.name + " " +
         number4(as_error(metric, own_error));
}

int run_tune(const TuneCommand& command) {
  if (std::isnan(command.max_ms)) throw UsageError("tune: --max-ms is not a number");
  if ((command.max_ms > 0) == !command.limits.empty())
    throw UsageError("tune: give one budget, --max-ms X or --max-error METRIC=VALUE");
  if (command.limits.size() > 1) throw UsageError("tune: one --max-error is enough");
  if (!command.out.empty() && std::filesystem::path(command.out).extension() != ".toml")
    throw UsageError("tune: the file of --out must end in .toml: " + command.out);
  std::error_code none;
  if (!command.out.empty() && std::filesystem::equivalent(command.out, command.frame.scene_path(), none))
    throw UsageError("tune: --out would replace the scene, " + command.out);
  if (!command.out.empty())
    if (auto writable = check_writable(command.out); !writable) return fail(writable.error());
  Result<Job> loaded = command.frame.load_to_see();
  if (!loaded) return fail(loaded.error());
  Job& job = loaded.value();
  for (const std::string& text : job.messages) message(text);
  command.frame.say_what_settings_lose("tune");
  if (!command.frame.size_given(job.settings)) job.settings.width = kReportWidth, job.settings.height = kReportHeight;

  const bool by_time = command.limits.empty();
  const MetricWord& metric = by_time ? *metric_from_text("flip") : *command.limits[0].metric;
  const TuneGoal goal{by_time, by_time ? command.max_ms : as_error(metric, command.limits[0].value)};
  const std::vector<Knob> knobs = make_knobs(job.scene, job.settings);
  std::vector<TunedView> views = find_views(job, command.views, !command.frame.camera_given());
  ProgressLine progress("tune");
  if (auto done = make_truths(job, exact_settings(knobs, job.settings), command.grid, views,
                              [&](double f) { progress.show("ground truth", f); });
      !done)
    return fail(done.error());
  uint64_t tried = 0;
  Result<Tuned> found = tune(knobs, job.settings, goal, [&](const Settings& s) {
    progress.say("searching", counted(tried++, "setting tried", "settings tried"));
    return measure_settings(job, views, s, metric, command.frames);
  });
  if (!found) return progress.clear(), fail(found.error());
  Result<Declared> declared = Declared{found.value(), ""};
  if (found.value().kept)
    declared = declare(job, views, knobs, found.value(), goal, metric, std::max(kFramesAgain, command.frames), progress);
  progress.clear();
  if (!declared) return fail(declared.error());
  const Tuned& tuned = declared.value().tuned;
  const double own_error = truth_error(views, metric);
  const std::string truth = truth_text(own_error, metric, command.grid);
  if (!by_time && own_error >= goal.budget)
    message(truth + ": this bound is below what can be known; a larger --grid makes it finer");
  const std::string evidence = evidence_text(tuned.cost, metric, views.size(), tuned.settings);
  if (!tuned.kept) {
    std::fputs(declared.value().evidence.c_str(), stderr);
    message("the nearest settings: " + words_text(tuned.settings));
    return fail("no settings keep this budget; the nearest of " + std::to_string(tuned.tried) + " that were tried, " +
                evidence);
  }
  const std::string text = settings_toml(job, tuned.settings,
                                         "# " + evidence + ", " + std::to_string(tuned.tried) + " settings tried\n" +
                                             declared.value().evidence + "# " + truth + "\n");
  std::fputs(text.c_str(), stdout);
  if (!command.out.empty())
    if (auto written = write_file_atomic(command.out, text); !written) return fail(written.error());
  return kDone;
}

}  // namespace

void add_tune(CLI::App& app, Run& run) {
  CLI::App* command = app.add_subcommand("tune", "Find the cheapest settings that keep a budget of time or error");
  auto options = std::make_shared<TuneCommand>();
  options->frame.add_without_techniques(*command);
  command->add_option("--max-ms", options->max_ms, "A frame may take X milliseconds (median); the error is made least")
      ->check(CLI::Range(1e-3, 1e6))
      ->type_name("X");
  command
      ->add_option_function<std::vector<std::string>>(
          "--max-error",
          [options](const std::vector<std::string>& words) {
            for (const std::string& word : words) options->limits.push_back(parse_metric_limit(word));
          },
          "The error may be this; the time is made least. METRIC: " + metric_choices() +
              "; of psnr_db and ssim VALUE is the least allowed")
      ->type_name("METRIC=VALUE")
      ->allow_extra_args(false);
  command->add_option("--out", options->out, "Write the settings, for --settings of other commands")->type_name("F.toml");
  command->add_option("--views", options->views, "Views of the scene's camera path; default 3")
      ->check(CLI::Range(1, 100))
      ->type_name("N");
  command->add_option("--frames", options->frames, "Frames of each setting and view; default 10")
      ->check(CLI::Range(1, 10000))
      ->type_name("N");
  command->add_option("--grid", options->grid, "The ground truth takes N x N samples a pixel; default 4")
      ->check(CLI::Range(1, 64))
      ->type_name("N");
  command->callback([options, &run] { run = [options] { return run_tune(*options); }; });
}

}  // namespace spanray::demo
