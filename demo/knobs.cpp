#include "knobs.h"

#include <algorithm>

#include "job.h"
#include "presets.h"
#include "spanray/settings_text.h"

namespace spanray::demo {
namespace {

template <class E>
std::vector<KnobChoice> words_of(E Settings::*field) {
  std::vector<KnobChoice> choices;
  for (const EnumName<E>& entry : enum_names<E>())
    choices.push_back({entry.name, [field, value = entry.value](Settings& s) { s.*field = value; }});
  return choices;
}

std::vector<KnobChoice> switch_of(bool Settings::*field) {
  return {{"off", [field](Settings& s) { s.*field = false; }}, {"on", [field](Settings& s) { s.*field = true; }}};
}

std::vector<KnobChoice> reflection_choices(int max_bounces) {
  std::vector<KnobChoice> choices = {{"none", [](Settings& s) { s.reflections = Reflections::kNone; }}};
  for (int n = 1; n <= max_bounces; n = n < 4 || n == max_bounces ? n + 1 : std::min(2 * n, max_bounces))
    choices.push_back({n == 1 ? "1 bounce" : std::to_string(n) + " bounces",
                       [n](Settings& s) { s.reflections = Reflections::kRay, s.max_bounces = n; }});
  return choices;
}

std::vector<KnobChoice> sample_choices() {
  std::vector<KnobChoice> choices = {
      {"1 sample", [](Settings& s) { s.samples = 1, s.antialiasing = Antialiasing::kMultisample; }}};
  for (const Antialiasing how : {Antialiasing::kMultisample, Antialiasing::kSupersample})
    for (const int count : kSampleCounts)
      if (count > 1)
        choices.push_back({std::string(enum_text(how)) + " " + std::to_string(count),
                           [=](Settings& s) { s.samples = count, s.antialiasing = how; }});
  return choices;
}

// Why the plan needs none of these stages; empty if it needs one.
std::string absent(const std::vector<PlanLine>& plan, std::initializer_list<const char*> stages) {
  std::string reason;
  for (const char* stage : stages)
    for (const PlanLine& line : plan)
      if (line.stage == stage) {
        if (line.needed) return "";
        if (reason.find(line.reason) == std::string::npos) reason += (reason.empty() ? "" : "; ") + line.reason;
      }
  return reason;
}

std::string slug(const std::string& text) {
  std::string out;
  for (const char c : text) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
    if (plain || (!out.empty() && out.back() != '-')) out += plain ? c : '-';
  }
  return out;
}

Settings with(const std::vector<Knob>& knobs, Settings settings, size_t Knob::*choice) {
  for (const Knob& knob : knobs) knob.choices[knob.*choice].set(settings);
  return settings;
}

void add(std::vector<Candidate>& list, const std::string& id, const std::string& name, const std::string& group,
         const Settings& settings) {
  for (const Candidate& known : list)
    if (same_settings(known.settings, settings)) return;
  list.push_back({slug(id), name, group, settings, ""});
}

// What knobs without a use would do stays away.
void add_presets(std::vector<Candidate>& list, const std::vector<Knob>& knobs, const Settings& plain) {
  for (const Preset& preset : kPresets) {
    Settings settings = plain;
    preset.set(settings);
    for (const Knob& knob : knobs)
      if (!knob.absent.empty()) knob.choices[knob.plain].set(settings);
    add(list, std::string("preset ") + preset.name, std::string("preset ") + preset.name, "preset", settings);
    for (Candidate& candidate : list)
      if (same_settings(candidate.settings, settings)) candidate.preset = preset.name;
  }
}

// All that is cheap; then one knob after the other at its exact choice, in order of the table.
void add_ladder(std::vector<Candidate>& list, const std::vector<Knob>& knobs, Settings settings) {
  settings = cheapest_settings(knobs, settings);
  add(list, "draft", "draft: every technique at its cheapest", "ladder", settings);
  std::string exact;
  for (const Knob& knob : knobs) {
    if (!knob.absent.empty() || knob.exact == 0) continue;
    knob.choices[knob.exact].set(settings);
    exact += " + " + knob.name;
    add(list, "draft" + exact, "draft" + exact, "ladder", settings);
  }
}

}  // namespace

bool same_settings(const Settings& a, const Settings& b) { return settings_words(a) == settings_words(b); }

