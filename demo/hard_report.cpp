#include "hard_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "core/atomic_file.h"
#include "core/number_text.h"
#include "core/timed.h"
#include "report_data.h"
#include "command.h"

namespace spanray::demo {
namespace {

namespace fs = std::filesystem;
using hard::Verdict;
using Json = nlohmann::ordered_json;

// NaN is no number of JSON.
Json number_json(double v) { return std::isfinite(v) ? Json(v) : Json(std::isnan(v) ? "nan" : "inf"); }

Result<void> write_files(const HardReport& report, const std::string& folder, const std::string& json_path) {
  const std::string json = hard_json(report).dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
  if (!json_path.empty())
    if (auto written = write_file_atomic(json_path, json); !written) return written;
  if (folder.empty()) return {};
  if (auto written = write_file_atomic(folder + "/hard-cases.csv", hard_csv(report)); !written) return written;
  if (auto written = write_file_atomic(folder + "/hard-cases.json", json); !written) return written;
  if (auto written = write_file_atomic(folder + "/hard-cases-sweeps.csv", sweep_csv(report)); !written) return written;
  return write_file_atomic(folder + "/hard-cases.html", hard_page(report));
}

void print_row(const HardRow& row) {
  const bool measured = row.finding.verdict != Verdict::kNotMeasured;
  std::printf("%-4s %-5s %s\n           %s%s\n", row.hard_case->id, measured ? verdict_word(row.finding.verdict) : "-", row.hard_case->law,
              measured ? "" : "not measured: ", row.finding.text.c_str());
  if (measured) std::printf("           bound: %s\n", row.hard_case->bound);
  std::fflush(stdout);
}

bool contains(const std::vector<std::string>& list, const std::string& id) { return std::find(list.begin(), list.end(), id) != list.end(); }

void check_ids(const std::vector<std::string>& only) {
  std::vector<std::string> ids;
  for (const hard::HardCase& hard_case : hard::hard_cases()) ids.emplace_back(hard_case.id);
  std::string sweeps;
  for (const hard::SweepCase& sweep : hard::sweep_cases()) ids.emplace_back(sweep.id), sweeps += (sweeps.empty() ? "" : ", ") + ids.back();
  for (const std::string& id : only)
    if (!contains(ids, id)) throw UsageError("--only: '" + id + "' is none of the hard cases R1 to O3, nor of the sweeps " + sweeps);
}

// Into the report, row by row onto standard output unless `silent`.
void measure(const HardReportOptions& options, bool sweeps, bool silent, HardReport& report) {
  const auto chosen = [&](const char* id) { return options.only.empty() || contains(options.only, id); };
  const hard::Effort effort{options.quick};
  for (const hard::HardCase& hard_case : hard::hard_cases()) {
    if (!chosen(hard_case.id)) continue;
    HardRow row{&hard_case, {}, 0};
    row.seconds = timed_ms([&] { row.finding = hard_case.measure(effort); }) / 1000;
    report.seconds += row.seconds;
    report.rows.push_back(row);
    if (!silent) print_row(row);
  }
  for (const hard::SweepCase& sweep : hard::sweep_cases())
    if (sweeps && chosen(sweep.id)) report.seconds += timed_ms([&] { report.sweeps.push_back({sweep.id, sweep.measure(effort)}); }) / 1000;
}

}  // namespace

int HardReport::count(Verdict verdict) const {
  return static_cast<int>(std::count_if(rows.begin(), rows.end(), [&](const HardRow& row) { return row.finding.verdict == verdict; }));
}

const char* verdict_word(Verdict verdict) {
  return verdict == Verdict::kPass ? "pass" : verdict == Verdict::kFail ? "FAIL" : "not measured";
}

std::string hard_csv(const HardReport& report) {
  std::string text = "id,verdict,measured,bound,unit,checked,seconds,law,bound_text,finding\n";
  for (const HardRow& row : report.rows) {
    const hard::Finding& f = row.finding;
    const bool measured = f.verdict != Verdict::kNotMeasured;
    text += std::string(row.hard_case->id) + "," + verdict_word(f.verdict) + "," + (measured ? number_text(f.measured) : "") + "," +
            (measured ? number_text(f.bound) : "") + "," + quoted(f.unit) + "," + (measured ? std::to_string(f.checked) : "") + "," +
            number_text(row.seconds) + "," + quoted(row.hard_case->law) + "," + quoted(row.hard_case->bound) + "," + quoted(f.text) + "\n";
  }
  return text;
}

std::string sweep_csv(const HardReport& report) {
  std::string text = "sweep,x_name,y_name,curve,x,y\n";
  for (const HardSweep& sweep : report.sweeps) {
    const hard::Sweep& s = sweep.sweep;
    const auto rows = [&](const std::string& name, const std::vector<double>& y) {
      for (size_t i = 0; i < y.size(); ++i)
        text += sweep.id + "," + quoted(s.x_name) + "," + quoted(s.y_name) + "," + quoted(name) + "," + number_text(s.x[i]) + "," +
                (std::isnan(y[i]) ? "" : number_text(y[i])) + "\n";
    };
    for (const hard::Curve& c : s.curves) rows(c.name, c.y);
    if (!s.bound_name.empty()) rows(s.bound_name, s.bound);
  }
  return text;
}

Json hard_json(const HardReport& report) {
  Json out;
  for (const auto& [key, value] : describe_program()) out["about"][key] = value;
  out["quick"] = report.quick, out["seconds"] = report.seconds;
  out["pass"] = report.count(Verdict::kPass), out["fail"] = report.count(Verdict::kFail);
  out["not_measured"] = report.count(Verdict::kNotMeasured);
  for (const HardRow& row : report.rows) {
    const hard::Finding& f = row.finding;
    Json r = {{"id", row.hard_case->id}, {"law", row.hard_case->law}, {"verdict", verdict_word(f.verdict)}, {"finding", f.text}};
    if (f.verdict != Verdict::kNotMeasured) {
      r["measured"] = number_json(f.measured), r["bound"] = f.bound, r["bound_text"] = row.hard_case->bound;
      r["unit"] = f.unit, r["checked"] = f.checked, r["seconds"] = row.seconds;
    }
    out["rows"].push_back(r);
  }
  for (const HardSweep& sweep : report.sweeps) {
    const hard::Sweep& s = sweep.sweep;
    Json j = {{"id", sweep.id}, {"title", s.title}, {"what", s.what}, {"x_name", s.x_name}, {"y_name", s.y_name}, {"x", s.x}};
    for (const hard::Curve& c : s.curves) {
      Json values = Json::array();
      for (const double y : c.y) values.push_back(number_json(y));
      j["curves"].push_back({{"name", c.name}, {"ours", c.ours}, {"y", values}});
    }
    if (!s.bound_name.empty()) j["bound_name"] = s.bound_name, j["bound"] = s.bound;
    out["sweeps"].push_back(j);
  }
  return out;
}

Result<void> make_report_folder(const std::string& folder, const std::string& page) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error || !fs::is_directory(folder))
    return Error{"cannot make this folder: " + (error ? error.message() : std::string("it is a file")), folder};
  return check_writable(folder + "/" + page);
}

int run_hard_report(const HardReportOptions& options, const std::string& folder) {
  check_ids(options.only);
  if (!folder.empty())
    if (auto made = make_report_folder(folder, "hard-cases.html"); !made) return fail(made.error());
  const bool to_stdout = options.json == "-";
  if (!options.json.empty() && !to_stdout)
    if (auto room = check_writable(options.json); !room) return fail(room.error());
  HardReport report;
  report.quick = options.quick;
  measure(options, !folder.empty() || !options.json.empty(), to_stdout, report);
  if (auto written = write_files(report, folder, to_stdout ? "" : options.json); !written) return fail(written.error());
  if (to_stdout) {
    std::printf("%s\n", hard_json(report).dump(2, ' ', false, Json::error_handler_t::replace).c_str());
  } else {
    std::printf("%d pass, %d fail, %d not measured; %.0f s\n", report.count(Verdict::kPass), report.count(Verdict::kFail),
                report.count(Verdict::kNotMeasured), report.seconds);
    if (!folder.empty()) std::printf("%s/hard-cases.html\n", folder.c_str());
  }
  return report.count(Verdict::kFail) == 0 ? kDone : kCouldNot;
}

}  // namespace spanray::demo
