#include "command.h"

#include <cstdio>

#include "simd/isa.h"
#include "spanray/stats.h"

namespace spanray::demo {

void message(const std::string& text) { std::fprintf(stderr, "spanray: %s\n", text.c_str()); }

int fail(const std::string& text) {
  message("error: " + text);
  return kCouldNot;
}

int fail(const Error& error) { return fail(error.to_string()); }

std::string compiler_name() {
#if defined(__clang__)
  return std::string("Clang ") + std::to_string(__clang_major__) + "." + std::to_string(__clang_minor__) + "." +
         std::to_string(__clang_patchlevel__);
#elif defined(__GNUC__)
  return std::string("GCC ") + std::to_string(__GNUC__) + "." + std::to_string(__GNUC_MINOR__) + "." +
         std::to_string(__GNUC_PATCHLEVEL__);
#else
  return "unknown";
#endif
}

std::string version_text() {
  std::string text = "spanray " SPANRAY_VERSION "\nnumeric_contract " + std::to_string(kNumericContract) + "\ncompiler " +
                     compiler_name() + "\ninstruction_sets";
  for (const Isa isa : {Isa::kScalar, Isa::kSse4, Isa::kAvx2, Isa::kAvx512})
    if (isa_supported(isa)) text += " " + std::string(isa_name(isa));
  return text;
}

}  // namespace spanray::demo
