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
  // Whether there is room for a tick's label: where the axis spans many powers of ten, only these have one.
  bool labels(double tick) const { return ticks_.size() <= 16 || std::fabs(std::log10(tick) - std::round(std::log10(tick))) < 1e-6; }

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

namespace {

std::string line_svg(const char* kind, double x1, double y1, double x2, double y2) {
  return std::string("<line class=\"") + kind + "\" x1=\"" + fixed1(x1) + "\" x2=\"" + fixed1(x2) + "\" y1=\"" + fixed1(y1) + "\" y2=\"" +
         fixed1(y2) + "\"/>";
}
std::string text_svg(const char* kind, double x, double y, const char* anchor, const std::string& text) {
  return std::string("<text") + (*kind != 0 ? std::string(" class=\"") + kind + "\"" : "") + " x=\"" + fixed1(x) + "\" y=\"" + fixed1(y) +
         "\" text-anchor=\"" + anchor + "\">" + text + "</text>\n";
}

struct Box { double x0, y0, x1, y1; };
bool overlap(const Box& a, const Box& b) { return a.x0 < b.x1 && b.x0 < a.x1 && a.y0 < b.y1 && b.y0 < a.y1; }

// Numbers beside their points, where nothing else stands; farther off, with a line that leads there, if it is crowded.
class Labels {
 public:
  void block(double x, double y, double radius) { taken_.push_back({x - radius, y - radius, x + radius, y + radius}); }
  std::string place(double x, double y, const std::string& text) {
    const double width = 9.0 * static_cast<double>(text.size()), height = 13;
    Box best{};
    size_t least = taken_.size() + 1;
    double led = 0;
    for (double away = 8; away <= 80 && least > 0; away += 8)
      for (const auto& [dx, dy] : {std::pair{1.0, -1.0}, {-1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}, {0.0, -1.5}, {0.0, 1.5}, {1.5, 0.0}, {-1.5, 0.0}}) {
        const double cx = x + dx * (away + width / 2), cy = y + dy * (away + height / 2 - 4);
        const Box box{cx - width / 2, cy - height / 2, cx + width / 2, cy + height / 2};
        if (box.x0 < kLeft || box.x1 > kWidth || box.y0 < 0 || box.y1 > kHeight - kBottom + 4) continue;
        const size_t hit = static_cast<size_t>(std::count_if(taken_.begin(), taken_.end(), [&](const Box& t) { return overlap(t, box); }));
        if (hit < least) least = hit, best = box, led = away;
      }
    taken_.push_back(best);
    const double cx = (best.x0 + best.x1) / 2, cy = (best.y0 + best.y1) / 2;
    std::string svg;
    if (led > 12) svg = line_svg("leader", x, y, std::clamp(x, best.x0, best.x1), std::clamp(y, best.y0, best.y1));
    return svg + text_svg("number", cx, cy + 5, "middle", text);
  }

 private:
  std::vector<Box> taken_;
};

}  // namespace

std::string scatter_plot(const std::vector<PlotPoint>& points, const std::string& error_name, double truth_error) {
  double ms_low = std::numeric_limits<double>::infinity(), ms_high = 0, low = ms_low, high = 0;
  bool any_zero = false;
  for (const PlotPoint& p : points) {
    ms_low = std::min(ms_low, p.cost.ms), ms_high = std::max(ms_high, p.cost.ms), high = std::max(high, p.cost.error);
    if (p.cost.error > 0) low = std::min(low, p.cost.error);
    else any_zero = true;
  }
  if (truth_error > 0) low = std::min(low, truth_error), high = std::max(high, truth_error);
  if (high == 0) low = 0.5, high = 1;
  const double bottom = kHeight - kBottom, zero = bottom - 10;  // 0 has no place on a logarithmic axis: a row of its own, if need be
  const Axis x(ms_low * 0.95, ms_high * 1.05, kLeft, kWidth - kRight), y(low * 0.95, high * 1.05, any_zero ? bottom - 30 : bottom, kTop);
  const auto x_of = [&](const PlotPoint& p) { return x.at(p.cost.ms); };
  const auto y_of = [&](const PlotPoint& p) { return p.cost.error > 0 ? y.at(p.cost.error) : zero; };
  std::string svg = "<svg viewBox=\"0 0 900 460\" role=\"img\" aria-label=\"" + escape_html(error_name) + " against frame time\">\n";
  for (const double t : x.ticks())
    svg += line_svg("grid", x.at(t), kTop, x.at(t), bottom) + text_svg("", x.at(t), bottom + 18, "middle", tick_text(t));
  for (const double t : y.ticks())
    svg += line_svg("grid", kLeft, y.at(t), kWidth - kRight, y.at(t)) +
           (y.labels(t) ? text_svg("", kLeft - 8, y.at(t) + 4, "end", tick_text(t)) : "\n");
  if (any_zero)
    svg += line_svg("zero", kLeft, zero, kWidth - kRight, zero) + text_svg("", kLeft - 8, zero + 4, "end", "0") +
           text_svg("", kWidth - kRight - 4, zero - 5, "end", "no error at all (not on the scale)");
  svg += text_svg("", 485, 452, "middle", "median frame time, ms") + "<text transform=\"translate(16 215) rotate(-90)\" text-anchor=\"middle\">" +
         escape_html(error_name) + "</text>\n";
  if (truth_error > 0)
    svg += line_svg("truth", kLeft, y.at(truth_error), kWidth - kRight, y.at(truth_error)) +
           text_svg("truth", kLeft + 4, y.at(truth_error) - 5, "start", "the ground truth's own error");

  std::vector<const PlotPoint*> front;
  for (const PlotPoint& p : points)
    if (p.on_front) front.push_back(&p);
  std::stable_sort(front.begin(), front.end(), [](const PlotPoint* a, const PlotPoint* b) { return a->cost.ms < b->cost.ms; });
  std::string path;
  for (const PlotPoint* p : front)  // until the next point is affordable, this one is the best
    path += path.empty() ? "M" + fixed1(x_of(*p)) + " " + fixed1(y_of(*p)) : "H" + fixed1(x_of(*p)) + "V" + fixed1(y_of(*p));
  svg += "<path class=\"front\" d=\"" + path + "\"/>\n";
  Labels labels;
  for (const bool on_front : {false, true})
    for (const PlotPoint& p : points) {
      if (p.on_front != on_front) continue;
      char text[96];
      std::snprintf(text, sizeof text, ": %.4g ms, %s %.4g", p.cost.ms, error_name.c_str(), p.cost.error);
      svg += std::string("<circle class=\"") + (on_front ? "best" : "other") + "\" data-id=\"" + escape_html(p.id) + "\" cx=\"" + fixed1(x_of(p)) +
             "\" cy=\"" + fixed1(y_of(p)) + "\" r=\"" + (on_front ? "6" : "5") + "\"><title>" + escape_html(p.name + text) + "</title></circle>\n";
      labels.block(x_of(p), y_of(p), 6);
    }
  for (size_t i = 0; i < front.size(); ++i) svg += labels.place(x_of(*front[i]), y_of(*front[i]), std::to_string(i + 1));
  return svg + "</svg>\n";
}

}  // namespace spanray::demo
