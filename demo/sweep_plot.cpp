#include "sweep_plot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "report_plot.h"

namespace spanray::demo {
namespace {

constexpr double kWidth = 900, kHeight = 400, kLeft = 84, kRight = 20, kTop = 14, kBottom = 52,
                 kZero = 30;  // the last: of the line of zeros

std::string fixed1(double v) {
  char text[40];
  std::snprintf(text, sizeof text, "%.1f", v);
  return text;
}

// 10 to the power of k, as people write it.
std::string power_text(int k) {
  if (k >= -2 && k <= 3) {
    char text[40];
    std::snprintf(text, sizeof text, "%g", std::pow(10.0, k));
    return text;
  }
  static constexpr const char* kDigits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = k < 0 ? "10⁻" : "10";
  for (const char c : std::to_string(std::abs(k))) text += kDigits[c - '0'];
  return text;
}

// Whole decades around the positive values.
struct Axis {
  int low = std::numeric_limits<int>::max(), high = std::numeric_limits<int>::min();
  double at_low = 0, at_high = 0;
  bool zero = false;
  void take(double v) {
    zero |= v == 0;
    if (!(v > 0) || !std::isfinite(v)) return;
    const double power = std::log10(v);
    low = std::min(low, static_cast<int>(std::floor(power + 1e-9))), high = std::max(high, static_cast<int>(std::ceil(power - 1e-9)));
  }
  void close() {
    if (low > high) low = -1, high = 0;
    if (high - low < 2) low = high - 2;
  }
  double at(double v) const { return at_low + (std::log10(v) - low) / (high - low) * (at_high - at_low); }
  int every() const { return high - low > 9 ? 2 : 1; }
};

std::string line(double x1, double y1, double x2, double y2, const char* kind) {
  return std::string("<line class=\"") + kind + "\" x1=\"" + fixed1(x1) + "\" y1=\"" + fixed1(y1) + "\" x2=\"" + fixed1(x2) +
         "\" y2=\"" + fixed1(y2) + "\"/>";
}
std::string label(double x, double y, const char* anchor, const std::string& text) {
  return "<text x=\"" + fixed1(x) + "\" y=\"" + fixed1(y) + "\" text-anchor=\"" + anchor + "\">" + text + "</text>\n";
}

std::string grid(const hard::Sweep& s, const Axis& x, const Axis& y, double zero_at) {
  std::string svg;
  const double bottom = kHeight - kBottom;
  for (int k = x.low; k <= x.high; k += x.every()) {
    const double at = x.at(std::pow(10.0, k));
    svg += line(at, kTop, at, bottom, "grid") + label(at, bottom + 19, "middle", power_text(k));
  }
  for (int k = y.low; k <= y.high; k += y.every()) {
    const double at = y.at(std::pow(10.0, k));
    svg += line(kLeft, at, kWidth - kRight, at, "grid") + label(kLeft - 9, at + 4.5, "end", power_text(k));
  }
  if (y.zero) svg += line(kLeft, zero_at, kWidth - kRight, zero_at, "grid") + label(kLeft - 9, zero_at + 4.5, "end", "0");
  svg += label((kLeft + kWidth - kRight) / 2, kHeight - 8, "middle", escape_html(s.x_name));
  return svg + "<text transform=\"translate(18 " + fixed1((kTop + bottom) / 2) + ") rotate(-90)\" text-anchor=\"middle\">" +
         escape_html(s.y_name) + "</text>\n";
}

// The path, and a mark with its value at each point; wide marks first, so that curves which coincide are all seen.
std::string curve(const hard::Sweep& s, size_t index, const Axis& x, const Axis& y, double zero_at) {
  const hard::Curve& c = s.curves[index];
  const std::string kind = "c" + std::to_string(index);
  std::string path, marks;
  bool down = false;
  for (size_t i = 0; i < s.x.size(); ++i) {
    if (!std::isfinite(c.y[i])) {
      down = false;
      continue;
    }
    const double px = x.at(s.x[i]), py = c.y[i] == 0 ? zero_at : y.at(c.y[i]);
    path += (down ? "L" : "M") + fixed1(px) + " " + fixed1(py), down = true;
    char text[80];
    std::snprintf(text, sizeof text, ": %.3g at %.3g", c.y[i], s.x[i]);
    marks += "<circle class=\"" + kind + "\" cx=\"" + fixed1(px) + "\" cy=\"" + fixed1(py) + "\" r=\"" +
             fixed1(5.5 - 1.2 * static_cast<double>(index)) + "\"><title>" + escape_html(c.name + text) + "</title></circle>\n";
  }
  return "<path class=\"" + kind + "\" d=\"" + path + "\"/>\n" + marks;
}

std::string legend(const hard::Sweep& s) {
  std::string html = "<ul class=\"legend\">";
  const auto entry = [&](const std::string& kind, const std::string& name, bool strong) {
    html += "<li><svg viewBox=\"0 0 34 12\"><path class=\"" + kind + "\" d=\"M1 6L33 6\"/></svg> " + (strong ? "<b>" : "") +
            escape_html(name) + (strong ? "</b>" : "") + "</li>";
  };
  for (size_t i = 0; i < s.curves.size(); ++i) entry("c" + std::to_string(i), s.curves[i].name, s.curves[i].ours);
  if (!s.bound_name.empty()) entry("bound", s.bound_name, false);
  return html + "</ul>\n";
}

}  // namespace

std::string sweep_plot(const hard::Sweep& s) {
  Axis x, y;
  for (const double v : s.x) x.take(v);
  for (const hard::Curve& c : s.curves)
    for (const double v : c.y) y.take(v);
  for (const double v : s.bound) y.take(v);
  x.close(), y.close();
  const double zero_at = kHeight - kBottom - 8;
  x.at_low = kLeft, x.at_high = kWidth - kRight;
  y.at_low = y.zero ? zero_at - kZero : kHeight - kBottom, y.at_high = kTop;
  std::string svg = "<svg class=\"sweep\" viewBox=\"0 0 900 400\" role=\"img\" aria-label=\"" + escape_html(s.title) + "\">\n" +
                    grid(s, x, y, zero_at);
  if (!s.bound.empty()) {
    std::string path;
    for (size_t i = 0; i < s.x.size(); ++i) path += (i == 0 ? "M" : "L") + fixed1(x.at(s.x[i])) + " " + fixed1(y.at(s.bound[i]));
    svg += "<path class=\"bound\" d=\"" + path + "\"/>\n";
  }
  for (size_t i = 0; i < s.curves.size(); ++i) svg += curve(s, i, x, y, zero_at);
  return svg + "</svg>\n" + legend(s);
}

}  // namespace spanray::demo
