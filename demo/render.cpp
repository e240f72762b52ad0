// spanray render: one scene, headless, to files.
#include <cstdio>
#include <filesystem>
#include <memory>

#include <CLI/CLI.hpp>

#include "command.h"
#include "core/atomic_file.h"
#include "core/hash.h"
#include "frame/ladder.h"
#include "frame_options.h"
#include "image/pfm.h"
#include "picture.h"
#include "spanray/settings_text.h"
#include "stats_json.h"

namespace spanray::demo {
namespace {

constexpr int kMaxFrames = 1000000;

struct RenderOptions {
  FrameOptions frame;
  std::string out, stats, ladder, radiance, depth;
  View view = View::kColor;
  int frames = 1, warmup = 0;
  double time_step = 0;  // seconds from frame to frame
  bool hash = false, ids_hash = false;

  // The files that will be written.
  std::vector<std::string> files() const {
    std::vector<std::string> list;
    for (const std::string* file : {&out, &ladder, &radiance, &depth, &stats})
      if (!file->empty() && !(file == &stats && stats == "-")) list.push_back(*file);
    return list;
  }
};

// Two names of one file, whether it is there or not.
bool same_place(const std::string& a, const std::string& b) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  return fs::weakly_canonical(fs::absolute(a, ignored), ignored) == fs::weakly_canonical(fs::absolute(b, ignored), ignored);
}

// Everything about the outputs that can be known before loading and rendering.
Result<void> check_outputs(const RenderOptions& options) {
  const std::vector<std::string> files = options.files();
  if (files.empty() && options.stats.empty() && !options.hash && !options.ids_hash)
    throw UsageError("render: nothing to do; give --out F.png, --hash, --stats or another output");
  if (options.stats == "-" && (options.hash || options.ids_hash))
    throw UsageError("render: --stats - and a hash would share standard output; the statistics have `hash` in them");
  if (!options.out.empty() && std::filesystem::path(options.out).extension() != ".png")
    throw UsageError("render: --out writes PNG, so its file must end in .png: " + options.out);
  for (const std::string& file : files)
    if (same_place(file, options.frame.scene_path())) throw UsageError("render: " + file + " is the scene itself");
  // The extensions also keep outputs from replacing what a scene is made of.
  const auto must_end = [](const char* option, const std::string& file, const char* extension) {
    if (!file.empty() && file != "-" && std::filesystem::path(file).extension() != extension)
      throw UsageError(std::string("render: the file of ") + option + " must end in " + extension + ": " + file);
  };
  must_end("--stats", options.stats, ".json"), must_end("--ladder", options.ladder, ".json");
  must_end("--depth", options.depth, ".pfm"), must_end("--radiance", options.radiance, ".pfm");
  for (size_t i = 0; i < files.size(); ++i) {
    for (size_t j = 0; j < i; ++j)
      if (same_place(files[i], files[j]))
        throw UsageError("render: two outputs would be written to " + files[i]);
    if (auto writable = check_writable(files[i]); !writable) return writable;
  }
  return {};
}

Result<Measurement> measure(const Job& job, const RenderOptions& options, Framebuffer& picture, Ladder& ladder) {
  Renderer renderer;
  Measurement measured;
  measured.warmup = options.warmup;
  for (int frame = 0; frame < options.warmup + options.frames; ++frame) {
    FrameRequest request;
    request.radiance = !options.radiance.empty();
    request.depth = !options.depth.empty();
    request.primitive = options.ids_hash;
    add_request(options.view, request);
    // Only the last frame climbs the ladder: hashing costs time that does not belong to the others.
    if (!options.ladder.empty() && frame + 1 == options.warmup + options.frames) request.ladder = &ladder;
    // The frames before the measured ones come before them in time, too: trees have followed the motion already.
    Settings settings = job.settings;
    settings.time += options.time_step * (frame - options.warmup);
    Result<FrameStats> stats = renderer.render(job.scene, job.camera, settings, picture, request);
    if (!stats) return stats.error();
    if (stats.value().ms.bvh_build > 0) measured.bvh_builds.push_back(stats.value().ms.bvh_build);
    if (frame >= options.warmup) measured.frames.push_back(std::move(stats.value()));
  }
  return measured;
}

// shown: the picture, or the view of it that was asked for.
Result<void> write_outputs(const Job& job, const RenderOptions& options, const Framebuffer& picture, const Image& shown,
                           const Ladder& ladder, const Measurement& measured) {
  const int width = picture.color.width, height = picture.color.height;
  if (!options.out.empty())
    if (auto done = write_png(options.out, shown, picture_text(job, options.view)); !done) return done;
  if (!options.radiance.empty())
    if (auto done = write_pfm(options.radiance, FloatImage{width, height, picture.radiance}); !done) return done;
  if (!options.depth.empty())
    if (auto done = write_pfm_gray(options.depth, width, height, picture.depth); !done) return done;
  if (!options.ladder.empty())
    if (auto done = ladder.write_json(options.ladder); !done) return done;
  if (options.stats.empty()) return {};
  const std::string stats = stats_json(job, measured, hash_image(shown)).dump(2) + "\n";
  if (options.stats != "-") return write_file_atomic(options.stats, stats);
  std::fputs(stats.c_str(), stdout);
  return {};
}

int render(const RenderOptions& options) {
  if (auto outputs = check_outputs(options); !outputs) return fail(outputs.error());
  Result<Job> job = options.frame.load_to_see();
  if (!job) return fail(job.error());
  for (const std::string& text : job.value().messages) message(text);
  // Radiance and ladder are of the whole frame, whatever the picture shows of it.
  if (options.radiance.empty() && options.ladder.empty())
    job.value().settings = settings_of_view(options.view, job.value().settings);
  Framebuffer picture;
  Ladder ladder;
  Result<Measurement> measured = measure(job.value(), options, picture, ladder);
  if (!measured) return fail(measured.error());
  for (const std::string& text : measured.value().frames.back().warnings) message("warning: " + text);
  const Image shown = view_picture(options.view, job.value().scene, job.value().camera, picture);
  job.value().settings.time += options.time_step * (options.frames - 1);  // of the picture
  if (auto written = write_outputs(job.value(), options, picture, shown, ladder, measured.value()); !written)
    return fail(written.error());
  if (options.hash) std::printf("%s\n", hash_text(hash_image(shown)).c_str());
  if (options.ids_hash) std::printf("%s\n", hash_text(hash_ids(picture)).c_str());
  return kDone;
}

}  // namespace

