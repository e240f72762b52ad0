#include "panel.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "core/parallel.h"
#include "simd/isa.h"
#include "spanray/settings_text.h"
#include "stage_times.h"
#include "visitor.h"

namespace spanray::demo {
namespace {

constexpr float kMargin = 8, kWidth = 392, kLeastWidth = 200, kLabels = 104, kNarrowLabels = 99;
constexpr float kLeastHelpWidth = 240, kLowWindow = 480;
constexpr ImU32 kAmber = IM_COL32(240, 176, 82, 255), kDark = IM_COL32(24, 22, 18, 255), kBar = IM_COL32(92, 138, 176, 255),
                kTrack = IM_COL32(34, 38, 44, 255);

ImVec2 screen() { return ImGui::GetIO().DisplaySize; }

// With its margin at most two fifths of the window, so that the picture stays in sight.
float panel_width() { return std::clamp(std::floor(0.4f * screen().x) - kMargin, std::min(kLeastWidth, screen().x), kWidth); }
float labels() { return panel_width() < kWidth ? kNarrowLabels : kLabels; }
// Where help begins: right of the panel if that is open.
float help_left(bool panel) { return panel ? kMargin + panel_width() : 0; }

// Goes on below itself where it does not fit.
void muted(const char* text) {
  ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyle().Colors[ImGuiCol_TextDisabled]);
  ImGui::TextUnformatted(text);
  ImGui::PopStyleColor();
}

void label(const char* text) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextDisabled("%s", text);
  ImGui::SameLine(labels());
}

// A button of a row of choices; goes to the next line where it does not fit. True if it was clicked.
bool choice(const char* text, bool chosen, bool first) {
  const float width = ImGui::CalcTextSize(text).x + 2 * ImGui::GetStyle().FramePadding.x;
  if (!first) {
    // With a scroll bar or without: rows must not jump when it comes.
    const float right = ImGui::GetWindowPos().x + panel_width() - ImGui::GetStyle().WindowPadding.x - ImGui::GetStyle().ScrollbarSize;
    if (ImGui::GetItemRectMax().x + 2 + width <= right)
      ImGui::SameLine(0, 2);
    else
      ImGui::SetCursorPosX(labels());
  }
  if (chosen) {
    for (const int color : {ImGuiCol_Button, ImGuiCol_ButtonHovered, ImGuiCol_ButtonActive}) ImGui::PushStyleColor(color, kAmber);
    ImGui::PushStyleColor(ImGuiCol_Text, kDark);
  }
  const bool clicked = ImGui::Button(text);
  if (chosen) ImGui::PopStyleColor(4);
  return clicked;
}

template <class E> bool enum_row(const char* name, E& value, bool (*usable)(E) = nullptr) {
  bool changed = false, first = true;
  ImGui::PushID(name);
  label(name);
  for (const EnumName<E>& entry : enum_names<E>()) {
    if (usable != nullptr && !usable(entry.value)) continue;
    if (choice(entry.name, value == entry.value, first) && value != entry.value) value = entry.value, changed = true;
    first = false;
  }
  ImGui::PopID();
  return changed;
}

bool on_off(const char* name, bool& value, bool first) {
  if (!choice(name, value, first)) return false;
  value = !value;
  return true;
}

bool number_row(const char* name, int& value, int low, int high, const char* format) {
  ImGui::PushID(name);
  label(name);
  ImGui::SetNextItemWidth(-1);
  const bool changed = ImGui::SliderInt("##value", &value, low, high, format, ImGuiSliderFlags_NoInput | ImGuiSliderFlags_AlwaysClamp);
  ImGui::PopID();
  return changed;
}

bool samples_row(int& samples) {
  bool changed = false;
  ImGui::PushID("samples");
  label("samples");
  for (const int count : kSampleCounts)
    if (choice(std::to_string(count).c_str(), samples == count, count == 1) && samples != count) samples = count, changed = true;
  ImGui::PopID();
  return changed;
}

