// spanray report: what each technique costs and errs, on the user's own scene.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>

#include <CLI/CLI.hpp>

#include "command.h"
#include "core/atomic_file.h"
#include "core/read_file.h"
#include "frame_options.h"
#include "hard_report.h"
#include "image/false_color.h"
#include "picture.h"
#include "progress_line.h"
#include "report_page.h"

namespace spanray::demo {
namespace {

namespace fs = std::filesystem;

constexpr double kMostDifference = 64;  // of the maps of differences, codes: the same for all, so that they can be compared

struct ReportCommand {
  FrameOptions frame;
  std::string out;
  TradeOptions trade;
  bool hard_cases = false;
  HardReportOptions hard;
};

// Writes a picture and gives back the bytes of the file.
Result<std::string> write_picture(const std::string& path, const Image& image,
                                  const std::vector<std::pair<std::string, std::string>>& text = {}) {
  if (auto written = write_png(path, image, text); !written) return written.error();
  return read_file(path);
}

Result<std::vector<PageImage>> write_pictures(const std::string& folder, const Report& report) {
  std::vector<PageImage> images;
  Result<std::string> truth = write_picture(folder + "/picture-truth.png", report.trade.truth);
  if (!truth) return truth.error();
  images.push_back({"truth", "ground truth", std::move(truth.value()), ""});
  if (auto center = write_picture(folder + "/picture-truth-center.png", report.trade.truth_center); !center)
    return center.error();
  const int width = report.trade.truth.width, height = report.trade.truth.height;
  for (const Measured& m : report.trade.settings) {
    Job job = report.job;
    job.settings = m.candidate.settings;
    Result<std::string> picture = write_picture(folder + "/picture-" + m.candidate.id + ".png", m.picture, picture_text(job));
    if (!picture) return picture.error();
    Result<std::string> flip =
        write_picture(folder + "/flip-" + m.candidate.id + ".png", false_color(m.maps.flip, width, height, 1));
    if (!flip) return flip.error();
    const Image difference = false_color(m.maps.difference, width, height, kMostDifference);
    if (auto written = write_png(folder + "/error-" + m.candidate.id + ".png", difference); !written) return written.error();
    images.push_back({m.candidate.id, m.candidate.name, std::move(picture.value()), std::move(flip.value())});
  }
  return images;
}

// The pictures of an earlier report in this folder.
void remove_old_pictures(const std::string& folder) {
  std::error_code none;
  if (!fs::exists(folder + "/report.json", none)) return;
  std::vector<fs::path> old;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, none)) {
    const std::string name = entry.path().filename().string();
    if (name.ends_with(".png") &&
        (name.starts_with("picture-") || name.starts_with("flip-") || name.starts_with("error-") || name.starts_with("mask-")))
      old.push_back(entry.path());
  }
  for (const fs::path& path : old) fs::remove(path, none);
}

Result<void> write_report(const std::string& folder, const Report& report) {
  remove_old_pictures(folder);
  Result<std::vector<PageImage>> images = write_pictures(folder, report);
  if (!images) return images.error();
  const Result<std::string> mask = write_picture(folder + "/mask-width.png", report.mask.widths);
  if (!mask) return mask.error();
  const std::string json = report_json(report).dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
  if (auto written = write_file_atomic(folder + "/report.csv", report_csv(report)); !written) return written;
  if (auto written = write_file_atomic(folder + "/report.json", json); !written) return written;
  return write_file_atomic(folder + "/report.html", report_page(report, images.value(), mask.value()));
}

