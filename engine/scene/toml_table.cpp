#include "scene/toml_table.h"

#include <cmath>

#include "core/number_text.h"

namespace spanray {
namespace {

std::string type_name(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::table:
      return "a table";
    case toml::node_type::array:
      return "an array";
    case toml::node_type::string:
      return "a string";
    case toml::node_type::integer:
      return "an integer";
    case toml::node_type::floating_point:
      return "a number";
    case toml::node_type::boolean:
      return "a boolean";
    default:
      return "a date or time";
  }
}

std::string list_of(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& w : words) text += (text.empty() ? "" : ", ") + w;
  return text;
}

}  // namespace

TomlTable::TomlTable(const toml::table& table, std::string what, const std::vector<std::string>& known, TomlErrors& errors)
    : table_(table), what_(std::move(what)), errors_(errors) {
  for (auto&& [key, node] : table) {
    const std::string word(key.str());
    bool is_known = false;
    for (const std::string& k : known) is_known = is_known || k == word;
    if (is_known) continue;
    errors_.add(key.source(),
                "unknown key " + quoted(word) + (what_.empty() ? "" : " of " + what_) + did_you_mean(word, known));
  }
}

int TomlTable::line_of(const char* key) const {
  const toml::node* node = table_.get(key);
  return static_cast<int>((node != nullptr ? node->source() : table_.source()).begin.line);
}

bool TomlTable::require(const char* key) {
  if (has(key)) return true;
  errors_.add(table_.source(), "key " + name(key) + " is missing");
  return false;
}

void TomlTable::fail(const char* key, const std::string& message) {
  const toml::node* node = table_.get(key);
  errors_.add(node != nullptr ? node->source() : table_.source(), name(key) + " " + message);
}

void TomlTable::wrong_type(const toml::node& node, const char* key, const char* expected) {
  errors_.add(node.source(), name(key) + " must be " + expected + ", not " + type_name(node));
}

bool TomlTable::text(const char* key, std::string* out) {
  const toml::node* node = table_.get(key);
  if (node == nullptr) return false;
  if (!node->is_string()) return wrong_type(*node, key, "a string"), false;
  *out = std::string(*node->value<std::string_view>());
  return true;
}

bool TomlTable::boolean(const char* key, bool* out) {
  const toml::node* node = table_.get(key);
  if (node == nullptr) return false;
  if (!node->is_boolean()) return wrong_type(*node, key, "true or false"), false;
  *out = node->as_boolean()->get();
  return true;
}

bool TomlTable::integer(const char* key, int least, int most, int* out) {
  const toml::node* node = table_.get(key);
  if (node == nullptr) return false;
  if (!node->is_integer()) return wrong_type(*node, key, "an integer"), false;
  const int64_t value = node->as_integer()->get();
  if (value < least || value > most)
    return fail(key, "is " + std::to_string(value) + "; it must be " + std::to_string(least) + " to " + std::to_string(most)),
           false;
  *out = static_cast<int>(value);
  return true;
}

bool TomlTable::in_range(const toml::node& node, const char* key, Range range, double* out) {
  if (!node.is_number()) return wrong_type(node, key, "a number"), false;
  const double value = node.is_integer() ? static_cast<double>(node.as_integer()->get()) : node.as_floating_point()->get();
  if (!(value >= range.least && value <= range.most)) {
    errors_.add(node.source(), name(key) + " is " + number_text(value) + "; it must be " + number_text(range.least) + " to " +
                                   number_text(range.most));
    return false;
  }
  *out = value;
  return true;
}

bool TomlTable::number(const char* key, Range range, double* out) {
  const toml::node* node = table_.get(key);
  return node != nullptr && in_range(*node, key, range, out);
}

bool TomlTable::doubles3(const char* key, Range range, double out[3]) {
  const toml::node* node = table_.get(key);
  if (node == nullptr) return false;
  if (!node->is_array()) return wrong_type(*node, key, "an array of 3 numbers"), false;
  const toml::array& array = *node->as_array();
  if (array.size() != 3) return fail(key, "must be an array of 3 numbers; it has " + std::to_string(array.size())), false;
  for (size_t i = 0; i < 3; ++i)
    if (!in_range(array[i], key, range, out + i)) return false;
  return true;
}

bool TomlTable::word(const char* key, const std::vector<std::string>& words, size_t* out) {
  std::string value;
  if (!text(key, &value)) return false;
  for (size_t i = 0; i < words.size(); ++i)
    if (words[i] == value) return *out = i, true;
  fail(key, "is " + quoted(value) + "; it must be one of " + list_of(words) + did_you_mean(value, words));
  return false;
}

std::vector<const toml::table*> TomlTable::tables(const char* key) {
  std::vector<const toml::table*> result;
  const toml::node* node = table_.get(key);
  if (node == nullptr) return result;
  const toml::array* array = node->as_array();
  if (array == nullptr) return fail(key, "must be a list of tables, written [[" + std::string(key) + "]]"), result;
  for (const toml::node& element : *array) {
    if (!element.is_table()) return fail(key, "must be a list of tables, written [[" + std::string(key) + "]]"), result;
    result.push_back(element.as_table());
  }
  return result;
}

}  // namespace spanray
