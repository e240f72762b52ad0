#include "report_html.h"

#include <cmath>
#include <cstdio>

namespace spanray::demo {

std::string short_number(double v) {
  char text[40];
  if (!std::isfinite(v)) return "∞";
  std::snprintf(text, sizeof text,
                v >= 100               ? "%.0f"
                : v >= 10              ? "%.1f"
                : v >= 1               ? "%.2f"
                : v >= 0.001 || v == 0 ? "%.4f"
                : v >= 0.0001          ? "%.5f"
                                       : "%.1e",
                v);
  return text;
}
// Source: RFC 4648, 4.
std::string base64(const std::string& bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    unsigned word = 0;
    for (size_t k = 0; k < 3; ++k) word = word << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? kDigits[word >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

std::string cell(const std::string& text, const char* kind) {
  return std::string("<td") + (*kind != 0 ? " class=\"" + std::string(kind) + "\"" : "") + ">" + text + "</td>";
}
std::string cell(double v) { return cell(short_number(v)); }
std::string hundredths(double v) {
  char text[40];
  std::snprintf(text, sizeof text, "%.2f", v);
  return text;
}
std::string milliseconds(double v) {
  char text[40];
  std::snprintf(text, sizeof text, v >= 100 ? "%.0f" : v >= 10 ? "%.1f" : "%.2f", v);
  return text;
}
std::string head(std::initializer_list<Title> titles) {
  std::string text = "<tr>";
  for (const Title& title : titles)
    text += std::string(&title == titles.begin() || title.text ? "<th class=\"text\">" : "<th>") + title.html + "</th>";
  return text + "</tr>\n";
}

}  // namespace spanray::demo
