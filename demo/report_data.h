// What a report says, as data: JSON and CSV. The page (report_page.h) prints the same numbers.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "report_mask.h"
#include "trade.h"

namespace spanray::demo {

struct Report {
  std::string scene_path, command;
  Job job;
  TradeOptions options;
  std::vector<Knob> knobs;
  Trade trade;
  ReportMask mask;             // of the plain setting
  std::vector<int> dominated;  // by FLIP and median time: dominated_by of each setting
  std::vector<std::string> not_modelled;
  std::vector<std::pair<std::string, std::string>> machine;  // machine, compiler, contract, ...: enough to repeat it
};

// "max 3 of 255, p99.9 ...": every metric, for people.
std::string metrics_text(const Metrics& metrics);

// The error that settings are ranked by.
inline constexpr double Metrics::*kRankedBy = &Metrics::flip;

std::vector<Cost> costs(const Report& report);
// One row a setting: names, times of each stage, every metric, wrong ids, who dominates it.
std::string report_csv(const Report& report);
nlohmann::ordered_json report_json(const Report& report);

// What the scene asks for that no setting of this renderer gives, in words.
std::vector<std::string> find_not_modelled(const Job& job);
// Of the machine, the program and the command: of any report, and of this one.
std::vector<std::pair<std::string, std::string>> describe_program();
std::vector<std::pair<std::string, std::string>> describe_machine(const Report& report);
// A field of a CSV file.
std::string quoted(const std::string& text);
// The command line of this process, for a POSIX shell.
std::string command_line();

}  // namespace spanray::demo
