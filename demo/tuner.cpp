#include "tuner.h"

#include <algorithm>

#include "job.h"

namespace spanray::demo {
namespace {

bool errs_less(const Cost& a, const Cost& b) { return a.error != b.error ? a.error < b.error : a.ms < b.ms; }
bool faster(const Cost& a, const Cost& b) { return a.ms != b.ms ? a.ms < b.ms : a.error < b.error; }

class Search {
 public:
  Search(const std::vector<Knob>& knobs, const Evaluate& evaluate) : knobs_(knobs), evaluate_(evaluate) {}

  // Starts at these settings. False: they could not be measured, and error() says why.
  bool start(const Settings& settings) {
    const Cost* cost = measured(settings);
    if (cost == nullptr) return false;
    best_ = settings, cost_ = *cost;
    return true;
  }
  // Takes the turn that is `before` all others and where it stands, of those that are `allowed`; again and again while there is one. It
  // ends: no settings are taken twice.
  template <class Allowed, class Before>
  bool climb(const Allowed& allowed, const Before& before) {
    for (bool moved = true; moved;) {
      moved = false;
      const Settings from = best_;
      const Cost was = cost_;
      for (const Knob& knob : knobs_) {
        if (!knob.absent.empty()) continue;
        for (const KnobChoice& choice : knob.choices) {
          Settings turned = from;
          choice.set(turned);
          const Cost* cost = measured(turned);
          if (cost == nullptr) return false;
          if (!allowed(*cost, was) || !before(*cost, cost_)) continue;
          best_ = turned, cost_ = *cost, moved = true;
        }
      }
    }
    return true;
  }
  // Turns every knob to its exact choice that keeps the budget of time and errs no more, but for noise.
  bool prefer_exact(double most_ms) {
    const double most_error = cost_.error * (1 + kErrorNoise);
    for (const Knob& knob : knobs_) {
      if (!knob.absent.empty()) continue;
      Settings exact = best_;
      knob.choices[knob.exact].set(exact);
      const Cost* cost = measured(exact);
      if (cost == nullptr) return false;
      if (cost->ms <= most_ms && cost->error <= most_error) best_ = exact, cost_ = *cost;
    }
    return true;
  }
  const Cost& cost() const { return cost_; }
  const Error& error() const { return error_; }
  Tuned result(const TuneGoal& goal, bool kept) const {
    Tuned tuned{best_, cost_, static_cast<int>(known_.size()), kept, {}};
    for (const auto& [key, tried] : known_)
      if ((goal.by_time ? tried.cost.ms : tried.cost.error) <= goal.budget && !same_settings(tried.settings, best_))
        tuned.others.push_back(tried);
    const auto before = goal.by_time ? errs_less : faster;
    std::stable_sort(tuned.others.begin(), tuned.others.end(),
                     [&](const Tried& a, const Tried& b) { return before(a.cost, b.cost); });
    return tuned;
  }

 private:
  const Cost* measured(const Settings& settings) {
    std::string key;
    for (const auto& [name, value] : settings_words(settings)) key += name + "=" + value + " ";
    if (const auto found = known_.find(key); found != known_.end()) return &found->second.cost;
    const Result<Cost> cost = evaluate_(settings);
    if (!cost) return error_ = cost.error(), nullptr;
    return &known_.emplace(key, Tried{settings, cost.value()}).first->second.cost;
  }

  const std::vector<Knob>& knobs_;
  const Evaluate& evaluate_;
  std::map<std::string, Tried> known_;
  Settings best_;
  Cost cost_;
  Error error_;
};

}  // namespace

int choose_again(const std::vector<Tried>& contenders, const TuneGoal& goal) {
  int best = -1;
  for (size_t i = 0; i < contenders.size(); ++i) {
    const Cost& cost = contenders[i].cost;
    if ((goal.by_time ? cost.ms : cost.error) > goal.budget) continue;
    const Cost* const before = best < 0 ? nullptr : &contenders[static_cast<size_t>(best)].cost;
    const bool better =
        before == nullptr ||
        (goal.by_time ? cost.error < (1 - kErrorNoise) * before->error : cost.ms < (1 - kTimeNoise) * before->ms);
    if (better) best = static_cast<int>(i);
  }
  return best;
}

Result<Tuned> tune(const std::vector<Knob>& knobs, const Settings& settings, const TuneGoal& goal, const Evaluate& evaluate) {
  Search search(knobs, evaluate);
  const double budget = goal.budget;
  if (goal.by_time) {
    if (!search.start(cheapest_settings(knobs, settings))) return search.error();
    // Techniques that cost most where they are useless (textures off are no faster everywhere): the way down comes first.
    if (search.cost().ms > budget &&
        !search.climb([=](const Cost& c,
                          const Cost& was) { return was.ms > budget && (c.ms <= budget || c.ms < (1 - kTimeNoise) * was.ms); },
                      faster))
      return search.error();
    if (search.cost().ms > budget) return search.result(goal, false);
    if (!search.climb([&](const Cost& c, const Cost& was) { return c.ms <= budget && c.error < was.error; }, errs_less))
      return search.error();
    if (!search.prefer_exact(budget)) return search.error();
    return search.result(goal, true);
  }
  if (!search.start(plain_settings(knobs, settings))) return search.error();
  if (search.cost().error > budget &&
      !search.climb([&](const Cost& c, const Cost& was) { return was.error > budget && c.error < was.error; }, errs_less))
    return search.error();
  if (search.cost().error > budget) return search.result(goal, false);
  if (!search.climb([&](const Cost& c, const Cost& was) { return c.error <= budget && c.ms < (1 - kTimeNoise) * was.ms; },
                    faster))
    return search.error();
  return search.result(goal, true);
}

}  // namespace spanray::demo
