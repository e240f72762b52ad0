// spanray reference: the picture that the model asks for, or nature, slowly.
#include <cstdio>
#include <filesystem>
#include <memory>

#include <CLI/CLI.hpp>

#include "command.h"
#include "core/atomic_file.h"
#include "core/counted.h"
#include "frame_options.h"
#include "image/mask.h"
#include "image/pfm.h"
#include "path_command.h"
#include "picture.h"
#include "progress_line.h"
#include "reference/ambiguity.h"
#include "render/check_request.h"
#include "scene/scene_data.h"

namespace spanray::demo {
namespace {

struct ReferenceCommand {
  FrameOptions frame;
  std::string out;
  int grid = 0;
  PathCommand paths;
  std::string mask;
  AmbiguityBounds bounds;
};

void check_usage(const ReferenceCommand& command, const std::string& extension) {
  if (extension != ".png" && extension != ".pfm")
    throw UsageError("reference: --out writes PNG or PFM, so its file must end in .png or .pfm: " + command.out);
  const auto place = [](const std::string& file) {
    std::error_code none;
    return std::filesystem::weakly_canonical(std::filesystem::absolute(file, none), none);
  };
  if (!command.paths.accumulate.empty() && place(command.paths.accumulate) == place(command.out))
    throw UsageError("reference: --out and --accumulate are the same file: " + command.out);
  if (command.mask.empty()) return;
  if (std::filesystem::path(command.mask).extension() != ".pfm")
    throw UsageError("reference: --mask writes PFM, so its file must end in .pfm: " + command.mask);
  if (place(command.mask) == place(command.out))
    throw UsageError("reference: --out and --mask are the same file: " + command.out);
}

Result<PathPicture> render_model(const ReferenceCommand& command, const Job& job) {
  PathPicture made;
  ReferenceOptions options;
  options.threads = job.settings.threads, options.grid = command.grid;
  ProgressLine progress("reference");
  options.progress = [&](double fraction) { progress.show(fraction); };
  const Result<void> rendered = render_reference(job.scene, job.camera, job.settings, options, made.picture);
  progress.clear();
  if (!rendered) return rendered.error();
  made.text = command.grid > 0 ? "grid " + std::to_string(command.grid) : "samples of the settings";
  return made;
}

Result<void> render_mask(const ReferenceCommand& command, const Job& job) {
  ReferenceOptions options;
  options.threads = job.settings.threads, options.grid = command.grid;
  ProgressLine progress("ambiguity mask");
  options.progress = [&](double fraction) { progress.show(fraction); };
  AmbiguityMask mask;
  const Result<void> made = make_ambiguity_mask(job.scene, job.camera, job.settings, options, command.bounds, mask);
  progress.clear();
  if (!made) return made.error();
  if (auto written = write_mask(command.mask, mask); !written) return written.error();
  std::printf("ambiguous  %.4f %% of the pixels are left open by more than 8 of 255\n", 100 * share_wider(mask, 8));
  std::printf("open       %s mirrors that show too much to be enumerated\n",
              counted(mask.open, "pixel has", "pixels have").c_str());
  return {};
}

int reference(const ReferenceCommand& command) {
  const std::string extension = std::filesystem::path(command.out).extension().string();
  check_usage(command, extension);
  for (const std::string& file : {command.out, command.mask})
    if (auto writable = file.empty() ? Result<void>() : check_writable(file); !writable) return fail(writable.error());
  Result<Job> loaded = command.frame.load_to_see();
  if (!loaded) return fail(loaded.error());
  const Job& job = loaded.value();
  for (const std::string& text : job.messages) message(text);
  if (auto possible = check_request(job.scene, job.camera, job.settings); !possible) return fail(possible.error());
  if (!command.mask.empty() && job.scene.data().has_exact())
    return fail("reference: --mask: the scene has spheres or planes, which the ambiguity mask does not model");
  Result<PathPicture> rendered = command.paths.paths > 0 ? command.paths.render(job) : render_model(command, job);
  if (!rendered) return fail(rendered.error());
  PathPicture& made = rendered.value();
  Framebuffer& picture = made.picture;
  auto text = picture_text(job);
  text.emplace_back("reference", made.text);
  const auto written = extension == ".png"
                           ? write_png(command.out, picture.color, text)
                           : write_pfm(command.out, FloatImage{picture.color.width, picture.color.height, std::move(picture.radiance)});
  if (!made.saved) fail(made.saved.error());
  if (!written) return fail(written.error());
  if (!command.mask.empty())
    if (auto masked = render_mask(command, job); !masked) return fail(masked.error());
  return made.saved && !made.stopped ? kDone : kCouldNot;
}

}  // namespace

void add_reference(CLI::App& app, Run& run) {
  CLI::App* command = app.add_subcommand(
      "reference", "Render the ground truth, slowly: the same model in double, without approximations, or with --paths the rendering equation");
  auto options = std::make_shared<ReferenceCommand>();
  options->frame.add_to(*command);
  command->add_option("--out", options->out, "The picture, or its linear radiance")->required()->type_name("F.png|F.pfm");
  CLI::Option* grid = command->add_option("--grid", options->grid, "N x N samples a pixel, instead of --samples")
                          ->check(CLI::Range(1, 64))
                          ->type_name("N");
  CLI::Option* mask =
      command
          ->add_option("--mask", options->mask,
                       "Write the ambiguity mask, too: the least and the greatest color of each pixel that errors within "
                       "published bounds allow, for compare --mask")
          ->type_name("M.pfm");
  command
      ->add_flag("--mask-any-footprint", options->bounds.any_opengl_footprint,
                 "The mask allows for every level of detail that OpenGL does, instead of the model's alone")
      ->needs(mask);
  command
      ->add_option("--mask-codes", options->bounds.codes,
                   "What the mask allows for shading in float and the step to bytes, in codes of 255; default 1")
      ->needs(mask)
      ->check(CLI::Range(0.0, 255.0))
      ->type_name("N");
  options->paths.add_to(*command)->excludes(grid)->excludes(mask);
  command->callback([options, &run] { run = [options] { return reference(*options); }; });
}

}  // namespace spanray::demo
