// How a kernel is compiled once per instruction set and found at run time. Every *_kernel.cpp looks like this:
//
//   #include <std and GLM and project headers>            // first: else their inlines become AVX-512 for everybody
//   #undef HWY_TARGET_INCLUDE
//   #define HWY_TARGET_INCLUDE "stage/name_kernel.cpp"    // this very file, from the include root
//   #include "hwy/foreach_target.h"
//   #include "simd/lanes-inl.h"
//   HWY_BEFORE_NAMESPACE();
//   namespace spanray { namespace HWY_NAMESPACE {
//   void name(...) { ... F32, I32, F64, Mask ... }        // lambdas need HWY_ATTR
//   } }
//   HWY_AFTER_NAMESPACE();
//   #if HWY_ONCE
//   namespace spanray { const NameFn kName[kIsaCount] = SPANRAY_KERNEL_TABLE(name); }
//   #endif
//
// and its header declares `using NameFn = void (*)(...); extern const NameFn kName[kIsaCount];`.
// The caller writes kName[isa_index(frame.isa)](...). Highway's own dispatch is global to the process, so it is not used.
#pragma once
#include "simd/isa.h"

// Sanitized builds have fewer instruction sets, in all targets alike: each one takes minutes to compile. None has SSE4, and
// AVX-512 only those of SPANRAY_SANITIZE_AVX512.
#if defined(SPANRAY_NO_AVX512)
#define SPANRAY_KERNEL_TABLE(f) {&N_SCALAR::f, nullptr, &N_AVX2::f, nullptr}
#elif defined(SPANRAY_NO_SSE4)
#define SPANRAY_KERNEL_TABLE(f) {&N_SCALAR::f, nullptr, &N_AVX2::f, &N_AVX3::f}
#else
#define SPANRAY_KERNEL_TABLE(f) {&N_SCALAR::f, &N_SSE4::f, &N_AVX2::f, &N_AVX3::f}
#endif
