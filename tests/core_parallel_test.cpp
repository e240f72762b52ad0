#include <gtest/gtest.h>

#include <xmmintrin.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <limits>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

#include "core/parallel.h"

namespace spanray {
namespace {

constexpr unsigned kIeeeDefault = 0x1f80;                           // all exceptions masked
constexpr unsigned kPoison = 0x1f80u | 0x8000u | 0x0040u | 0x4000u;  // flush to zero, denormals are zero, round up

// Holds whoever arrives until `expected` have come; false where they do not within ten seconds.
class Meeting {
 public:
  explicit Meeting(int expected) : expected_(expected) {}
  bool arrive() {
    std::unique_lock lock(mutex_);
    ++arrived_;
    changed_.notify_all();
    return changed_.wait_for(lock, std::chrono::seconds(10), [this] { return arrived_ >= expected_; });
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  int arrived_ = 0;
  const int expected_;
};

// Every body waits for all others: that ends only if so many threads truly work at once, whatever the number of processors.
TEST(Parallel, SevenThreadsAreSevenDistinctThreads) {
  for (const int threads : {1, 2, 7}) {
    Parallel parallel(threads);
    ASSERT_EQ(parallel.threads(), threads);
    for (int round = 0; round < 3; ++round) {
      Meeting meeting(threads);
      std::mutex mutex;
      std::set<std::thread::id> ids;
      std::set<int> workers;
      std::atomic<int> missed{0};
      parallel.for_each(static_cast<size_t>(threads), [&](size_t, int worker) {
        if (!meeting.arrive()) ++missed;
        const std::lock_guard lock(mutex);
        ids.insert(std::this_thread::get_id());
        workers.insert(worker);
      });
      EXPECT_EQ(missed, 0);
      EXPECT_EQ(ids.size(), static_cast<size_t>(threads));
      EXPECT_EQ(workers.size(), static_cast<size_t>(threads));
      EXPECT_EQ(*workers.begin(), 0);
      EXPECT_EQ(*workers.rbegin(), threads - 1);
      EXPECT_EQ(ids.count(std::this_thread::get_id()), 1u) << "the caller is one of them";
    }
  }
}

TEST(Parallel, ADefaultPoolHasAThreadAProcessor) {
  EXPECT_GE(Parallel().threads(), 1);
  EXPECT_GE(Parallel(-3).threads(), 1);
}

TEST(Parallel, EveryIndexOnceAndWorkersNeverOverlap) {
  for (const int threads : {1, 2, 7}) {
    Parallel parallel(threads);
    for (const size_t count : {size_t{0}, size_t{1}, size_t{2}, size_t{6}, size_t{7}, size_t{8}, size_t{1000}}) {
      std::vector<std::atomic<int>> calls(count);
      std::vector<std::atomic<int>> busy(static_cast<size_t>(threads));
      std::atomic<int> overlaps{0}, bad_workers{0};
      parallel.for_each(count, [&](size_t index, int worker) {
        if (worker < 0 || worker >= threads) {
          ++bad_workers;
          return;
        }
        if (busy[static_cast<size_t>(worker)].fetch_add(1) != 0) ++overlaps;
        ++calls[index];
        std::this_thread::yield();
        busy[static_cast<size_t>(worker)].fetch_sub(1);
      });
      EXPECT_EQ(bad_workers, 0);
      EXPECT_EQ(overlaps, 0);
      for (size_t i = 0; i < count; ++i) ASSERT_EQ(calls[i], 1) << i;
    }
  }
}

TEST(Parallel, AnExceptionArrivesAndThePoolStaysUsable) {
  for (const int threads : {1, 2, 7}) {
    Parallel parallel(threads);
    for (int round = 0; round < 20; ++round) {
      std::atomic<int> calls{0};
      try {
        parallel.for_each(100, [&](size_t index, int) {
          ++calls;
          if (index == 5) throw std::runtime_error("five");
        });
        ADD_FAILURE() << "nothing arrived";
      } catch (const std::runtime_error& error) {
        EXPECT_STREQ(error.what(), "five");
      }
      EXPECT_GE(calls, 1);
      std::atomic<int> later{0};
      parallel.for_each(50, [&](size_t, int) { ++later; });
      EXPECT_EQ(later, 50);
    }
    // All bodies throw at once: one of them arrives.
    EXPECT_THROW(parallel.for_each(100, [](size_t, int) { throw 1; }), int);
  }
}

TEST(Parallel, APoisonedControlRegisterReachesNoBodyAndIsRestored) {
  for (const int threads : {1, 2, 7}) {
    Parallel parallel(threads);
    const unsigned saved = _mm_getcsr();
    _mm_setcsr(kPoison);
    Meeting meeting(threads);
    std::atomic<int> poisoned{0}, wrong{0};
    parallel.for_each(static_cast<size_t>(threads), [&](size_t, int) {
      meeting.arrive();  // so that every thread has a body
      // Exception flags (the low six bits) are history, not control.
      if ((_mm_getcsr() & ~0x3fu) != kIeeeDefault) ++poisoned;
      volatile float tiny = std::numeric_limits<float>::denorm_min(), one = 1.0f, ulp = 0x1p-25f;
      if (!(tiny * 0.5f == 0.0f) || !(tiny + tiny > tiny) || one + ulp != 1.0f) ++wrong;
      _mm_setcsr(kPoison);  // a body that leaves dirt behind must not hurt the next one's thread
    });
    const unsigned after = _mm_getcsr();
    std::atomic<int> still_poisoned{0};
    parallel.for_each(20, [&](size_t, int) { still_poisoned += (_mm_getcsr() & ~0x3fu) != kIeeeDefault; });
    _mm_setcsr(saved);
    EXPECT_EQ(poisoned, 0);
    EXPECT_EQ(wrong, 0);
    EXPECT_EQ(still_poisoned, 0);
    EXPECT_EQ(after & ~0x3fu, kPoison & ~0x3fu) << "the caller's state must come back";
  }
}

TEST(Parallel, TheControlRegisterIsRestoredAfterAnException) {
  Parallel parallel(2);
  const unsigned saved = _mm_getcsr();
  _mm_setcsr(kPoison);
  bool arrived = false;
  try {
    parallel.for_each(4, [](size_t, int) { throw 1; });
  } catch (int) {
    arrived = true;
  }
  const unsigned after = _mm_getcsr();
  _mm_setcsr(saved);
  EXPECT_TRUE(arrived);
  EXPECT_EQ(after & ~0x3fu, kPoison & ~0x3fu);
}

TEST(Parallel, PoolsOfDifferentSizesLiveSideBySide) {
  Parallel seven(7), two(2);
  Meeting meeting(7);
  std::atomic<int> missed{0};
  two.for_each(2, [](size_t, int) {});
  seven.for_each(7, [&](size_t, int) { missed += !meeting.arrive(); });
  EXPECT_EQ(missed, 0);
}

}  // namespace
}  // namespace spanray