bool draw_switches(WalkSession& session) {
  Settings& s = session.settings();
  bool changed = false, first = true;
  label("view");
  for (const ViewWord& word : view_words()) {
    if (choice(word.name, session.view() == word.view, first)) session.view() = word.view, changed = true;
    first = false;
  }
  changed |= enum_row("shading", s.shading);
  changed |= enum_row("shadows", s.shadows);
  changed |= enum_row("reflections", s.reflections);
  changed |= number_row("bounces", s.max_bounces, 0, 8, "%d");
  changed |= enum_row("visibility", s.visibility);
  changed |= enum_row("filter", s.filter);
  changed |= enum_row("transparency", s.transparency);
  changed |= enum_row("culling", s.culling);
  changed |= enum_row("normals", s.normals);
  changed |= enum_row("powers", s.powers);
  changed |= enum_row("shading rate", s.shading_rate);
  changed |= enum_row("terminator", s.shadow_terminator);
  changed |= samples_row(s.samples);
  if (s.samples > 1) changed |= enum_row("antialiasing", s.antialiasing);
  label("maps");
  changed |= on_off("textures", s.textures, true);
  changed |= on_off("bump", s.bump, false);
  label("walls");
  on_off("stop you", session.walls(), true);
  changed |= number_row("threads", s.threads, 0, Parallel::available(), s.threads == 0 ? "one per processor" : "%d");
  changed |= enum_row<Isa>("instructions", s.isa, [](Isa isa) { return isa == Isa::kAuto || isa_supported(isa); });
  return changed;
}

// The median of each stage over the last frames, as bars of the frame's own.
void draw_times(const WalkSession& session) {
  const std::vector<StageTimes>& recent = session.recent();
  if (recent.empty()) return;
  const auto middle = [&recent](double StageTimes::*time) {
    std::vector<double> values;
    for (const StageTimes& t : recent) values.push_back(t.*time);
    return median(std::move(values));
  };
  const double frame = middle(&StageTimes::frame);
  const FrameStats& stats = session.shown().stats;
  ImGui::Text("%.1f ms", frame);
  ImGui::SameLine(labels());
  ImGui::Text("%.1f frames/s", frame > 0 ? 1000 / frame : 0.0);
  char text[160];
  std::snprintf(text, sizeof text, "%dx%d, %s, %d thread%s; median of %zu frame%s", session.shown().picture.width,
                session.shown().picture.height, stats.isa.c_str(), stats.threads, stats.threads == 1 ? "" : "s", recent.size(),
                recent.size() == 1 ? "" : "s");
  muted(text);
  ImGui::Spacing();
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  for (const auto& stage : kStages) {
    const double ms = middle(stage.time);
    if (stage.time == &StageTimes::frame || stage.time == &StageTimes::bvh_build) continue;
    const bool of_motion = stage.time == &StageTimes::pose || stage.time == &StageTimes::bvh_refit;
    if (of_motion && session.scene().data().motions.empty()) continue;
    ImGui::TextDisabled("%s", stage.name);
    std::snprintf(text, sizeof text, "%8.2f", ms);
    ImGui::SameLine(labels() - 12);
    ImGui::TextUnformatted(text);
    ImGui::SameLine(labels() + 56);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float whole = ImGui::GetContentRegionAvail().x, height = ImGui::GetTextLineHeight() - 4;
    const float part = frame > 0 ? static_cast<float>(std::clamp(ms / frame, 0.0, 1.0)) * whole : 0;
    draw.AddRectFilled({at.x, at.y + 2}, {at.x + whole, at.y + 2 + height}, kTrack);
    if (part >= 1) draw.AddRectFilled({at.x, at.y + 2}, {at.x + part, at.y + 2 + height}, kBar);
    ImGui::Dummy({whole, ImGui::GetTextLineHeight()});
  }
  if (!(stats.ms.bvh_build > 0)) return;
  std::snprintf(text, sizeof text, "trees for rays: %.0f ms, once; not part of a frame", stats.ms.bvh_build);
  muted(text);
  if (!(stats.ms.light_grid_build > 0)) return;
  std::snprintf(text, sizeof text, "light grids: %.0f ms, once; not part of a frame", stats.ms.light_grid_build);
  muted(text);
}

