// How long things take.
#pragma once
#include <chrono>

namespace spanray {

inline double seconds_now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

// Milliseconds that a call takes.
template <class F> double timed_ms(F&& call) {
  const double start = seconds_now();
  call();
  return (seconds_now() - start) * 1e3;
}

}  // namespace spanray
