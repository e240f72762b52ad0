#include "trade.h"

#include <algorithm>
#include <chrono>
#include <memory>

#include "truth.h"

namespace spanray::demo {
namespace {

constexpr int kFramesInTurn = 5;  // measured ones, after one that warms the caches

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::vector<double> times(const std::vector<FrameStats>& frames, double StageTimes::*stage) {
  std::vector<double> list;
  for (const FrameStats& frame : frames) list.push_back(frame.ms.*stage);
  return list;
}

class Progress {
 public:
  Progress(const TradeOptions& options, const char* what) : options_(options), what_(what) {}
  void operator()(double fraction) const {
    if (options_.progress) options_.progress(what_, fraction);
  }

 private:
  const TradeOptions& options_;
  const char* const what_;
};

Result<void> measure_times(const Job& job, const TradeOptions& options, std::vector<Measured>& list) {
  const Progress progress(options, "measuring");
  Renderer renderer;  // one for all: trees of large scenes are large; what a setting changes is made in the frame that is not measured
  Framebuffer picture;
  const auto frames = [&](size_t i, int count, bool keep) -> Result<void> {
    for (int k = 0; k < count; ++k) {
      Result<FrameStats> stats = renderer.render(job.scene, job.camera, list[i].candidate.settings, picture);
      if (!stats) return stats.error();
      if (keep) list[i].frames.push_back(std::move(stats.value()));
    }
    return {};
  };
  for (size_t i = 0; i < list.size(); ++i)
    if (auto done = frames(i, options.warmup, false); !done) return done;
  for (int measured = 0; measured < options.frames; measured += kFramesInTurn)
    for (size_t i = 0; i < list.size(); ++i) {
      if (auto done = frames(i, 1, false); !done) return done;
      if (auto done = frames(i, std::min(kFramesInTurn, options.frames - measured), true); !done) return done;
      progress((measured + kFramesInTurn * static_cast<double>(i + 1) / static_cast<double>(list.size())) /
               ((options.frames + kFramesInTurn - 1) / kFramesInTurn * kFramesInTurn));
    }
  return {};
}

// center: the reference with one sample.
Result<void> measure_errors(const Job& job, const TradeOptions& options, const Image& truth, const Framebuffer& center,
                            std::vector<Measured>& list) {
  const Progress progress(options, "comparing");
  Parallel parallel(job.settings.threads);
  for (size_t i = 0; i < list.size(); ++i) {
    Measured& m = list[i];
    Renderer renderer;  // of its own: it builds what this setting needs, and no more
    Framebuffer picture;
    FrameRequest request;
    request.primitive = true;
    const Result<FrameStats> stats = renderer.render(job.scene, job.camera, m.candidate.settings, picture, request);
    if (!stats) return stats.error();
    m.bvh_build_ms = stats.value().ms.bvh_build;
    m.picture = std::move(picture.color);
    Result<Metrics> error = measure_pictures(truth, m.picture, parallel, &m.maps);
    if (!error) return error.error();
    m.error = error.value();
    if (m.candidate.settings.samples == 1) {
      Result<Metrics> alone = measure_pictures(center.color, m.picture, parallel);
      if (!alone) return alone.error();
      m.error_alone = alone.value();
      uint64_t wrong = 0;
      for (size_t k = 0; k < center.primitive.size(); ++k) wrong += center.primitive[k] != picture.primitive[k];
      m.wrong_ids = wrong;
    }
    progress(static_cast<double>(i + 1) / static_cast<double>(list.size()));
  }
  return {};
}

}  // namespace

double Measured::median_ms(double StageTimes::*stage) const { return median(times(frames, stage)); }
double Measured::p95_ms(double StageTimes::*stage) const { return percentile_95(times(frames, stage)); }
MedianInterval Measured::interval_ms() const { return median_interval(times(frames, &StageTimes::frame)); }

Result<Trade> measure_trade(const Job& job, const std::vector<Knob>& knobs, const std::vector<Candidate>& candidates,
                            const TradeOptions& options) {
  Trade trade;
  const auto start = std::chrono::steady_clock::now();
  const Settings exact = exact_settings(knobs, job.settings), plain = plain_settings(knobs, job.settings);
  Result<Truth> truth = make_truth(job, job.camera, exact, options.grid, Progress(options, "ground truth"));
  if (!truth) return truth.error();
  Result<Framebuffer> center = render_truth(job, job.camera, plain, 0, Progress(options, "ground truth at centers"));
  if (!center) return center.error();
  trade.truth_seconds = seconds_since(start);
  trade.truth = std::move(truth.value().picture), trade.truth_error = truth.value().error;
  for (const Candidate& candidate : candidates) trade.settings.emplace_back().candidate = candidate;
  if (auto done = measure_errors(job, options, trade.truth, center.value(), trade.settings); !done) return done.error();
  trade.truth_center = std::move(center.value().color);
  if (auto done = measure_times(job, options, trade.settings); !done) return done.error();
  return trade;
}

}  // namespace spanray::demo
