#include "report_plan.h"

#include <cmath>
#include <limits>

#include "report_html.h"
#include "report_plot.h"
#include "stats_json.h"

namespace spanray::demo {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

// Which settings tell the price of a stage: `turned` is the plain settings with one knob turned, away from the stage where they need it, toward
// it where they do not.
struct Switch {
  const char* stage;
  const char* turned;  // id of the candidate
};
constexpr Switch kSwitches[] = {{"textures", "textures-off"},
                                {"bump", "bump-off"},
                                {"shadow rays", "shadows-none"},
                                {"lifted shadow rays", "shadow-terminator-lifted"},
                                {"bounce rays", "reflections-none"},
                                {"composite", "transparency-none"},
                                {"primary rays", "visibility-ray"},
                                {"lit vertices", "shading-gouraud"},
                                {"shading rate 2x2", "shading-rate-2x2"},
                                {"normals as interpolated", "normals-interpolated"},
                                {"fast powers", "powers-fast"},
                                {"anti-aliasing", "samples-multisample-4"}};

// Stages that the frame's clocks know by themselves.
struct Clocked {
  const char* stage;
  std::vector<double StageTimes::*> times;
};
const std::vector<Clocked>& clocked() {
  static const std::vector<Clocked> table = {
      {"pose", {&StageTimes::pose}},
      {"transform, clip, bin, raster", {&StageTimes::transform, &StageTimes::clip, &StageTimes::bin, &StageTimes::raster}},
      {"BVH refit", {&StageTimes::bvh_refit}}};
  return table;
}

const Measured* find(const Report& report, const std::string& id) {
  for (const Measured& m : report.trade.settings)
    if (m.candidate.id == id) return &m;
  return nullptr;
}

PlanCost cost_of(const Report& report, const PlanLine& line) {
  const Measured& plain = report.trade.settings[0];
  if ((line.stage == "BVH" || line.stage == "translucent BVH") && line.needed)
    return {line, kUnknown, "all trees are built once, in " + milliseconds(plain.bvh_build_ms) + " ms, which is not part of a frame"};
  if (line.needed)
    for (const Clocked& c : clocked()) {
      if (line.stage != c.stage) continue;
      double ms = 0;
      for (double StageTimes::*time : c.times) ms += plain.median_ms(time);
      return {line, ms, "the stages' own clocks"};
    }
  for (const Switch& s : kSwitches) {
    if (line.stage != s.stage) continue;
    const Measured* const turned = find(report, s.turned);
    if (turned == nullptr) continue;
    const double on = line.needed ? plain.median_ms() : turned->median_ms(), off = line.needed ? turned->median_ms() : plain.median_ms();
    const std::string other = turned->candidate.name, with = milliseconds(on) + " ms ", without = milliseconds(off) + " ms ";
    return {line, on - off, line.needed ? with + "plain, " + without + other : with + other + ", " + without + "plain"};
  }
  if (line.needed) return {line, kUnknown, "no setting leaves it out: it is a part of the stages shade and composite"};
  return {line, kUnknown, "nothing in the scene could run it, so there is nothing to measure"};
}

}  // namespace

std::vector<PlanCost> plan_costs(const Report& report) {
  std::vector<PlanCost> list;
  for (const PlanLine& line : plan_frame(report.job.scene, plain_settings(report.knobs, report.job.settings)))
    list.push_back(cost_of(report, line));
  return list;
}

nlohmann::ordered_json plan_costs_json(const Report& report) {
  nlohmann::ordered_json out;
  for (const PlanCost& c : plan_costs(report)) {
    nlohmann::ordered_json line = {{"stage", c.line.stage}, {"needed", c.line.needed}, {"ms", nullptr}, {"how", c.how}};
    if (std::isfinite(c.ms)) line["ms"] = c.ms;
    out.push_back(line);
  }
  return out;
}

std::string plan_section(const Report& report) {
  std::string text =
      "<h2>The plan</h2>\n<p>What the plain settings of this scene need. A stage that is not needed allocates nothing and runs nothing. "
      "<i>Costs</i>: milliseconds of the median frame that go away with the stage. <i>Saves</i>: what it would cost to have it, all else equal; below "
      "zero, having it would be faster. With bounce rays, shading and shadows of what mirrors show go away, too. What is less "
      "than medians are known to, as said above, is noise.</p>\n<div class=\"wide\"><table>" +
      head({"Stage", "needed", "costs, ms", "saves, ms"});
  text.insert(text.rfind("</tr>"), "<th class=\"text\">why</th><th class=\"text\">how that was measured</th>");
  for (const PlanCost& c : plan_costs(report)) {
    char number[40] = "–";
    if (std::isfinite(c.ms)) std::snprintf(number, sizeof number, "%.2f", c.ms);
    text += "<tr>" + cell(escape_html(c.line.stage), "text") + cell(c.line.needed ? "yes" : "no", c.line.needed ? "yes" : "") +
            cell(c.line.needed ? number : "") + cell(c.line.needed ? "" : number) + cell(escape_html(c.line.reason), "text") +
            cell(escape_html(c.how), "text") + "</tr>\n";
  }
  text +=
      "</table></div>\n<h3>Not modelled</h3>\n<p>By no setting, nor by the ground truth, which is that of the renderer's model. Since nothing computes it, "
      "what it would cost cannot be measured here:</p>\n<ul>\n";
  for (const std::string& line : report.not_modelled) text += "<li>" + escape_html(line) + "</li>\n";
  return text + "</ul>\n";
}

}  // namespace spanray::demo