void add_render(CLI::App& app, Run& run) {
  CLI::App* command = app.add_subcommand("render", "Render a scene without a window");
  auto options = std::make_shared<RenderOptions>();
  options->frame.add_to(*command);
  command->add_option("--out", options->out, "The picture")->type_name("F.png");
  const auto view = [options](const std::string& word) {
    std::vector<std::string> known;
    for (const ViewWord& entry : view_words()) known.emplace_back(entry.name);
    const std::optional<View> found = view_from_text(word);
    if (!found)
      throw CLI::ValidationError("--view", "'" + word + "' is not one of " + view_choices() + did_you_mean(word, known));
    options->view = *found;
  };
  command->add_option_function<std::string>("--view", view, "What the picture shows")->type_name(view_choices());
  command->add_option("--frames", options->frames, "Frames to render and measure")->check(CLI::Range(1, kMaxFrames))->type_name("N");
  command->add_option("--warmup", options->warmup, "Frames before them, not measured")->check(CLI::Range(0, kMaxFrames))->type_name("N");
  command->add_option("--time-step", options->time_step, "Seconds from one frame to the next; the picture is the last one")
      ->check(CLI::Range(-kMostSeconds, kMostSeconds))->type_name("S");
  command->add_option("--stats", options->stats, "Times, counts, plan; - for standard output")->type_name("F.json");
  command->add_flag("--hash", options->hash, "Print the hash of the picture's pixels");
  command->add_flag("--ids-hash", options->ids_hash, "Print the hash of the primitive that each pixel sees");
  command->add_option("--ladder", options->ladder, "Hashes of every stage, tile and pixel, for `compare`")->type_name("F.json");
  command->add_option("--radiance", options->radiance, "Linear RGB")->type_name("F.pfm");
  command->add_option("--depth", options->depth, "Reversed depth, near / view depth, 0 = background")->type_name("F.pfm");
  command->callback([options, &run] { run = [options] { return render(*options); }; });
}

}  // namespace spanray::demo
