// The knobs of speed against error: one table, which `report` walks. A technique joins by a line there, or, where it is one more word of
// an enum of settings.h, by itself.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "spanray/render.h"

namespace spanray::demo {

struct KnobChoice {
  std::string word;  // as the command line has it
  std::function<void(Settings&)> set;
};

struct Knob {
  std::string name;   // of the option, without dashes
  std::string what;   // what it decides, for people
  std::vector<KnobChoice> choices;  // cheapest first
  size_t exact = 0;   // the choice that errs least: what the ground truth takes, and all other knobs are measured with
  size_t plain = 0;   // what other knobs are measured with; `exact` but for anti-aliasing, which would hide what they do
  std::string absent; // why the scene has no use for it; empty if it has
};

// All knobs, those included that the scene has no use for. settings: what is not a knob (size, culling), and how many bounces there may be.
std::vector<Knob> make_knobs(const Scene& scene, const Settings& settings);

// One setting to be measured.
struct Candidate {
  std::string id;      // for file names: shadows-none
  std::string name;    // for people: shadows none
  std::string group;   // the knob that was turned from the plain settings; "ladder" for steps from all that is cheap to all that is exact
  Settings settings;
  std::string preset;  // of presets.h that asks for the same on this scene; else empty
};

// Settings with every knob at its plain, or its exact choice.
Settings plain_settings(const std::vector<Knob>& knobs, Settings settings);
Settings exact_settings(const std::vector<Knob>& knobs, Settings settings);
// Every knob that the scene has a use for at its cheapest, the others plain.
Settings cheapest_settings(const std::vector<Knob>& knobs, Settings settings);
// First the plain settings; then each choice of each useful knob by itself; then the presets that are none of these, then the
// ladder. No settings twice.
std::vector<Candidate> make_candidates(const std::vector<Knob>& knobs, const Settings& settings);

// Whether both ask for the same picture by the same way.
bool same_settings(const Settings& a, const Settings& b);

}  // namespace spanray::demo
