// spanray tune: the cheapest settings that keep a budget of time or error, along the scene's camera path.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>

#include "camera_path.h"
#include "command.h"
#include "core/atomic_file.h"
#include "core/hash.h"
#include "frame_options.h"
#include "metric_limit.h"
#include "progress_line.h"
#include "render/check_request.h"
#include "scene/scene_data.h"
#include "trade.h"
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

// A view of the scene with its ground truth.
struct TunedView {
  Camera camera;
  Image truth;
};

// Less is better, whatever the metric: those of which more is better change their sign.
double as_error(const MetricWord& metric, double value) { return metric.more_is_better ? -value : value; }

// The path's views, spread over it; without a path, or with a camera of the user's own, one.
std::vector<TunedView> find_views(const Job& job, const TuneCommand& command) {
  std::vector<TunedView> views;
  const std::vector<CameraKey>& path = job.scene.data().camera_path;
  if (path.empty() || command.frame.camera_given()) return {{job.camera, {}}};
  for (int i = 0; i < command.views; ++i) views.push_back({camera_at(path, time_of_frame(path, i, command.views)), {}});
  return views;
}

Result<void> make_truths(const Job& job, const Settings& exact, const TuneCommand& command, std::vector<TunedView>& views,
                         ProgressLine& progress) {
  for (size_t i = 0; i < views.size(); ++i) {
    if (auto possible = check_request(job.scene, views[i].camera, exact); !possible) return possible;
    ReferenceOptions options;
    options.threads = job.settings.threads, options.grid = command.grid;
    options.progress = [&](double f) {
      progress.show("ground truth", (static_cast<double>(i) + f) / static_cast<double>(views.size()));
    };
    Framebuffer out;
    if (auto done = render_reference(job.scene, views[i].camera, exact, options, out); !done) return done;
    views[i].truth = std::move(out.color);
  }
  return {};
}

// Of the view where the settings are slowest, and of that where they err most.
Result<Cost> measure(const Job& job, const std::vector<TunedView>& views, const Settings& settings, const MetricWord& metric,
                     int frames) {
  Cost worst;
  worst.error = -std::numeric_limits<double>::infinity();
  Parallel parallel(job.settings.threads);
  Renderer renderer;
  for (const TunedView& view : views) {
    Framebuffer picture;
    std::vector<double> ms;
    for (int i = 0; i < frames + 1; ++i) {  // the first warms up
      const Result<FrameStats> stats = renderer.render(job.scene, view.camera, settings, picture);
      if (!stats) return stats.error();
      if (i > 0) ms.push_back(stats.value().ms.frame);
    }
    const Result<Metrics> error = measure_pictures(view.truth, picture.color, parallel);
    if (!error) return error.error();
    worst.ms = std::max(worst.ms, median(ms));
    worst.error = std::max(worst.error, as_error(metric, error.value().*metric.value));
  }
  return worst;
}

std::string settings_toml(const Job& job, const Settings& settings, const std::string& evidence) {
  std::string text = "# " + evidence + "\n# For --settings of `spanray render` and `spanray walk`. Scene " +
                     hash_text(job.scene.hash()) + ".\n[technique]\n";
  for (const auto& [key, value] : settings_words(settings)) {
    if (key == "size")
      text += "width = " + std::to_string(settings.width) + "\nheight = " + std::to_string(settings.height) + "\n";
    else if (value == "on" || value == "off")
      text += key + " = " + (value == "on" ? "true" : "false") + "\n";
    else if (value.find_first_not_of("-+.0123456789e") == std::string::npos)
      text += key + " = " + value + "\n";
    else
      text += key + " = \"" + value + "\"\n";
  }
  return text;
}

std::string evidence_text(const Cost& cost, const MetricWord& metric, size_t views, const Settings& s) {
  char numbers[96];
  std::snprintf(numbers, sizeof numbers, "%.4g ms, %s %.5g", cost.ms, metric.name, as_error(metric, cost.error));
  return std::string("tuned: ") + numbers + " at " + std::to_string(s.width) + "x" + std::to_string(s.height) +
         (views == 1 ? "" : ", each of the worst of " + std::to_string(views) + " views");
}

std::string words_text(const Settings& settings) {
  std::string text;
  for (const auto& [name, value] : settings_words(settings)) text += (text.empty() ? "" : ", ") + name + " " + value;
  return text;
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
  Result<Job> loaded = command.frame.load();
  if (!loaded) return fail(loaded.error());
  Job& job = loaded.value();
  for (const std::string& text : job.messages) message(text);
  if (!command.frame.size_given(job.settings)) job.settings.width = kReportWidth, job.settings.height = kReportHeight;

  const bool by_time = command.limits.empty();
  const MetricWord& metric = by_time ? *metric_from_text("flip") : *command.limits[0].metric;
  const TuneGoal goal{by_time, by_time ? command.max_ms : as_error(metric, command.limits[0].value)};
  const std::vector<Knob> knobs = make_knobs(job.scene, job.settings);
  std::vector<TunedView> views = find_views(job, command);
  ProgressLine progress("tune");
  if (auto done = make_truths(job, exact_settings(knobs, job.settings), command, views, progress); !done)
    return fail(done.error());
  Result<Tuned> tuned =
      tune(knobs, job.settings, goal, [&](const Settings& s) { return measure(job, views, s, metric, command.frames); });
  progress.clear();
  if (!tuned) return fail(tuned.error());
  const std::string evidence = evidence_text(tuned.value().cost, metric, views.size(), tuned.value().settings);
  if (!tuned.value().kept) {
    message("the nearest settings: " + words_text(tuned.value().settings));
    return fail("no settings keep this budget; the nearest of " + std::to_string(tuned.value().tried) + " that were tried, " +
                evidence);
  }
  const std::string text =
      settings_toml(job, tuned.value().settings, evidence + ", " + std::to_string(tuned.value().tried) + " settings tried");
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
