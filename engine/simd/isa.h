// The instruction sets that kernels are compiled for, and their choice at run time.
#pragma once
#include <string_view>

#include "spanray/settings.h"

namespace spanray {

inline constexpr int kIsaCount = 4;  // scalar, sse4, avx2, avx512: the concrete values of Isa, in this order

// True if this processor can run kernels of the concrete instruction set `isa`. O(1), thread-safe.
bool isa_supported(Isa isa);
// The widest supported instruction set for kAuto, else `requested` itself. Does not check support.
Isa resolve_isa(Isa requested);
std::string_view isa_name(Isa isa);
// Index of a concrete instruction set into tables of kIsaCount kernels.
inline int isa_index(Isa isa) { return static_cast<int>(isa) - 1; }

}  // namespace spanray
