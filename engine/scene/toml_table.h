// Checked access to TOML tables: every key known, every type and range right, or an error with file and line.
#pragma once
#define TOML_EXCEPTIONS 0
#define TOML_HEADER_ONLY 1
#define TOML_MAX_NESTED_VALUES 16  // together with kMostDotsInALine bounds toml++'s recursion
#include <toml++/impl/preprocessor.h>
// toml++ 3.3 asserts in parse_key what hostile files break ("[="), right before it handles just that as an error: an abort in
// Debug, a false __builtin_assume in Release.
#undef TOML_ASSERT
#undef TOML_ASSERT_ASSUME
#define TOML_ASSERT(expr) static_assert(true)
#define TOML_ASSERT_ASSUME(expr) static_assert(true)
#include <toml++/toml.h>

#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "spanray/result.h"
#include "spanray/settings_text.h"

namespace spanray {

// Keeps the first error of a file, in order of lines.
class TomlErrors {
 public:
  explicit TomlErrors(std::string file) : file_(std::move(file)) {}
  void add(const toml::source_region& where, const std::string& message) {
    const int line = static_cast<int>(where.begin.line);
    if (error_ && error_->line <= line) return;
    error_ = Error{message, file_, line};
  }
  const std::optional<Error>& first() const { return error_; }

 private:
  std::string file_;
  std::optional<Error> error_;
};

struct Range {
  double least, most;
};
inline constexpr Range kAnyNumber = {-1e30, 1e30};

// One table of the file, with the words for messages. Getters return false where the key is absent or wrong (then an error
// stands).
class TomlTable {
 public:
  // what: "camera", "[technique]": for messages.
  TomlTable(const toml::table& table, std::string what, const std::vector<std::string>& known, TomlErrors& errors);

  bool has(const char* key) const { return table_.contains(key); }
  int line_of(const char* key) const;
  const toml::table& raw() const { return table_; }
  // An error unless the key is there.
  bool require(const char* key);
  void fail(const char* key, const std::string& message);  // at the key, or at the table if the key is absent

  bool text(const char* key, std::string* out);
  bool boolean(const char* key, bool* out);
  bool integer(const char* key, int least, int most, int* out);
  bool number(const char* key, Range range, double* out);
  template <class T>
  bool vector3(const char* key, Range range, T out[3]) {
    double v[3];
    if (!doubles3(key, range, v)) return false;
    for (int i = 0; i < 3; ++i) out[i] = static_cast<T>(v[i]) + T(0);
    return true;
  }
  // One of `words`; its index.
  bool word(const char* key, const std::vector<std::string>& words, size_t* out);
  template <class E>
  bool word(const char* key, E* out) {
    size_t index = 0;
    if (!word(key, enum_words<E>(), &index)) return false;
    *out = enum_names<E>()[index].value;
    return true;
  }
  // The tables of `[[key]]`, in order; an error if it is anything else. Empty where absent.
  std::vector<const toml::table*> tables(const char* key);

 private:
  bool doubles3(const char* key, Range range, double out[3]);
  bool in_range(const toml::node& node, const char* key, Range range, double* out);
  void wrong_type(const toml::node& node, const char* key, const char* expected);
  std::string name(const char* key) const {
    return what_.empty() ? "'" + std::string(key) + "'" : "'" + std::string(key) + "' of " + what_;
  }

  const toml::table& table_;
  std::string what_;
  TomlErrors& errors_;
};

}  // namespace spanray
