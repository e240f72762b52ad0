#include "tune_views.h"

#include <algorithm>
#include <limits>

#include "camera_path.h"
#include "scene/scene_data.h"
#include "spanray/render.h"
#include "stage_times.h"

namespace spanray::demo {
namespace {

constexpr int kFramesInTurn = 5;

}  // namespace

std::vector<TunedView> find_views(const Job& job, int count, bool path_wanted) {
  std::vector<TunedView> views;
  const std::vector<CameraKey>& path = job.scene.data().camera_path;
  if (path.empty() || !path_wanted) return {{job.camera, {}}};
  for (int i = 0; i < count; ++i) views.push_back({camera_at(path, time_of_frame(path, i, count)), {}});
  return views;
}

Result<void> make_truths(const Job& job, const Settings& exact, int grid, std::vector<TunedView>& views,
                         const TruthProgress& progress) {
  for (size_t i = 0; i < views.size(); ++i) {
    Result<Truth> truth = make_truth(job, views[i].camera, exact, grid, [&](double f) {
      if (progress) progress((static_cast<double>(i) + f) / static_cast<double>(views.size()));
    });
    if (!truth) return truth.error();
    views[i].truth = std::move(truth.value());
  }
  return {};
}

double truth_error(const std::vector<TunedView>& views, const MetricWord& metric) {
  double worst = -std::numeric_limits<double>::infinity();
  for (const TunedView& view : views) worst = std::max(worst, as_error(metric, view.truth.error.*metric.value));
  return worst;
}

Result<Cost> measure_settings(const Job& job, const std::vector<TunedView>& views, const Settings& settings,
                              const MetricWord& metric, int frames) {
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
    const Result<Metrics> error = measure_pictures(view.truth.picture, picture.color, parallel);
    if (!error) return error.error();
    worst.ms = std::max(worst.ms, median(ms));
    worst.error = std::max(worst.error, as_error(metric, error.value().*metric.value));
  }
  return worst;
}

Result<std::vector<Timed>> time_in_turns(const Job& job, const std::vector<TunedView>& views,
                                         const std::vector<Settings>& settings, int frames, const TruthProgress& progress) {
  std::vector<Timed> worst(settings.size());
  Renderer renderer;
  Framebuffer picture;
  for (size_t v = 0; v < views.size(); ++v) {
    std::vector<std::vector<double>> ms(settings.size());
    for (int measured = 0; measured < frames; measured += kFramesInTurn) {
      for (size_t i = 0; i < settings.size(); ++i)
        for (int k = -1; k < std::min(kFramesInTurn, frames - measured); ++k) {
          const Result<FrameStats> stats = renderer.render(job.scene, views[v].camera, settings[i], picture);
          if (!stats) return stats.error();
          if (k >= 0) ms[i].push_back(stats.value().ms.frame);
        }
      if (progress)
        progress((static_cast<double>(v) + std::min(1.0, static_cast<double>(measured + kFramesInTurn) / frames)) /
                 static_cast<double>(views.size()));
    }
    for (size_t i = 0; i < settings.size(); ++i)
      if (const double middle = median(ms[i]); middle > worst[i].median_ms) worst[i] = {middle, percentile_95(ms[i])};
  }
  return worst;
}

}  // namespace spanray::demo
