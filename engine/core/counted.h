// Counts in sentences.
#pragma once
#include <cstdint>
#include <string>

namespace spanray {

// "1 triangle has", "2 triangles have".
inline std::string counted(uint64_t n, const char* one, const char* many) {
  return std::to_string(n) + " " + (n == 1 ? one : many);
}

}  // namespace spanray
