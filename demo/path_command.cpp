#include "path_command.h"

#include <charconv>
#include <chrono>
#include <filesystem>

#include <CLI/CLI.hpp>

#include "core/atomic_file.h"
#include "core/hash.h"
#include "core/number_text.h"
#include "interrupt.h"
#include "progress_line.h"
#include "spanray/settings_text.h"

namespace spanray::demo {
namespace {

constexpr std::chrono::seconds kSaveEvery{30};

std::string on_off(bool value) { return value ? "on" : "off"; }

CLI::Option* add_switch(CLI::App& command, const std::string& name, bool& value, const std::string& help) {
  return command
      .add_option_function<std::string>(
          name, [&value](const std::string& word) { value = word == "on"; }, help)
      ->check(CLI::IsMember({"on", "off"}))
      ->type_name("on|off");
}

std::string joined(const std::vector<std::string>& parts) {
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : "; ") + part;
  return text;
}

// How good the picture is, in words.
std::string verdict(const PathSums& sums) {
  const std::string text = std::to_string(sums.paths) + (sums.paths == 1 ? " viewing ray" : " viewing rays") + " a pixel";
  if (sums.paths < 2) return text;
  char noise[40];
  std::snprintf(noise, sizeof noise, "%.2g", 100 * sums.noise());
  return text + "; standard error of a pixel " + noise + " % of the mean luminance";
}

}  // namespace

CLI::Option* PathCommand::add_to(CLI::App& command) {
  CLI::Option* rays =
      command.add_option("--paths", paths, "The rendering equation instead, by path tracing: viewing rays a pixel")
          ->check(CLI::Range(uint32_t{1}, kMostPaths))
          ->type_name("N");
  const auto seed = [this](const std::string& text) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), options.seed);
    if (error != std::errc() || end != text.data() + text.size())
      throw CLI::ValidationError("--seed", "'" + text + "' is not a whole number below 2^64");
  };
  CLI::Option* needing[] = {
      command.add_option("--depth", options.depth, "With --paths: most reflections along a path; 64 if not given")
          ->check(CLI::Range(0, kMostDepth))
          ->type_name("D"),
      command
          .add_option("--branching", options.branching,
                      "With --paths: paths that go on from what a viewing ray meets; 1 if not given")
          ->check(CLI::Range(1, kMostBranching))
          ->type_name("B"),
      add_switch(command, "--russian-roulette", options.russian_roulette,
                 "With --paths: end dark paths by chance; on if not given"),
      add_switch(command, "--next-event", options.next_event,
                 "With --paths: look for glowing surfaces on purpose; on if not given"),
      command
          .add_option_function<std::string>("--seed", seed,
                                            "With --paths: of all chance, a whole number below 2^64; 0 if not given")
          ->type_name("S"),
      command.add_option("--accumulate", accumulate, "With --paths: a file that holds the work done; continued if it is there")
          ->type_name("FILE.pfm")};
  for (CLI::Option* option : needing) option->needs(rays);
  return rays;
}

std::string PathCommand::words() const {
  return "depth " + std::to_string(options.depth) + ", branching " + std::to_string(options.branching) + ", Russian roulette " +
         on_off(options.russian_roulette) + ", next event " + on_off(options.next_event) + ", seed " +
         std::to_string(options.seed);
}

PathMeaning PathCommand::meaning(const Job& job) const {
  const Settings& s = job.settings;
  const bool opaque = s.transparency == Transparency::kNone;
  return {{"version", SPANRAY_VERSION},
          {"scene_hash", hash_text(job.scene.hash())},
          {"camera", camera_text(job.camera)},
          {"time", number_text(s.time)},
          {"filter", enum_text(s.filter)},
          {"transparency", opaque ? "none" : "layers"},
          {"culling", enum_text(s.culling)},
          {"textures", on_off(s.textures)},
          {"bump", on_off(s.bump)},
          {"depth", std::to_string(options.depth)},
          {"branching", std::to_string(options.branching)},
          {"russian_roulette", on_off(options.russian_roulette)},
          {"next_event", on_off(options.next_event)},
          {"seed", std::to_string(options.seed)}};
}

Result<PathSums> PathCommand::begin(const Job& job) const {
  std::error_code ignored;
  if (accumulate.empty()) return PathSums{};
  if (auto writable = check_writable(accumulate); !writable) return writable.error();
  if (!std::filesystem::exists(accumulate, ignored)) return PathSums{};
  Result<PathSums> before = read_path_file(accumulate, meaning(job), job.settings.width, job.settings.height);
  if (!before) return before;
  const uint32_t there = before.value().paths;
  if (there > paths)
    return Error{"holds " + std::to_string(there) + " viewing rays a pixel, more than --paths " + std::to_string(paths),
                 accumulate};
  message("continues from " + std::to_string(there) + " viewing rays a pixel: " + accumulate);
  return before;
}

Result<PathPicture> PathCommand::render(const Job& job) const {
  Result<PathSums> begun = begin(job);
  if (!begun) return begun.error();
  PathSums& sums = begun.value();
  const PathMeaning same = meaning(job);
  const Interrupt interrupt;
  if (const auto remarks = path_remarks(job.scene, job.settings); !remarks.empty()) message("paths: " + joined(remarks));
  ProgressLine progress("paths");
  auto saved_at = std::chrono::steady_clock::now();
  uint32_t saved = sums.paths;
  PathControl control;
  control.progress = [&](double fraction) { progress.show(fraction); };
  control.go_on = [&](const PathSums& now) {
    if (!accumulate.empty() && std::chrono::steady_clock::now() - saved_at > kSaveEvery && now.paths < paths) {
      if (write_path_file(accumulate, now, same))
        saved = now.paths;  // where it fails now, it is tried again, and told in the end
      saved_at = std::chrono::steady_clock::now();
    }
    return !interrupt.asked();
  };
  PathOptions with_threads = options;
  with_threads.threads = job.settings.threads;
  const Result<void> traced = trace_paths(job.scene, job.camera, job.settings, with_threads, paths, sums, control);
  progress.clear();
  if (!traced) return traced.error();
  PathPicture made;
  made.stopped = sums.paths < paths;
  if (!accumulate.empty() && saved != sums.paths) made.saved = write_path_file(accumulate, sums, same);
  path_picture(sums, made.picture);
  made.text = std::to_string(sums.paths) + " paths a pixel, " + words();
  message((made.stopped ? "stopped after " : "") + verdict(sums));
  return made;
}

}  // namespace spanray::demo