void draw_camera(WalkSession& session, const PanelInput& input, PanelAction& action) {
  const Camera& c = input.camera;
  const auto line = [](const char* name) { ImGui::TextDisabled("%s", name), ImGui::SameLine(labels()); };
  const bool narrow = panel_width() < kWidth;
  const char* const point = narrow ? "%.2f %.2f %.2f" : "%.3f  %.3f  %.3f";
  line("eye");
  ImGui::Text(point, c.eye[0], c.eye[1], c.eye[2]);
  line("target");
  ImGui::Text(point, c.target[0], c.target[1], c.target[2]);
  line("angle, near");
  ImGui::Text(narrow ? "%.2f, %.3g" : "%.2f degrees, %.3g", c.fov_y_degrees, c.near_plane);
  line("speed");
  ImGui::Text("%.3g a second", session.speed());
  label("");
  if (ImGui::Button("copy for --camera")) ImGui::SetClipboardText(short_camera_text(c, session.scene()).c_str());
  label("go to");
  const std::vector<std::string>& names = session.scene().camera_names();
  for (size_t i = 0; i < names.size(); ++i) {
    ImGui::PushID(static_cast<int>(i));
    if (choice(names[i].substr(0, 32).c_str(), false, i == 0)) action.camera = static_cast<int>(i);
    ImGui::PopID();
  }
  if (!session.scene().data().motions.empty()) {
    label("time");
    action.clock = choice(input.clock_runs ? "pause" : "go on", input.clock_runs, true);
    ImGui::SameLine(0, 4);
    ImGui::SetNextItemWidth(-1);
    const double least = -kMostSeconds, most = kMostSeconds;
    double time = session.settings().time;
    if (ImGui::DragScalar("##time", ImGuiDataType_Double, &time, 0.02f, &least, &most, "%.2f s", ImGuiSliderFlags_NoInput | ImGuiSliderFlags_AlwaysClamp))
      action.time = time;
  }
  if (input.path.empty()) return;
  label("path");
  action.play = choice(input.playing ? "stop" : "play", input.playing, true);
  ImGui::SameLine(0, 4);
  ImGui::SetNextItemWidth(-1);
  float seconds = static_cast<float>(input.path_time);
  if (ImGui::SliderFloat("##path", &seconds, 0, static_cast<float>(input.path.back().time - input.path.front().time), "%.1f s",
                         ImGuiSliderFlags_NoInput | ImGuiSliderFlags_AlwaysClamp))
    action.path_time = seconds;
}

// Three lines, whatever is there: what stands below must not jump.
void draw_pointed(const WalkSession& session, const PanelInput& input) {
  std::string material = "-", part = "-", triangle = "-";
  if (input.pointed) material = "background";
  if (input.pointed && input.under) {
    const TriangleName& name = input.under->name;
    material = name.material, part = name.object;
    if (!name.group.empty()) part += (part.empty() ? "group " : ", group ") + std::string(name.group);
    if (part.empty()) part = "without a name";
    char text[64];
    std::snprintf(text, sizeof text, "%u, %.4g away", name.triangle, distance_from(session.shown().order.camera.eye, *input.under));
    triangle = text;
  }
  ImGui::PushTextWrapPos(-1);
  for (const auto& [title, text] : {std::pair{"pointed at", &material}, {"object", &part}, {"triangle", &triangle}}) {
    ImGui::TextDisabled("%s", title);
    ImGui::SameLine(labels());
    ImGui::TextUnformatted(text->c_str());
  }
  ImGui::PopTextWrapPos();
}

void draw_plan(WalkSession& session) {
  for (const PlanLine& line : session.plan()) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float top = at.y + 3;
    if (line.needed)
      ImGui::GetWindowDrawList()->AddRectFilled({at.x, top}, {at.x + 7, top + 7}, kAmber);
    else
      ImGui::GetWindowDrawList()->AddRect({at.x, top}, {at.x + 7, top + 7}, IM_COL32(90, 95, 104, 255));
    ImGui::Indent(14);
    line.needed ? ImGui::TextUnformatted(line.stage.c_str()) : ImGui::TextDisabled("%s", line.stage.c_str());
    ImGui::Indent(14);
    muted(line.reason.c_str());
    ImGui::Unindent(28);
  }
}

constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                                    ImGuiWindowFlags_NoNav | ImGuiWindowFlags_AlwaysAutoResize;

}  // namespace

