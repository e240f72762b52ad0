// The cheapest settings that keep a budget: a search over the knobs (knobs.h).
#pragma once
#include <functional>
#include <map>
#include <string>

#include "knobs.h"
#include "pareto.h"

namespace spanray::demo {

struct TuneGoal {
  bool by_time = true;  // budget is a bound on Cost::ms, and the error is to be least; else the other way around
  double budget = 0;
};

struct Tried {
  Settings settings;
  Cost cost;
};

struct Tuned {
  Settings settings;
  Cost cost;
  int tried = 0;      // settings that were measured
  bool kept = false;  // the budget; else these are the settings that came nearest to it
  std::vector<Tried> others;  // that keep the budget, too, the best first
};

// Times that differ by less are taken for equal: so near to each other, they change from run to run.
inline constexpr double kTimeNoise = 0.02;
// Errors that differ by less, too: the ground truth errs more, and chance decides which technique is the nearer to it.
inline constexpr double kErrorNoise = 0.01;

// Which of the settings that keep the budget is the best, once their times were measured again: by time the one that errs least
// of those that still keep it, by error the fastest; the first where none is better by more than noise. -1: none keeps the
// budget.
int choose_again(const std::vector<Tried>& contenders, const TuneGoal& goal);

// Measures settings: milliseconds, and an error of which less is better. Asked once for each.
using Evaluate = std::function<Result<Cost>(const Settings&)>;

// Turns one knob at a time, that which helps most, until none does. By time: from every knob at its cheapest upward, staying
// within the budget; in the end every technique is exact that can be without breaking it or erring more. By error: from every technique exact, downward; where one sample a pixel does not keep the bound, upward
// first. It finds what no single turn improves, which need not be the best of all combinations. settings: what is not a knob.
// Errors: those of `evaluate`.
Result<Tuned> tune(const std::vector<Knob>& knobs, const Settings& settings, const TuneGoal& goal, const Evaluate& evaluate);

}  // namespace spanray::demo
