// The floating-point control register: round to nearest even, no flush to zero, no denormals-are-zero, no traps.
#pragma once
#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

namespace spanray {

// Sets the IEEE default for a scope and restores what was there: a host linked with -ffast-math must not change a pixel.
class FpEnvGuard {
 public:
#if defined(__x86_64__)
  FpEnvGuard() : saved_(_mm_getcsr()) { _mm_setcsr(0x1f80u); }
  ~FpEnvGuard() { _mm_setcsr(saved_); }

 private:
  unsigned saved_;
#endif
 public:
  FpEnvGuard(const FpEnvGuard&) = delete;
  FpEnvGuard& operator=(const FpEnvGuard&) = delete;
#if !defined(__x86_64__)
  FpEnvGuard() = default;
#endif
};

}  // namespace spanray