PanelAction draw_panel(WalkSession& session, const PanelInput& input) {
  PanelAction action;
  const ImGuiTreeNodeFlags open = screen().y < kLowWindow ? 0 : ImGuiTreeNodeFlags_DefaultOpen;
  ImGui::SetNextWindowPos({kMargin, kMargin});
  ImGui::SetNextWindowSizeConstraints({panel_width(), 0}, {panel_width(), std::max(60.0f, screen().y - 2 * kMargin)});
  ImGui::Begin("panel", nullptr, kFixed & ~ImGuiWindowFlags_NoScrollbar);
  ImGui::PushTextWrapPos(panel_width() - ImGui::GetStyle().WindowPadding.x - ImGui::GetStyle().ScrollbarSize);
  draw_times(session);
  ImGui::Spacing();
  draw_pointed(session, input);
  ImGui::Spacing();
  if (ImGui::CollapsingHeader("Switches", open)) action.changed = draw_switches(session);
  if (ImGui::CollapsingHeader("Camera", open)) draw_camera(session, input, action);
  if (ImGui::CollapsingHeader("Plan: what is needed")) draw_plan(session);
  ImGui::PopTextWrapPos();
  ImGui::End();
  return action;
}

bool help_fits_beside_panel() { return screen().x - help_left(true) - 2 * kMargin >= kLeastHelpWidth; }

void draw_help(bool panel) {
  const ImGuiStyle& style = ImGui::GetStyle();
  float column = 0, text = 0;
  for (const WalkSession::Key& key : WalkSession::keys()) {
    column = std::max(column, ImGui::CalcTextSize(key.keys).x);
    text = std::max(text, ImGui::CalcTextSize(key.meaning).x);
  }
  const float left = help_left(panel), most = std::max(60.0f, screen().x - left - 2 * kMargin);
  column += style.WindowPadding.x + 16;
  ImGui::SetNextWindowPos({std::floor((left + screen().x) / 2), std::floor(screen().y / 2)}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSizeConstraints({0, 0}, {most, std::max(60.0f, screen().y - 2 * kMargin)});
  ImGui::Begin("keys", nullptr, kFixed & ~ImGuiWindowFlags_NoScrollbar);
  ImGui::PushTextWrapPos(std::min(column + text + 1, most - style.WindowPadding.x));
  for (const WalkSession::Key& key : WalkSession::keys()) {
    ImGui::TextUnformatted(key.keys);
    ImGui::SameLine(column);
    muted(key.meaning);
  }
  ImGui::PopTextWrapPos();
  ImGui::End();
}

void draw_hint(const std::string& text) {
  ImGui::SetNextWindowPos({kMargin, ImGui::GetIO().DisplaySize.y - kMargin}, ImGuiCond_Always, {0, 1});
  ImGui::Begin("hint", nullptr, kFixed | ImGuiWindowFlags_NoMouseInputs);
  ImGui::TextUnformatted(text.c_str());
  ImGui::End();
}

void draw_progress(const std::string& scene, const std::string& stage, double fraction, double seconds) {
  const float width = std::clamp(screen().x - 40, 40.0f, 360.0f);
  ImGui::SetNextWindowPos({screen().x / 2, screen().y / 2}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSize({width, 0});
  ImGui::Begin("progress", nullptr, (kFixed & ~ImGuiWindowFlags_AlwaysAutoResize) | ImGuiWindowFlags_NoMouseInputs);
  ImGui::TextUnformatted(scene.c_str());
  // Back and forth where nobody knows.
  const double swing = seconds - 2 * static_cast<int>(seconds / 2);
  const float from = fraction < 0 ? static_cast<float>(swing < 1 ? swing : 2 - swing) * 0.8f : 0.0f;
  const float to = fraction < 0 ? from + 0.2f : static_cast<float>(std::clamp(fraction, 0.0, 1.0));
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float whole = ImGui::GetContentRegionAvail().x;
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled({at.x, at.y + 2}, {at.x + whole, at.y + 12}, kTrack);
  draw.AddRectFilled({at.x + from * whole, at.y + 2}, {at.x + to * whole, at.y + 12}, kAmber);
  ImGui::Dummy({whole, 14});
  ImGui::TextDisabled("%s, %.0f s   Esc leaves", stage.c_str(), seconds);
  ImGui::End();
}

}  // namespace spanray::demo
