// A thread that loads, so that the window can show how far it is, and be closed.
#pragma once
#include <functional>
#include <future>
#include <mutex>
#include <string>
#include <thread>

#include "spanray/scene.h"

namespace spanray::demo {

template <class T> class SceneLoading {
 public:
  struct State {
    std::string stage = "opening";
    double fraction = 0;
  };

  // load: runs in a thread of its own, given what to report to.
  explicit SceneLoading(std::function<T(const LoadProgress&)> load) {
    std::packaged_task<T()> task([this, load = std::move(load)] {
      return load([this](const char* stage, double fraction) { return report(stage, fraction); });
    });
    future_ = task.get_future();
    thread_ = std::thread(std::move(task));
  }
  ~SceneLoading() {
    stop();
    thread_.join();
  }
  SceneLoading(const SceneLoading&) = delete;
  SceneLoading& operator=(const SceneLoading&) = delete;

  bool done(int wait_ms) { return future_.wait_for(std::chrono::milliseconds(wait_ms)) == std::future_status::ready; }
  // Once, when done. What `load` threw is thrown here.
  T take() { return future_.get(); }
  State state() {
    const std::lock_guard lock(mutex_);
    return state_;
  }
  // Loading ends early, with an error.
  void stop() {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }

 private:
  bool report(const char* stage, double fraction) {
    const std::lock_guard lock(mutex_);
    state_.stage = stage, state_.fraction = fraction;
    return !stop_;
  }

  std::mutex mutex_;
  State state_;        // guarded
  bool stop_ = false;  // guarded
  std::future<T> future_;
  std::thread thread_;
};

}  // namespace spanray::demo