std::vector<Knob> make_knobs(const Scene& scene, const Settings& settings) {
  Settings all = settings;  // the plan of a frame that asks for everything
  all.shading = Shading::kPhong, all.shadows = Shadows::kRay, all.reflections = Reflections::kRay,
  all.max_bounces = std::max(1, settings.max_bounces);
  all.transparency = Transparency::kScene, all.textures = all.bump = true;
  // These are stages where they are cheap.
  all.normals = Normals::kInterpolated, all.powers = Powers::kFast, all.shading_rate = ShadingRate::k2x2;
  all.shadow_terminator = ShadowTerminator::kLifted;
  all.antialiasing = Antialiasing::kMultisample;
  const std::vector<PlanLine> plan = plan_frame(scene, all);
  std::vector<Knob> knobs;
  const auto add_knob = [&](const char* name, const char* what, std::vector<KnobChoice> choices, const std::string& exact,
                            std::string why_absent) {
    const auto found = std::find_if(choices.begin(), choices.end(), [&](const KnobChoice& c) { return c.word == exact; });
    const size_t at = static_cast<size_t>(found - choices.begin());
    knobs.push_back({name, what, std::move(choices), at, at, std::move(why_absent)});
  };
  const std::vector<KnobChoice> bounces = reflection_choices(all.max_bounces), samples = sample_choices();
  add_knob("textures", "color and value maps", switch_of(&Settings::textures), "on", absent(plan, {"textures"}));
  add_knob("filter", "how textures are read", words_of(&Settings::filter), "trilinear", absent(plan, {"textures", "bump"}));
  add_knob("shading", "where light is computed: once a face, at its corners, in every pixel", words_of(&Settings::shading),
           "phong", absent(plan, {"direct light"}));
  add_knob("normals", "normals between the corners of a triangle: as interpolated, or made unit vectors again",
           words_of(&Settings::normals), "renormalized", absent(plan, {"normals as interpolated"}));
  add_knob("powers", "the power in highlights", words_of(&Settings::powers), "exact", absent(plan, {"fast powers"}));
  add_knob("shading-rate", "squares of 2x2 pixels that see one surface: shaded once, with their rays, or pixel by pixel",
           words_of(&Settings::shading_rate), "1x1", absent(plan, {"shading rate 2x2"}));
  add_knob("shadows", "how shadows are found", words_of(&Settings::shadows), "ray", absent(plan, {"shadow rays"}));
  // What the scene asks for is the truth, as of transparency: off is what the triangles say, lifted what their normals say.
  add_knob("shadow-terminator", "the edge of light on coarse meshes with smooth normals: of the triangles, or of what the normals describe",
           words_of(&Settings::shadow_terminator), std::string(enum_text(settings.shadow_terminator)),
           absent(plan, {"lifted shadow rays"}));
  add_knob("reflections", "what mirrors show", bounces, bounces.back().word, absent(plan, {"bounce rays"}));
  add_knob("bump", "height and normal maps", switch_of(&Settings::bump), "on", absent(plan, {"bump"}));
  // What the scene asks for is the truth: the others are another look.
  std::vector<KnobChoice> blends = words_of(&Settings::transparency);  // scene, which blends all layers, comes first there
  std::rotate(blends.begin(), blends.begin() + 1, blends.end());
  add_knob("transparency", "surfaces that let light through", std::move(blends), "scene",
           absent(plan, {"composite", "accept masks"}));
  add_knob("visibility", "the engine that finds what each pixel sees", words_of(&Settings::visibility), "raster",
           absent(plan, {"transform, clip, bin, raster", "primary rays"}));
  add_knob("samples", "anti-aliasing: samples a pixel; a surface is shaded once a pixel (multisample) or in every sample",
           samples, samples.back().word, scene.triangle_count() > 0 ? "" : "the scene has no triangle");
  knobs.back().plain = 0;
  return knobs;
}

Settings plain_settings(const std::vector<Knob>& knobs, Settings settings) { return with(knobs, settings, &Knob::plain); }
Settings exact_settings(const std::vector<Knob>& knobs, Settings settings) { return with(knobs, settings, &Knob::exact); }

Settings cheapest_settings(const std::vector<Knob>& knobs, Settings settings) {
  settings = plain_settings(knobs, settings);
  for (const Knob& knob : knobs)
    if (knob.absent.empty()) knob.choices[0].set(settings);
  return settings;
}

std::vector<Candidate> make_candidates(const std::vector<Knob>& knobs, const Settings& settings) {
  std::vector<Candidate> list;
  const Settings plain = plain_settings(knobs, settings);
  add(list, "plain", "plain: every technique exact, 1 sample", "plain", plain);
  for (const Knob& knob : knobs) {
    if (!knob.absent.empty()) continue;
    for (const KnobChoice& choice : knob.choices) {
      Settings turned = plain;
      choice.set(turned);
      add(list, knob.name + "-" + choice.word, knob.name + ": " + choice.word, knob.name, turned);
    }
  }
  add_presets(list, knobs, plain);
  add_ladder(list, knobs, settings);
  return list;
}

}  // namespace spanray::demo
