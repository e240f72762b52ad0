// oneTBB, or std::thread where SPANRAY_STD_THREADS is set (Debian's TBB is not built for the thread sanitizer).
#include "core/parallel.h"

#include <sched.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>

#include "core/fp_env.h"

#if defined(SPANRAY_STD_THREADS)
#include <thread>
#include <vector>
#else
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/task_arena.h>
#include <oneapi/tbb/task_group.h>
#endif

namespace spanray {
namespace {

int processors() {
  cpu_set_t set;
  if (sched_getaffinity(0, sizeof set, &set) == 0) return std::max(1, CPU_COUNT(&set));
  return 1;
}

// One loop: workers take indices from a counter. The first exception stops the rest and is kept.
struct Loop {
  std::atomic<size_t> next{0};
  size_t count;
  const std::function<void(size_t, int)>& body;
  std::mutex mutex;
  std::exception_ptr error;

  void work(int worker) {
    const FpEnvGuard guard;
    try {
      for (size_t i; (i = next.fetch_add(1, std::memory_order_relaxed)) < count;) body(i, worker);
    } catch (...) {
      next.store(count, std::memory_order_relaxed);
      const std::lock_guard lock(mutex);
      if (!error) error = std::current_exception();
    }
  }
};

}  // namespace

#if defined(SPANRAY_STD_THREADS)
struct Parallel::Impl {
  int threads;
  explicit Impl(int n) : threads(n) {}
  void run(Loop& loop, int workers) {
    std::vector<std::thread> others;
    for (int w = 1; w < workers; ++w) others.emplace_back([&loop, w] { loop.work(w); });
    loop.work(0);
    for (std::thread& t : others) t.join();
  }
};
#else
// Without it an arena of 7 gets only as many workers as there are processors. One for the whole process, made once: of several
// controls the least one would hold, so that pools of different sizes would starve each other. Never destroyed, since the
// library may be gone before static objects are. It allows threads and makes none.
static const tbb::global_control* volatile process_limit = nullptr;  // volatile: seen as reachable by leak checkers
static void allow_more_threads_than_processors() {
  static std::once_flag once;
  std::call_once(once, [] {
    process_limit =
        new tbb::global_control(tbb::global_control::max_allowed_parallelism, static_cast<size_t>(std::max(1024, processors())));
  });
}

struct Parallel::Impl {
  int threads;
  tbb::task_arena arena;
  explicit Impl(int n) : threads(n), arena(n) { allow_more_threads_than_processors(); }
  void run(Loop& loop, int workers) {
    arena.execute([&] {
      tbb::task_group group;
      for (int w = 1; w < workers; ++w) group.run([&loop, w] { loop.work(w); });
      loop.work(0);
      group.wait();
    });
  }
};
#endif

Parallel::Parallel(int threads) : impl_(std::make_unique<Impl>(threads > 0 ? threads : processors())) {}
Parallel::~Parallel() = default;
int Parallel::available() { return processors(); }
int Parallel::threads() const { return impl_->threads; }

void Parallel::for_each(size_t count, const std::function<void(size_t, int)>& body) {
  if (count == 0) return;
  Loop loop{{0}, count, body, {}, {}};
  const int workers = static_cast<int>(std::min<size_t>(count, static_cast<size_t>(impl_->threads)));
  if (workers == 1)
    loop.work(0);
  else
    impl_->run(loop, workers);
  if (loop.error) std::rethrow_exception(loop.error);
}

}  // namespace spanray
