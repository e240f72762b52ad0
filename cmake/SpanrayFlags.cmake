# The flags of the numerical contract (docs/decisions/0001-lanes.md), and our warnings: private to our own targets.
function(spanray_flags target)
  spanray_contract_flags(${target} -Wall -Wextra -Wshadow -Wpedantic -Wconversion -Wno-sign-conversion -Werror)
endfunction()

# The flags without our warnings: what spanray_add_formula() compiles in other people's projects. Further arguments: more options.
function(spanray_contract_flags target)
  target_compile_options(${target} PRIVATE -ffp-contract=off -fno-fast-math ${ARGN})
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # -Wpsabi speaks of AVX-512 arguments between targets; all such functions are inlined.
    # -Wrestrict is wrong about "text" + std::string in GCC 12 (GCC bug 105651).
    target_compile_options(${target} PRIVATE -Wno-psabi -Wno-restrict)
  else()
    target_compile_options(${target} PRIVATE -Wno-pass-failed)
  endif()
  # One 1-lane fallback on every compiler (Highway would choose by compiler), SSE4, AVX2 and AVX-512 in every build.
  target_compile_definitions(${target} PRIVATE HWY_COMPILE_ALL_ATTAINABLE HWY_BROKEN_EMU128=1 HWY_BASELINE_TARGETS=HWY_SCALAR)
  if(SPANRAY_SANITIZE)
    # simd/dispatch.h
    if(SPANRAY_SANITIZE_AVX512)
      target_compile_definitions(${target} PRIVATE SPANRAY_NO_SSE4 "HWY_DISABLED_TARGETS=(HWY_SSSE3|HWY_SSE4|HWY_AVX3_DL)")
    else()
      target_compile_definitions(${target} PRIVATE SPANRAY_NO_SSE4 SPANRAY_NO_AVX512
        "HWY_DISABLED_TARGETS=(HWY_SSSE3|HWY_SSE4|HWY_AVX3|HWY_AVX3_DL)")
    endif()
  else()
    target_compile_definitions(${target} PRIVATE "HWY_DISABLED_TARGETS=(HWY_SSSE3|HWY_AVX3_DL)")
  endif()
  if(SPANRAY_SANITIZE)
    target_compile_options(${target} PRIVATE -fsanitize=${SPANRAY_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
    target_link_options(${target} PRIVATE -fsanitize=${SPANRAY_SANITIZE})
  endif()
endfunction()
