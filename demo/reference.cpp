// spanray reference: the picture that the model asks for, slowly.
#include <filesystem>
#include <memory>

#include "command.h"
#include "core/atomic_file.h"
#include "frame_options.h"
#include "image/pfm.h"
#include "picture.h"
#include "progress_line.h"
#include "reference/reference.h"
#include "render/check_request.h"

namespace spanray::demo {
namespace {

struct ReferenceCommand {
  FrameOptions frame;
  std::string out;
  int grid = 0;
};

int reference(const ReferenceCommand& command) {
  const std::string extension = std::filesystem::path(command.out).extension().string();
  if (extension != ".png" && extension != ".pfm") throw UsageError("reference: --out writes PNG or PFM, so its file must end in .png or .pfm: " + command.out);
  if (auto writable = check_writable(command.out); !writable) return fail(writable.error());
  Result<Job> loaded = command.frame.load();
  if (!loaded) return fail(loaded.error());
  const Job& job = loaded.value();
  for (const std::string& text : job.messages) message(text);
  if (auto possible = check_request(job.scene, job.camera, job.settings); !possible) return fail(possible.error());
  Framebuffer picture;
  ReferenceOptions options;
  options.threads = job.settings.threads, options.grid = command.grid;
  ProgressLine progress("reference");
  options.progress = [&](double fraction) { progress.show(fraction); };
  const Result<void> rendered = render_reference(job.scene, job.camera, job.settings, options, picture);
  progress.clear();
  if (!rendered) return fail(rendered.error());
  auto text = picture_text(job);
  text.emplace_back("reference", command.grid > 0 ? "grid " + std::to_string(command.grid) : "samples of the settings");
  const auto written = extension == ".png"
                           ? write_png(command.out, picture.color, text)
                           : write_pfm(command.out, FloatImage{picture.color.width, picture.color.height, std::move(picture.radiance)});
  return written ? static_cast<int>(kDone) : fail(written.error());
}

}  // namespace

void add_reference(CLI::App& app, Run& run) {
  CLI::App* command = app.add_subcommand("reference", "Render the ground truth: the same model in double, without approximations, slowly");
  auto options = std::make_shared<ReferenceCommand>();
  options->frame.add_to(*command);
  command->add_option("--out", options->out, "The picture, or its linear radiance")->required()->type_name("F.png|F.pfm");
  command->add_option("--grid", options->grid, "N x N samples a pixel, instead of --samples")->check(CLI::Range(1, 64))->type_name("N");
  command->callback([options, &run] { run = [options] { return reference(*options); }; });
}

}  // namespace spanray::demo
