#include "text_chunks.h"

#include <cstdint>
#include <cstring>
#include <fstream>

namespace spanray::demo {

// Source: PNG specification, third edition, 5.3 (chunk layout) and 11.3.3.3 (tEXt).
std::map<std::string, std::string> read_png_text(const std::string& path) {
  static constexpr unsigned char kSignature[8] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  constexpr uint32_t kMaxText = 1 << 20;
  std::map<std::string, std::string> text;
  std::ifstream file(path, std::ios::binary);
  unsigned char head[8];
  if (!file.read(reinterpret_cast<char*>(head), 8) || std::memcmp(head, kSignature, 8) != 0) return text;
  while (file.read(reinterpret_cast<char*>(head), 8)) {
    const uint32_t length = uint32_t{head[0]} << 24 | uint32_t{head[1]} << 16 | uint32_t{head[2]} << 8 | uint32_t{head[3]};
    if (std::memcmp(head + 4, "tEXt", 4) != 0 || length > kMaxText) {
      file.seekg(static_cast<std::streamoff>(length) + 4, std::ios::cur);
      continue;
    }
    std::string chunk(length, '\0');
    if (!file.read(chunk.data(), length)) break;
    const size_t zero = chunk.find('\0');
    if (zero != std::string::npos) text[chunk.substr(0, zero)] = chunk.substr(zero + 1);
    file.seekg(4, std::ios::cur);  // checksum
  }
  return text;
}

}  // namespace spanray::demo
