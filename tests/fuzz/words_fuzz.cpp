// Numbers and words of all text files: against the C library's conversion, and against what text_input.h promises.
#include <cmath>
#include <cstring>

#include "fuzz.h"
#include "scene/text_input.h"
#include "spanray/settings_text.h"

namespace spanray {
namespace {

// The C library takes hexadecimal and "nan(...)" as well; the locale is "C" here.
void check_float(std::string_view word) {
  float value = 0;
  if (!parse_float(word, &value)) return;
  const std::string text(word);
  must(text.find_first_of("xXpP(") == std::string::npos, "a number with letters:", text);
  char* end = nullptr;
  const float expected = std::strtof(text.c_str(), &end);
  must(end == text.c_str() + text.size(), "what the C library does not take for a number:", text);
  must((std::isnan(expected) && std::isnan(value)) || std::memcmp(&expected, &value, sizeof value) == 0, "another number:", text);
}

void check_int(std::string_view word) {
  int32_t value = 0;
  if (!parse_int(word, &value)) return;
  const std::string text(word);
  char* end = nullptr;
  must(std::strtoll(text.c_str(), &end, 10) == value && end == text.c_str() + text.size(), "another integer:", text);
}

void check_word(std::string_view word) {
  check_float(word);
  check_int(word);
  const std::string shown = quoted(word);
  must(shown.size() <= 45, "quoted text that is too long");
  for (const char c : shown) must(c >= 32 && c < 127, "quoted text that cannot be printed");
  const std::string near = nearest_word(word, enum_words<Shading>());
  if (const auto value = enum_from_text<Shading>(word)) must(near == enum_text(*value), "a word that is not nearest to itself");
}

}  // namespace
}  // namespace spanray

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace spanray;
  const std::string_view text = text_of(data, size);
  LineReader lines(text);
  int last = 0;
  for (std::string_view line; lines.next(&line);) {
    must(lines.line_number() > last, "lines out of order");
    last = lines.line_number();
    must(line.find_first_of("\r\n") == std::string_view::npos, "a line with a line end in it");
    for (std::string_view rest = without_comment(line), word; !(word = next_word(rest)).empty();) check_word(word);
  }
  must(static_cast<size_t>(last) <= size + 1, "more lines than bytes");
  return 0;
}
