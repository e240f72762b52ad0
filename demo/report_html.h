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
// A row of titles, which are HTML; the first is that of the column of names. Of those that begin with '<', which is left out,
// the column is text as well.
std::string head(std::initializer_list<const char*> titles);

}  // namespace spanray::demo
