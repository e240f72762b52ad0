// Cells and numbers of the report's tables.
#pragma once
#include <initializer_list>
#include <string>

namespace spanray::demo {

// A few significant digits, as the eye wants them; the CSV has all.
std::string short_number(double v);
std::string hundredths(double v);
std::string milliseconds(double v);
// Of the bytes of a file.
std::string base64(const std::string& bytes);
// text: HTML. kind: of the style sheet.
std::string cell(const std::string& text, const char* kind = "");
std::string cell(double v);
// HTML, over a column of numbers or of text.
struct Title {
  const char* html;
  bool text = false;
  Title(const char* title) : html(title) {}
  Title(const char* title, bool over_text) : html(title), text(over_text) {}
};
inline Title over_text(const char* title) { return {title, true}; }
// A row of titles; the first is that of the column of names, which are text.
std::string head(std::initializer_list<Title> titles);

}  // namespace spanray::demo
