// A 64-bit non-cryptographic hash, the same on every machine (little endian): for pictures, scenes and the hash ladder.
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>

namespace spanray {

// Finaliser of MurmurHash3 (Appleby): each input bit changes each output bit with probability near 1/2.
inline uint64_t mix64(uint64_t x) {
  x ^= x >> 33;
  x *= 0xff51afd7ed558ccdull;
  x ^= x >> 33;
  x *= 0xc4ceb9fe1a85ec53ull;
  return x ^ (x >> 33);
}

class Hash {
 public:
  Hash& add(const void* data, size_t bytes) {
    const unsigned char* p = static_cast<const unsigned char*>(data);
    for (; bytes >= 8; bytes -= 8, p += 8) {
      uint64_t word;
      std::memcpy(&word, p, 8);
      add_word(word);
    }
    uint64_t tail = 0;
    if (bytes > 0) std::memcpy(&tail, p, bytes);
    add_word(tail ^ (static_cast<uint64_t>(bytes) << 56));
    return *this;
  }
  Hash& add_word(uint64_t word) {
    state_ = mix64(state_ ^ word) + 0x9e3779b97f4a7c15ull;
    return *this;
  }
  Hash& add(const std::string& s) { return add(s.data(), s.size()); }
  uint64_t value() const { return mix64(state_); }

 private:
  uint64_t state_ = 0x5370616e52617921ull;
};

// 16 lower-case hexadecimal digits.
inline std::string hash_text(uint64_t hash) {
  std::string text(16, '0');
  for (int i = 15; i >= 0; --i, hash >>= 4) text[static_cast<size_t>(i)] = "0123456789abcdef"[hash & 15];
  return text;
}

}  // namespace spanray
