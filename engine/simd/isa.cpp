#include "simd/isa.h"

namespace spanray {

// Whether this build has its kernels (simd/dispatch.h).
#if defined(SPANRAY_NO_SSE4)
static constexpr bool kHasSse4 = false;
#else
static constexpr bool kHasSse4 = true;
#endif
#if defined(SPANRAY_NO_AVX512)
static constexpr bool kHasAvx512 = false;
#else
static constexpr bool kHasAvx512 = true;
#endif

bool isa_supported(Isa isa) {
  switch (isa) {
    case Isa::kAuto:
    case Isa::kScalar: return true;
#if defined(__x86_64__)
    case Isa::kSse4: return kHasSse4 && __builtin_cpu_supports("sse4.2") && __builtin_cpu_supports("popcnt");
    case Isa::kAvx2:
      return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2");
    case Isa::kAvx512:
      return kHasAvx512 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
             __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
             __builtin_cpu_supports("avx512cd") && isa_supported(Isa::kAvx2);
#else
    default: return false;
#endif
  }
  return false;
}

Isa resolve_isa(Isa requested) {
  if (requested != Isa::kAuto) return requested;
  for (const Isa isa : {Isa::kAvx512, Isa::kAvx2, Isa::kSse4})
    if (isa_supported(isa)) return isa;
  return Isa::kScalar;
}

std::string_view isa_name(Isa isa) {
  switch (isa) {
    case Isa::kAuto: return "auto";
    case Isa::kScalar: return "scalar";
    case Isa::kSse4: return "sse4";
    case Isa::kAvx2: return "avx2";
    case Isa::kAvx512: return "avx512";
  }
  return "?";
}

}  // namespace spanray
