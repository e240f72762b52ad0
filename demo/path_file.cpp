#include "path_file.h"

#include <bit>
#include <charconv>
#include <cstring>
#include <string_view>

#include "core/atomic_file.h"
#include "core/hash.h"
#include "core/read_file.h"

namespace spanray::demo {
namespace {

static_assert(std::endian::native == std::endian::little, "doubles and floats are written as they are");
constexpr std::string_view kMagic = "\nspanray paths 1\n";
constexpr const char* kPathsKey = "paths";

template <class T>
void append(std::string& bytes, const T* values, size_t count) {
  bytes.append(reinterpret_cast<const char*>(values), count * sizeof(T));
}

std::string pfm_header(int width, int height) {
  return "PF\n" + std::to_string(width) + " " + std::to_string(height) + "\n-1.0\n";
}

uint64_t hash_of(std::string_view bytes) { return Hash().add(bytes.data(), bytes.size()).value(); }

// The next line, without its end; false where there is none any more.
bool next_line(std::string_view& rest, std::string_view& line) {
  const size_t end = rest.find('\n');
  if (end == std::string_view::npos) return false;
  line = rest.substr(0, end), rest.remove_prefix(end + 1);
  return true;
}

Error truncated() { return Error{"the file is truncated"}; }

Result<void> read_meaning(std::string_view& rest, const PathMeaning& meaning, uint32_t& paths) {
  std::string_view line;
  for (const auto& [key, value] : meaning) {
    if (!next_line(rest, line)) return truncated();
    if (line != key + "=" + value)
      return Error{"holds paths of another picture: " + std::string(line) + " there, " + key + "=" + value + " here"};
  }
  if (!next_line(rest, line)) return truncated();
  const std::string key = std::string(kPathsKey) + "=";
  const std::string_view number = line.substr(std::min(key.size(), line.size()));
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), paths);
  if (line.substr(0, key.size()) != key || error != std::errc() || end != number.data() + number.size() || paths > kMostPaths)
    return Error{"bad number of paths"};
  if (!next_line(rest, line)) return truncated();
  return line.empty() ? Result<void>() : Error{"the sums do not follow the number of paths"};
}

Result<PathSums> decode(std::string_view bytes, const PathMeaning& meaning, int width, int height) {
  const size_t pixels = static_cast<size_t>(width) * static_cast<size_t>(height);
  std::string_view rest = bytes;
  if (rest.substr(0, 3) != "PF\n") return Error{"not a file that --accumulate wrote"};
  rest.remove_prefix(3);
  std::string_view size;
  if (!next_line(rest, size)) return truncated();
  if (const std::string want = std::to_string(width) + " " + std::to_string(height); size != want)
    return Error{"holds paths of another picture: " + std::string(size) + " pixels there, " + want + " here"};
  const size_t begin = pfm_header(width, height).size() + 12 * pixels;
  if (bytes.size() < begin) return truncated();
  if (bytes.size() == begin) return Error{"a picture without sums: not a file that --accumulate wrote"};
  rest = bytes.substr(begin);
  if (rest.substr(0, kMagic.size()) != kMagic.substr(0, rest.size())) return Error{"not a file that --accumulate wrote"};
  if (rest.size() < kMagic.size()) return truncated();
  rest.remove_prefix(kMagic.size());
  PathSums sums;
  sums.width = width, sums.height = height;
  if (auto read = read_meaning(rest, meaning, sums.paths); !read) return read.error();
  if (rest.size() < 32 * pixels + 8) return truncated();
  uint64_t hash;
  std::memcpy(&hash, bytes.data() + bytes.size() - 8, 8);
  if (rest.size() != 32 * pixels + 8 || hash != hash_of(bytes.substr(0, bytes.size() - 8))) return Error{"the file is damaged"};
  sums.radiance.resize(3 * pixels), sums.square.resize(pixels);
  std::memcpy(sums.radiance.data(), rest.data(), 24 * pixels);
  std::memcpy(sums.square.data(), rest.data() + 24 * pixels, 8 * pixels);
  return sums;
}

}  // namespace

Result<void> write_path_file(const std::string& path, const PathSums& sums, const PathMeaning& meaning) {
  Framebuffer picture;
  path_picture(sums, picture);
  const size_t row = 3 * static_cast<size_t>(sums.width);
  std::string bytes = pfm_header(sums.width, sums.height);
  for (size_t y = static_cast<size_t>(sums.height); y-- > 0;) append(bytes, picture.radiance.data() + y * row, row);
  bytes += kMagic;
  for (const auto& [key, value] : meaning) bytes += key + "=" + value + "\n";
  bytes += std::string(kPathsKey) + "=" + std::to_string(sums.paths) + "\n\n";
  append(bytes, sums.radiance.data(), sums.radiance.size()), append(bytes, sums.square.data(), sums.square.size());
  const uint64_t hash = hash_of(bytes);
  append(bytes, &hash, 1);
  return write_file_atomic(path, bytes);
}

Result<PathSums> read_path_file(const std::string& path, const PathMeaning& meaning, int width, int height) {
  const Result<std::string> bytes = read_file(path, size_t{1} << 40);
  if (!bytes) return bytes.error();
  Result<PathSums> sums = decode(bytes.value(), meaning, width, height);
  if (!sums) return Error{sums.error().message, path};
  return sums;
}

}  // namespace spanray::demo
