#include "simd/isa.h"

namespace spanray {

bool isa_supported(Isa isa) {
  switch (isa) {
    case Isa::kAuto:
    case Isa::kScalar: return true;
#if defined(SPANRAY_FEW_ISAS)
    case Isa::kSse4:
    case Isa::kAvx512: return false;  // no kernels in this build (simd/dispatch.h)
    case Isa::kAvx2: return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#elif defined(__x86_64__)
    case Isa::kSse4: return __builtin_cpu_supports("sse4.2") && __builtin_cpu_supports("popcnt");
    case Isa::kAvx2:
      return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2");
    case Isa::kAvx512:
      return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
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
