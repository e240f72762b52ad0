#include "report_plot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "core/number_text.h"

namespace spanray::demo {
namespace {

constexpr double kWidth = 900, kHeight = 460, kLeft = 70, kRight = 20, kTop = 20, kBottom = 50;

std::string fixed1(double v) {
  char text[40];
  std::snprintf(text, sizeof text, "%.1f", v);
  return text;
}

// A logarithmic axis from low to high, whose ends are of the form {1, 2, 5} 10^k.
class Axis {
 public:
  Axis(double low, double high, double at_low, double at_high) : at_low_(at_low), at_high_(at_high) {
    for (int k = -12; k <= 12; ++k)
      for (const double digit : {1.0, 2.0, 5.0}) ticks_.push_back(digit * std::pow(10.0, k));
    while (ticks_.size() > 2 && ticks_[1] <= low) ticks_.erase(ticks_.begin());
    while (ticks_.size() > 2 && ticks_[ticks_.size() - 2] >= high) ticks_.pop_back();
  }
  double at(double v) const {
    const double low = std::log(ticks_.front()), high = std::log(ticks_.back());
    const double part = (std::log(std::max(v, ticks_.front())) - low) / (high - low);
    return at_low_ + std::min(part, 1.0) * (at_high_ - at_low_);
  }
  const std::vector<double>& ticks() const { return ticks_; }

 private:
  double at_low_, at_high_;
  std::vector<double> ticks_;
};

std::string tick_text(double v) {
  char text[40];
  std::snprintf(text, sizeof text, "%.10g", v);
  return text;
}

}  // namespace

std::string escape_html(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else if (c == '\'')
      out += "&#39;";
    else
      out += c;
  }
  return out;
}

std::string scatter_plot(const std::vector<PlotPoint>& points, const std::string& error_name) {
  double ms_low = std::numeric_limits<double>::infinity(), ms_high = 0, low = ms_low, high = 0;
  for (const PlotPoint& p : points) {
    ms_low = std::min(ms_low, p.cost.ms), ms_high = std::max(ms_high, p.cost.ms), high = std::max(high, p.cost.error);
    if (p.cost.error > 0) low = std::min(low, p.cost.error);
  }
  if (high == 0) low = 0.5, high = 1;
  const Axis x(ms_low * 0.95, ms_high * 1.05, kLeft, kWidth - kRight), y(low * 0.95, high * 1.05, kHeight - kBottom, kTop);
  std::string svg =
      "<svg viewBox=\"0 0 900 460\" role=\"img\" aria-label=\"" + escape_html(error_name) + " against frame time\">\n";
  for (const double t : x.ticks())
    svg += "<line class=\"grid\" x1=\"" + fixed1(x.at(t)) + "\" x2=\"" + fixed1(x.at(t)) + "\" y1=\"" + fixed1(kTop) +
           "\" y2=\"" + fixed1(kHeight - kBottom) + "\"/><text x=\"" + fixed1(x.at(t)) + "\" y=\"" +
           fixed1(kHeight - kBottom + 18) + "\" text-anchor=\"middle\">" + tick_text(t) + "</text>\n";
  for (const double t : y.ticks())
    svg += "<line class=\"grid\" x1=\"" + fixed1(kLeft) + "\" x2=\"" + fixed1(kWidth - kRight) + "\" y1=\"" + fixed1(y.at(t)) +
           "\" y2=\"" + fixed1(y.at(t)) + "\"/><text x=\"" + fixed1(kLeft - 8) + "\" y=\"" + fixed1(y.at(t) + 4) +
           "\" text-anchor=\"end\">" + tick_text(t) + "</text>\n";
  svg +=
      "<text x=\"485\" y=\"452\" text-anchor=\"middle\">median frame time, ms</text>\n<text transform=\"translate(16 215) "
      "rotate(-90)\" text-anchor=\"middle\">" +
      escape_html(error_name) + "</text>\n";

  std::vector<const PlotPoint*> front;
  for (const PlotPoint& p : points)
    if (p.on_front) front.push_back(&p);
  std::sort(front.begin(), front.end(), [](const PlotPoint* a, const PlotPoint* b) { return a->cost.ms < b->cost.ms; });
  std::string path;
  for (const PlotPoint* p : front)  // until the next point is affordable, this one is the best
    path += path.empty() ? "M" + fixed1(x.at(p->cost.ms)) + " " + fixed1(y.at(p->cost.error))
                         : "H" + fixed1(x.at(p->cost.ms)) + "V" + fixed1(y.at(p->cost.error));
  svg += "<path class=\"front\" d=\"" + path + "\"/>\n";
  for (const bool on_front : {false, true})
    for (const PlotPoint& p : points) {
      if (p.on_front != on_front) continue;
      char text[96];
      std::snprintf(text, sizeof text, ": %.4g ms, %s %.4g", p.cost.ms, error_name.c_str(), p.cost.error);
      svg += std::string("<circle class=\"") + (on_front ? "best" : "other") + "\" data-id=\"" + escape_html(p.id) +
             "\" cx=\"" + fixed1(x.at(p.cost.ms)) + "\" cy=\"" + fixed1(y.at(p.cost.error)) + "\" r=\"" +
             (on_front ? "6" : "5") + "\"><title>" + escape_html(p.name + text) + "</title></circle>\n";
    }
  for (size_t i = 0; i < front.size(); ++i)
    svg += "<text class=\"number\" x=\"" + fixed1(x.at(front[i]->cost.ms) + 8) + "\" y=\"" +
           fixed1(y.at(front[i]->cost.error) - 8) + "\">" + std::to_string(i + 1) + "</text>\n";
  return svg + "</svg>\n";
}

}  // namespace spanray::demo
