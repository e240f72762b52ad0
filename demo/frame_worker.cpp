#include "frame_worker.h"

#include <exception>

namespace spanray::demo {

FrameWorker::FrameWorker(Scene scene) : scene_(std::move(scene)), thread_([this] { run(); }) {}

FrameWorker::~FrameWorker() {
  {
    const std::lock_guard lock(mutex_);
    leave_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

void FrameWorker::order(const FrameOrder& order) {
  ordered_ = true;
  {
    const std::lock_guard lock(mutex_);
    done_.order = order;
    work_ = true, ready_ = false;
  }
  wake_.notify_one();
}

Result<bool> FrameWorker::take(ShownFrame& shown, int wait_ms) {
  if (!ordered_) return false;
  std::unique_lock lock(mutex_);
  if (!finished_.wait_for(lock, std::chrono::milliseconds(wait_ms), [this] { return ready_; })) return false;
  ordered_ = ready_ = false;
  if (error_) return *error_;
  std::swap(shown, done_);
  return true;
}

void FrameWorker::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    wake_.wait(lock, [this] { return work_ || leave_; });
    if (leave_) return;
    lock.unlock();
    const Result<void> made = make();
    lock.lock();
    error_ = made ? std::nullopt : std::optional<Error>(made.error());
    work_ = false, ready_ = true;
    finished_.notify_one();
  }
}

Result<void> FrameWorker::make() {
  try {
    const Settings settings = settings_of_view(done_.order.view, done_.order.settings);
    FrameRequest request;
    add_request(done_.order.view, request);
    Result<FrameStats> stats = renderer_.render(scene_, done_.order.camera, settings, buffers_, request);
    if (!stats) return stats.error();
    done_.stats = std::move(stats.value());
    if (done_.order.view == View::kColor)
      std::swap(done_.picture, buffers_.color);
    else
      done_.picture = view_picture(done_.order.view, scene_, done_.order.camera, buffers_);
    return {};
  } catch (const std::exception& error) {
    return Error{std::string("a frame could not be made: ") + error.what()};
  }
}

}  // namespace spanray::demo
