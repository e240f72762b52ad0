// Tasks on threads. parallel.cpp is the only file that knows the thread library (oneTBB, or std::thread under TSan).
#pragma once
#include <cstddef>
#include <functional>
#include <memory>

namespace spanray {

// A pool with exactly `threads` workers (the caller is one of them while it waits). Each task runs under the IEEE default
// floating-point environment (core/fp_env.h), whatever the caller's was; the caller's is restored.
class Parallel {
 public:
  // threads >= 1; 0 means one per processor that this process may use.
  explicit Parallel(int threads = 0);
  ~Parallel();
  Parallel(const Parallel&) = delete;
  Parallel& operator=(const Parallel&) = delete;

  int threads() const;
  // Processors that this process may use.
  static int available();
  // Calls body(index, worker) once for every index in [0, count), in no order, 0 <= worker < threads(); calls with the same
  // worker never overlap. Returns when all are done. An exception of a body is rethrown here.
  void for_each(size_t count, const std::function<void(size_t index, int worker)>& body);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace spanray
