// A thread that renders, so that the window hears its user while a frame takes long.
#pragma once
#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>

#include "spanray/render.h"
#include "view.h"

namespace spanray::demo {

struct FrameOrder {
  Camera camera;
  Settings settings;
  View view = View::kColor;
};

struct ShownFrame {
  FrameOrder order;
  Image picture;
  FrameStats stats;
};

// One frame at a time. Scene data is read only; everything else passes through the lock.
class FrameWorker {
 public:
  explicit FrameWorker(Scene scene);
  ~FrameWorker();  // waits for the frame that is being made
  FrameWorker(const FrameWorker&) = delete;
  FrameWorker& operator=(const FrameWorker&) = delete;

  // Whether a frame was ordered and has not been taken. Only the thread that orders may ask.
  bool busy() const { return ordered_; }
  void order(const FrameOrder& order);  // not while busy()
  // Waits up to wait_ms for the frame and exchanges `shown` with it (its memory is used again); false if it is not there yet.
  // Errors: of the renderer; there is no frame then.
  Result<bool> take(ShownFrame& shown, int wait_ms);

 private:
  void run();
  Result<void> make();  // done_ from done_.order

  Scene scene_;
  bool ordered_ = false;  // of the thread that orders
  std::mutex mutex_;
  std::condition_variable wake_, finished_;
  bool work_ = false, ready_ = false, leave_ = false;  // guarded by mutex_
  // Of the worker while work_, of the thread that orders otherwise.
  ShownFrame done_;
  std::optional<Error> error_;
  // Of the worker alone.
  Renderer renderer_;
  Framebuffer buffers_;
  std::thread thread_;
};

}  // namespace spanray::demo
