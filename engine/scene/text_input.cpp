#include "scene/text_input.h"

#include <charconv>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>

namespace spanray {
namespace {

constexpr size_t kMaxMessages = 200;

struct CloseFile {
  void operator()(std::FILE* f) const { std::fclose(f); }
};

// from_chars does not say on which side of the range a number lies: the exponent's sign and the leading zeros do.
float out_of_range_value(std::string_view digits) {
  double wide = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), wide);
  if (error == std::errc()) return static_cast<float>(wide);
  const size_t exponent = digits.find_first_of("eE");
  const bool has_exponent = exponent != std::string_view::npos && exponent + 1 < digits.size();
  const bool small = has_exponent ? digits[exponent + 1] == '-'
                                  : digits.substr(0, digits.find('.')).find_first_of("123456789") == std::string_view::npos;
  return small ? 0.0f : std::numeric_limits<float>::infinity();
}

}  // namespace

Result<std::string> read_text_file(const std::string& path, uint64_t max_bytes) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) return Error{"no such file", path};
  if (fs::is_directory(status)) return Error{"is a directory, not a file", path};
  if (!fs::is_regular_file(status)) return Error{"is not a regular file", path};
  const std::unique_ptr<std::FILE, CloseFile> file(std::fopen(path.c_str(), "rb"));
  if (!file) return Error{"cannot be opened for reading", path};
  const uint64_t size = fs::file_size(path, error);
  if (error) return Error{"cannot be read", path};
  if (size > max_bytes)
    return Error{"is too large: " + std::to_string(size) + " bytes, at most " + std::to_string(max_bytes), path};
  std::string text(size, '\0');
  text.resize(std::fread(text.data(), 1, size, file.get()));
  if (text.size() != size) return Error{"cannot be read", path};
  if (text.empty()) return Error{"the file is empty", path};
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff")) return Error{"is UTF-16 text: save it as UTF-8", path, 1};
  return text;
}

std::string_view trim(std::string_view text) {
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  return text;
}

std::string_view next_word(std::string_view& text) {
  size_t begin = 0;
  while (begin < text.size() && is_space(text[begin])) ++begin;
  size_t end = begin;
  while (end < text.size() && !is_space(text[end])) ++end;
  const std::string_view word = text.substr(begin, end - begin);
  text.remove_prefix(end);
  return word;
}

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return lower;
}

std::string_view without_comment(std::string_view line) { return line.substr(0, line.find('#')); }

bool parse_float(std::string_view word, float* out) {
  if (word.empty()) return false;
  const bool negative = word.front() == '-';
  if (negative || word.front() == '+') word.remove_prefix(1);
  if (word.empty() || word.front() == '-' || word.front() == '+') return false;
  if (word.back() == ')') return false;  // "nan(7)" is for machines
  float value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error == std::errc::invalid_argument || end != word.data() + word.size()) return false;
  if (error == std::errc::result_out_of_range) value = out_of_range_value(word);
  *out = negative ? -value : value;
  return true;
}

bool parse_int(std::string_view word, int32_t* out) {
  const bool negative = !word.empty() && word.front() == '-';
  if (negative || (!word.empty() && word.front() == '+')) word.remove_prefix(1);
  if (word.empty() || word.size() > 9) return false;
  int32_t value = 0;
  for (const char c : word) {
    if (c < '0' || c > '9') return false;
    value = value * 10 + (c - '0');
  }
  *out = negative ? -value : value;
  return true;
}

std::string quoted(std::string_view text) {
  std::string out = "'";
  for (const char c : text.substr(0, 40)) out += c >= 32 && c < 127 ? c : '?';
  return out + (text.size() > 40 ? "...'" : "'");
}

LineReader::LineReader(std::string_view text) : rest_(text) {
  constexpr std::string_view kUtf8Mark = "\xef\xbb\xbf";
  if (rest_.substr(0, 3) == kUtf8Mark) rest_.remove_prefix(3);
}

std::string_view LineReader::physical_line() {
  ++lines_;
  std::string_view line = rest_.substr(0, rest_.find('\n'));
  size_t used = line.size() < rest_.size() ? line.size() + 1 : line.size();
  const size_t cr = line.find('\r');
  if (cr != std::string_view::npos) {
    if (cr + 1 != line.size()) used = cr + 1;
    line = line.substr(0, cr);
  }
  rest_.remove_prefix(used);
  return line;
}

bool LineReader::next(std::string_view* line) {
  if (rest_.empty()) return false;
  *line = physical_line();
  first_line_ = lines_;
  if (line->empty() || line->back() != '\\') return true;
  joined_.assign(*line);
  while (!joined_.empty() && joined_.back() == '\\') {
    joined_.back() = ' ';
    if (!rest_.empty()) joined_.append(physical_line());
  }
  *line = joined_;
  return true;
}

void Messages::warn(const std::string& file, int line, const std::string& text) {
  ++warnings_;
  note(Error{"warning: " + text, file, line}.to_string());
}
void Messages::note(const std::string& text) {
  if (lines_.size() < kMaxMessages)
    lines_.push_back(text);
  else
    ++left_out_;
}
std::vector<std::string> Messages::take() {
  if (left_out_ > 0) lines_.push_back(std::to_string(left_out_) + " more messages left out");
  left_out_ = 0;
  return std::move(lines_);
}

}  // namespace spanray
