#include "truth.h"

#include "reference/reference.h"
#include "render/check_request.h"

namespace spanray::demo {

Result<Framebuffer> render_truth(const Job& job, const Camera& camera, const Settings& settings, int grid,
                                 const TruthProgress& progress) {
  if (auto possible = check_request(job.scene, camera, settings); !possible) return possible.error();
  ReferenceOptions options;
  options.threads = job.settings.threads, options.grid = grid;
  options.progress = progress;
  Framebuffer out;
  if (Result<void> done = render_reference(job.scene, camera, settings, options, out); !done) return done.error();
  return out;
}

int second_grid(int grid) { return grid < 64 ? grid + 1 : grid - 1; }

Result<Truth> make_truth(const Job& job, const Camera& camera, const Settings& settings, int grid,
                         const TruthProgress& progress) {
  const double first = grid * grid, second = second_grid(grid) * second_grid(grid), share = first / (first + second);
  const auto part = [&](double from, double to) {
    return [=, &progress](double f) {
      if (progress) progress(from + f * (to - from));
    };
  };
  Result<Framebuffer> truth = render_truth(job, camera, settings, grid, part(0, share));
  if (!truth) return truth.error();
  const Result<Framebuffer> other = render_truth(job, camera, settings, second_grid(grid), part(share, 1));
  if (!other) return other.error();
  Parallel parallel(job.settings.threads);
  const Result<Metrics> error = measure_pictures(other.value().color, truth.value().color, parallel);
  if (!error) return error.error();
  return Truth{std::move(truth.value().color), error.value()};
}

}  // namespace spanray::demo
