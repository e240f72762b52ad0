// spanray report --hard-cases: every hard case measured, and said in a table.
#pragma once
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "hard_case.h"
#include "spanray/result.h"
#include "sweep.h"

namespace spanray::demo {

struct HardReportOptions {
  bool quick = false;
  std::vector<std::string> only;  // ids of cases and sweeps; all if empty
  std::string json;  // a file of its own, besides those of the folder; - for standard output, which then has nothing else
};

struct HardRow {
  const hard::HardCase* hard_case;
  hard::Finding finding;
  double seconds;
};

struct HardSweep {
  std::string id;
  hard::Sweep sweep;
};

struct HardReport {
  std::vector<HardRow> rows;
  std::vector<HardSweep> sweeps;  // only where a page or JSON is written
  bool quick = false;
  double seconds = 0;
  int count(hard::Verdict verdict) const;
};

// "pass", "FAIL", "not measured".
const char* verdict_word(hard::Verdict verdict);

// The page, one file that needs no other.
std::string hard_page(const HardReport& report);
// One row a case.
std::string hard_csv(const HardReport& report);
// One row a point of a curve; the bound is a curve.
std::string sweep_csv(const HardReport& report);
nlohmann::ordered_json hard_json(const HardReport& report);

// Makes the folder of a report if need be, with room for its page.
Result<void> make_report_folder(const std::string& folder, const std::string& page);

// Measures and prints row by row, then the sweeps for the page; writes into `folder` unless that is empty. The exit code: 1 where a row fails.
int run_hard_report(const HardReportOptions& options, const std::string& folder);

}  // namespace spanray::demo
