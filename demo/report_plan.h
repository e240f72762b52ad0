// What the plan of a scene costs, and what it saves.
#pragma once
#include <string>
#include <vector>

#include "report_data.h"

namespace spanray::demo {

// A stage of the plain settings' plan with its price, where settings that were measured tell it.
struct PlanCost {
  PlanLine line;
  // Milliseconds of the median frame: of a stage that is needed, what it costs; of one that is not, what it would cost more to run it. NaN:
  // nothing was measured that tells it.
  double ms = 0;
  std::string how;  // of what the number was made, or why there is none
};

std::vector<PlanCost> plan_costs(const Report& report);

// The section of the page: the plan, its prices, what is not modelled. HTML.
std::string plan_section(const Report& report);
// plan_costs as JSON; `ms` is null where nothing tells it.
nlohmann::ordered_json plan_costs_json(const Report& report);

}  // namespace spanray::demo
