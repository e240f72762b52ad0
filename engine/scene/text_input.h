// Reading text files and the words and numbers in them: what the OBJ, MTL and scene-file readers share.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "spanray/result.h"

namespace spanray {

// The bytes of a regular file. Errors: missing, a directory, not regular, unreadable, empty, larger than
// max_bytes, UTF-16 (by its byte order mark).
Result<std::string> read_text_file(const std::string& path, uint64_t max_bytes);

inline bool is_space(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
std::string_view trim(std::string_view text);
// Removes the next word, delimited by spaces and tabs, from the front of text and returns it; "" at the end.
std::string_view next_word(std::string_view& text);
std::string lower_case(std::string_view text);  // ASCII letters only
// The part of a line before '#'.
std::string_view without_comment(std::string_view line);

// The float nearest to a decimal number (correctly rounded, any locale): "1", "+.5", "-2e3", "nan", "inf". Too large gives
// infinity, too small zero or a denormal. False if the word is anything else.
bool parse_float(std::string_view word, float* out);
// A decimal integer with |value| <= 999,999,999. False if the word is anything else.
bool parse_int(std::string_view word, int32_t* out);

// Printable form of a piece of a file for a message: at most 40 characters, others than ASCII text replaced by '?'.
std::string quoted(std::string_view text);

// Cuts a text into lines ended by LF, CR LF or CR, and joins lines that end in a backslash.
class LineReader {
 public:
  explicit LineReader(std::string_view text);
  // False at the end of the text. The view lives until the next call.
  bool next(std::string_view* line);
  int line_number() const { return first_line_; }  // 1-based, of the first physical line of the last one read

 private:
  std::string_view physical_line();
  std::string_view rest_;
  std::string joined_;
  int first_line_ = 0, lines_ = 0;
};

// Warnings for the user, in order, each with file and line; floods are cut short and counted.
class Messages {
 public:
  void warn(const std::string& file, int line, const std::string& text);
  void note(const std::string& text);
  std::vector<std::string> take();
  uint64_t warnings() const { return warnings_; }  // how often warn() was called

 private:
  std::vector<std::string> lines_;
  uint64_t warnings_ = 0;
  uint64_t left_out_ = 0;
};

}  // namespace spanray
