// The page of the hard cases: one HTML file that needs no other, no network, no library and no script.
#include <cstdio>

#include "hard_report.h"
#include "report_data.h"
#include "report_plot.h"
#include "report_style.h"

namespace spanray::demo {
namespace {

using hard::Verdict;

constexpr const char* kHardStyle = R"css(
table.cases { width: 100%; } table.cases td, table.cases th { white-space: normal; text-align: left; vertical-align: top; padding: 5px 8px; }
table.cases td.id { font-weight: 600; white-space: nowrap; } table.cases td.verdict { font-weight: 600; white-space: nowrap; }
table.cases td.time { text-align: right; white-space: nowrap; color: var(--dim); } table.cases th.time { text-align: right; }
.pass { color: #2a7f46; } .fail { color: #c22; } tr.fail td { background: #c2222218; } .absent { color: var(--dim); }
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
                     "; random numbers have fixed seeds, so that the next run on any machine must find the same.</p>\n";
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
    text += std::string("<tr class=\"group\"><td colspan=\"6\">") + family.name + " <span>" + family.what + "</span></td></tr>\n";
    for (const HardRow& row : r.rows)
      if (row.hard_case->id[0] == family.letter[0]) text += case_row(row);
  }
  return text + "</table></div>\n";
}

std::string repeat_section() {
  std::string text = "<h2>To repeat this</h2>\n<div class=\"wide\"><table>\n";
  for (const auto& [key, value] : describe_program())
    text += "<tr><td class=\"text\">" + escape_html(key) + "</td><td class=\"text\"><code>" + escape_html(value) + "</code></td></tr>\n";
  return text +
         "</table></div>\n<p>The same numbers with every digit: <code>hard-cases.csv</code> and <code>hard-cases.json</code> beside this "
         "page. The same functions run in the test suite, with smaller counts: <code>tests/hard_cases_test.cpp</code>.</p>\n";
}

}  // namespace

std::string hard_page(const HardReport& r) {
  return std::string(
             "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" content=\"width=device-width, "
             "initial-scale=1\">\n<title>Hard cases</title>\n<style>") +
         kReportStyle + kHardStyle +
         "</style></head>\n<body>\n<h1>Hard cases</h1>\n<p class=\"dim\">Where arithmetic of renderers breaks, and what this one does there.</p>\n" +
         summary(r) + case_table(r) + repeat_section() + "</body></html>\n";
}

}  // namespace spanray::demo
