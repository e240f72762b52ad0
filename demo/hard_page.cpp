// The page of the hard cases: one HTML file that needs no other, no network, no library and no script.
#include <algorithm>
#include <cstdio>

#include "hard_report.h"
#include "report_data.h"
#include "report_plot.h"
#include "report_style.h"
#include "sweep_plot.h"

namespace spanray::demo {
namespace {

using hard::Verdict;

constexpr const char* kHardStyle = R"css(
table.cases { width: 100%; } table.cases td, table.cases th { white-space: normal; text-align: left; vertical-align: top; padding: 5px 8px; }
table.cases td.id { font-weight: 600; white-space: nowrap; } table.cases td.verdict { font-weight: 600; white-space: nowrap; }
table.cases td.time { text-align: right; white-space: nowrap; color: var(--dim); } table.cases th.time { text-align: right; }
.pass { color: #2a7f46; } .fail { color: #c22; } tr.fail td { background: #c2222218; } .absent { color: var(--dim); }
svg.sweep text { font-size: 14px; } svg.sweep circle { cursor: default; } .sweep path, .legend path { fill: none; stroke-width: 2; }
.sweep .c0, .legend .c0 { stroke: var(--best); stroke-width: 3; } circle.c0 { fill: var(--best); }
.sweep .c1, .legend .c1 { stroke: #2f7ed8; } circle.c1 { fill: #2f7ed8; } .sweep .c2, .legend .c2 { stroke: #c77700; stroke-dasharray: 9 5; } circle.c2 { fill: #c77700; }
.sweep .c3, .legend .c3 { stroke: #7a8a99; stroke-dasharray: 3 5; } circle.c3 { fill: #7a8a99; } .bound { stroke: var(--ink); stroke-dasharray: 7 5; }
.sweep circle { stroke-width: 0; } .legend { list-style: none; padding: 0 0 0 84px; margin: 0 0 8px; max-width: none; } .legend svg { width: 34px; height: 12px; vertical-align: middle; }
@media (prefers-color-scheme: dark) { .pass { color: #6ecf8e; } .fail { color: #ff7b72; } }
)css";

struct Family { const char *letter, *name, *what; };
constexpr Family kFamilies[] = {
    {"R", "Raster", "coverage in exact integers, clipping in double"},
    {"D", "Depth", "reversed z in float, from a plane set up in double"},
    {"I", "Interpolation and texture", "against long double on the original triangle"},
    {"S", "Shading", "at the edges of its domain"},
    {"Y", "Rays", "watertight, and without epsilons"},
    {"T", "Transparency", "layers, masks, edges"},
    {"O", "Output", "sRGB bytes"},
};

std::string seconds_text(double s) {
  char text[40];
  std::snprintf(text, sizeof text, "%.2f", s);
  return text;
}

std::string summary(const HardReport& r) {
  const int pass = r.count(Verdict::kPass), fail = r.count(Verdict::kFail), absent = r.count(Verdict::kNotMeasured);
  std::string text = "<p><b class=\"pass\">" + std::to_string(pass) + " hold</b>, <b class=\"" + (fail > 0 ? "fail" : "dim") + "\">" +
                     std::to_string(fail) + (fail == 1 ? " fails" : " fail") + "</b>, " + std::to_string(absent) +
                     " are not measured, each with its reason. Every figure was computed when this page was made, in " +
                     seconds_text(r.seconds) + " s" + (r.quick ? ", with the small counts of <code>--quick</code>" : "") +
                     "; random numbers have fixed seeds, so that the next run finds the same.</p>\n";
  if (fail > 0) text += "<p class=\"warn\">A row that fails is a defect of this version: it is shown, not left out.</p>\n";
  return text;
}

std::string case_row(const HardRow& row) {
  const hard::Finding& f = row.finding;
  const bool measured = f.verdict != Verdict::kNotMeasured;
  const char* const kind = f.verdict == Verdict::kPass ? "pass" : measured ? "fail" : "absent";
  return std::string("<tr") + (f.verdict == Verdict::kFail ? " class=\"fail\"" : "") + "><td class=\"id\">" + row.hard_case->id + "</td><td>" +
         escape_html(row.hard_case->law) + "</td><td" + (measured ? "" : " class=\"absent\"") + ">" + escape_html(f.text) + "</td><td>" +
         (measured ? escape_html(row.hard_case->bound) : "–") + "</td><td class=\"verdict " + kind + "\">" + verdict_word(f.verdict) +
         "</td><td class=\"time\">" + (measured ? seconds_text(row.seconds) : "–") + "</td></tr>\n";
}

std::string case_table(const HardReport& r) {
  std::string text =
      "<div class=\"wide\"><table class=\"cases\"><tr><th>Case</th><th>What must hold</th><th>Measured</th><th>Bound</th><th>Verdict</th>"
      "<th class=\"time\">s</th></tr>\n";
  for (const Family& family : kFamilies) {
    if (std::none_of(r.rows.begin(), r.rows.end(), [&](const HardRow& row) { return row.hard_case->id[0] == family.letter[0]; })) continue;
    text += std::string("<tr class=\"group\"><td colspan=\"6\">") + family.name + " <span>" + family.what + "</span></td></tr>\n";
    for (const HardRow& row : r.rows)
      if (row.hard_case->id[0] == family.letter[0]) text += case_row(row);
  }
  return text + "</table></div>\n";
}

std::string sweep_section(const HardReport& r) {
  if (r.sweeps.empty()) return "";
  std::string text =
      "<h2>Why the contract says what it says</h2>\n<p>Error curves over scale, distance, angle and shape: this renderer, beside what others do, "
      "written for this page from the sources that are named in <code>demo/hard_cases/rivals.h</code>. Both axes are logarithmic; a value of 0 stands on "
      "the line at the bottom. Pointing at a mark shows its value.</p>\n";
  for (const HardSweep& s : r.sweeps)
    text += "<h3>" + escape_html(s.sweep.title) + "</h3>\n<p>" + escape_html(s.sweep.what) + "</p>\n" + sweep_plot(s.sweep);
  return text;
}

std::string repeat_section() {
  std::string text = "<h2>To repeat this</h2>\n<div class=\"wide\"><table>\n";
  for (const auto& [key, value] : describe_program())
    text += "<tr><td class=\"text\">" + escape_html(key) + "</td><td class=\"text\"><code>" + escape_html(value) + "</code></td></tr>\n";
  return text +
         "</table></div>\n<p>The same numbers with every digit: <code>hard-cases.csv</code>, <code>hard-cases-sweeps.csv</code> and <code>hard-cases.json</code> beside this "
         "page. The same functions run in the test suite, with smaller counts: <code>tests/hard_cases_test.cpp</code>.</p>\n";
}

}  // namespace

std::string hard_page(const HardReport& r) {
  return std::string(
             "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" content=\"width=device-width, "
             "initial-scale=1\">\n<title>Hard cases</title>\n<style>") +
         kReportStyle + kHardStyle +
         "</style></head>\n<body>\n<h1>Hard cases</h1>\n<p class=\"dim\">Where arithmetic of renderers breaks, and what this one does there.</p>\n" +
         summary(r) + case_table(r) + sweep_section(r) + repeat_section() + "</body></html>\n";
}

}  // namespace spanray::demo