int run_report(const ReportCommand& command) {
  if (command.hard_cases) return run_hard_report(command.hard, command.out);
  if (command.frame.scene_path().empty()) throw UsageError("report: SCENE is required");
  if (command.out.empty()) throw UsageError("report: --out is required");
  Result<Job> job = command.frame.load_to_see();
  if (!job) return fail(job.error());
  if (job.value().scene.data().has_exact())
    return fail("report: the scene has spheres or planes, which the ambiguity mask does not model; `reference` and `compare` do without");
  if (auto made = make_report_folder(command.out, "report.html"); !made) return fail(made.error());
  for (const std::string& text : job.value().messages) message(text);
  command.frame.say_what_settings_lose("report");
  Report report;
  report.scene_path = command.frame.scene_path(), report.command = command_line();
  report.job = std::move(job.value()), report.options = command.trade;
  if (!command.frame.size_given(report.job.settings)) report.job.settings.width = kReportWidth, report.job.settings.height = kReportHeight;
  report.knobs = make_knobs(report.job.scene, report.job.settings);
  ProgressLine progress("report");
  report.options.progress = [&](const char* what, double fraction) { progress.show(what, fraction); };
  Result<Trade> trade =
      measure_trade(report.job, report.knobs, make_candidates(report.knobs, report.job.settings), report.options);
  progress.clear();
  if (!trade) return fail(trade.error());
  report.trade = std::move(trade.value());
  const Measured& plain = report.trade.settings[0];
  Result<ReportMask> mask = measure_mask(report.job, plain.candidate.settings, plain.picture,
                                         [&](double fraction) { progress.show("ambiguity mask", fraction); });
  progress.clear();
  if (!mask) return fail(mask.error());
  report.mask = std::move(mask.value());
  report.dominated = dominated_by(costs(report));
  report.not_modelled = find_not_modelled(report.job);
  report.machine = describe_machine(report);
  if (auto written = write_report(command.out, report); !written) return fail(written.error());
  std::printf("%s/report.html\nthe ground truth itself errs by %s\n", command.out.c_str(),
              metrics_text(report.trade.truth_error).c_str());
  return kDone;
}

// All other options belong to a SCENE.
void add_hard_cases(CLI::App& command, ReportCommand& options) {
  CLI::Option* const hard = command.add_flag(
      "--hard-cases", options.hard_cases,
      "No SCENE: measures every hard case of rasterizing, texturing, shading and tracing, and prints the table; --out writes it, "
      "with error curves, as hard-cases.html, .csv and .json. Exit 1 where one fails");
  for (CLI::Option* option : command.get_options())
    if (option != hard && option != command.get_help_ptr() && option->get_name() != "--out") hard->excludes(option);
  command.add_flag("--quick", options.hard.quick, "With --hard-cases: fewer of everything")->needs(hard);
  command.add_option("--only", options.hard.only, "With --hard-cases: these, such as R1,Y7,depth-steps")->delimiter(',')->needs(hard)->type_name("ID,...");
  command.add_option("--json", options.hard.json, "With --hard-cases: the table and the curves as JSON; - for standard output")->needs(hard)->type_name("F.json");
}

}  // namespace

void add_report(CLI::App& app, Run& run) {
  CLI::App* command = app.add_subcommand(
      "report", "Speed against error: every technique measured and compared with the ground truth, as an HTML page");
  auto options = std::make_shared<ReportCommand>();
  options->frame.add_without_techniques(*command);
  command->get_option("SCENE")->required(false);  // not with --hard-cases; run_report() asks for it otherwise
  command->add_option("--out", options->out, "Folder of the report: report.html, report.csv, report.json and pictures; required for a SCENE")
      ->type_name("DIR");
  command->add_option("--frames", options->trade.frames, "Frames of each setting; default 30")
      ->check(CLI::Range(1, 10000))
      ->type_name("N");
  command->add_option("--warmup", options->trade.warmup, "Frames before them, not measured; default 2")
      ->check(CLI::Range(0, 1000))
      ->type_name("N");
  command->add_option("--grid", options->trade.grid, "The ground truth takes N x N samples a pixel; default 4")
      ->check(CLI::Range(1, 64))
      ->type_name("N");
  add_hard_cases(*command, *options);
  command->callback([options, &run] { run = [options] { return run_report(*options); }; });
}

}  // namespace spanray::demo
