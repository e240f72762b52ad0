#include "report_data.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <fstream>

#include "command.h"
#include "core/counted.h"
#include "core/hash.h"
#include "core/number_text.h"
#include "scene/scene_data.h"
#include "report_plan.h"
#include "stats_json.h"
#include "truth.h"

namespace spanray::demo {
namespace {

using Json = nlohmann::ordered_json;

std::string cpu_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("model name")) return line.substr(std::min(line.find(':') + 2, line.size()));
  return "unknown";
}

// As a POSIX shell reads it back.
std::string shell_word(const std::string& word) {
  const auto plain = [](unsigned char c) { return std::isalnum(c) != 0 || (c != 0 && std::strchr("-_./=,:+%@", c) != nullptr); };
  if (!word.empty() && std::all_of(word.begin(), word.end(), plain)) return word;
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? "'\\''" : std::string(1, c);
  return out + "'";
}

// Infinity, the PSNR of equal pictures, is no number of JSON: null.
Json number_json(double v) { return std::isfinite(v) ? Json(v) : Json(nullptr); }

Json metrics_json(const Metrics& m) {
  Json out;
  for (const MetricWord& word : kMetricWords) out[word.name] = number_json(m.*word.value);
  return out;
}

std::string leading_id(const Report& report, size_t i) {
  return report.dominated[i] < 0 ? "" : report.trade.settings[static_cast<size_t>(report.dominated[i])].candidate.id;
}

std::string date_text() {
  const std::time_t now = std::time(nullptr);
  char date[32] = "";
  std::tm utc{};
  if (::gmtime_r(&now, &utc) != nullptr) std::strftime(date, sizeof date, "%Y-%m-%d %H:%M UTC", &utc);
  return date;
}

}  // namespace

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
  return out + "\"";
}

std::vector<std::pair<std::string, std::string>> describe_program() {
  return {{"processor", cpu_name() + ", " + std::to_string(Parallel::available()) + " processors for this process"},
          {"compiler", compiler_name()},
          {"spanray", SPANRAY_VERSION},
          {"numeric contract", std::to_string(kNumericContract)},
          {"date", date_text()},
          {"command", command_line()}};
}

std::string metrics_text(const Metrics& metrics) {
  std::string text;
  for (const MetricWord& word : kMetricWords) {
    char number[40];
    std::snprintf(number, sizeof number, "%.4g", metrics.*word.value);
    text += (text.empty() ? "" : ", ") + std::string(word.name) + " " + number +
            (*word.unit != 0 ? std::string(" ") + word.unit : "");
  }
  return text;
}

std::vector<Cost> costs(const Report& report) {
  std::vector<Cost> list;
  for (const Measured& m : report.trade.settings) list.push_back({m.median_ms(), m.error.*kRankedBy});
  return list;
}

std::string report_csv(const Report& report) {
  std::string text = "id,group,preset,name";
  for (const auto& stage : kStages)
    if (stage.time != &StageTimes::bvh_build) text += std::string(",median_ms_") + stage.name + ",p95_ms_" + stage.name;
  text += ",bvh_build_ms";
  for (const MetricWord& word : kMetricWords) text += std::string(",") + word.name;
  text += ",wrong_ids";
  for (const MetricWord& word : kMetricWords) text += std::string(",alone_") + word.name;
  for (const MetricWord& word : kMetricWords) text += std::string(",truth_") + word.name;
  text += ",dominated_by";
  for (const auto& [key, value] : settings_words(report.job.settings)) text += "," + key;
  text += "\n";
  for (size_t i = 0; i < report.trade.settings.size(); ++i) {
    const Measured& m = report.trade.settings[i];
    text += m.candidate.id + "," + m.candidate.group + "," + m.candidate.preset + "," + quoted(m.candidate.name);
    for (const auto& stage : kStages)
      if (stage.time != &StageTimes::bvh_build)
        text += "," + number_text(m.median_ms(stage.time)) + "," + number_text(m.p95_ms(stage.time));
    text += "," + number_text(m.bvh_build_ms);
    for (const MetricWord& word : kMetricWords) text += "," + number_text(m.error.*word.value);
    text += "," + (m.wrong_ids ? std::to_string(*m.wrong_ids) : "");
    for (const MetricWord& word : kMetricWords) text += "," + (m.error_alone ? number_text(*m.error_alone.*word.value) : "");
    for (const MetricWord& word : kMetricWords) text += "," + number_text(report.trade.truth_error.*word.value);
    text += "," + leading_id(report, i);
    for (const auto& [key, value] : settings_words(m.candidate.settings)) text += "," + value;
    text += "\n";
  }
  return text;
}

Json report_json(const Report& report) {
  Json out;
  for (const auto& [key, value] : report.machine) out["about"][key] = value;
  for (const MetricWord& word : kMetricWords)
    if (word.value == kRankedBy) out["ranked_by"] = word.name;
  out["about"]["psnr_db"] = "null: infinite, the pictures are equal (inf in the CSV)";
  out["truth_error"] = metrics_json(report.trade.truth_error);
  for (const Knob& knob : report.knobs) {
    Json k = {{"name", knob.name}, {"what", knob.what}, {"used", knob.absent.empty()}};
    if (!knob.absent.empty()) k["why_not"] = knob.absent;
    for (const KnobChoice& choice : knob.choices) k["choices"].push_back(choice.word);
    out["knobs"].push_back(k);
  }
  for (size_t i = 0; i < report.trade.settings.size(); ++i) {
    const Measured& m = report.trade.settings[i];
    Json s = {{"id", m.candidate.id}, {"name", m.candidate.name}, {"group", m.candidate.group}};
    if (!m.candidate.preset.empty()) s["preset"] = m.candidate.preset;
    for (const auto& [key, value] : settings_words(m.candidate.settings)) s["settings"][key] = value;
    for (const auto& stage : kStages) {
      if (stage.time == &StageTimes::bvh_build) continue;
      s["median_ms"][stage.name] = m.median_ms(stage.time), s["p95_ms"][stage.name] = m.p95_ms(stage.time);
    }
    s["median_interval_ms"] = {m.interval_ms().low, m.interval_ms().high};
    for (const FrameStats& frame : m.frames) s["frame_ms"].push_back(frame.ms.frame);
    s["bvh_build_ms"] = m.bvh_build_ms;
    s["error"] = metrics_json(m.error);
    if (m.wrong_ids) s["wrong_ids"] = *m.wrong_ids;
    if (m.error_alone) s["error_alone"] = metrics_json(*m.error_alone);
    s["hash"] = hash_text(hash_image(m.picture));
    if (report.dominated[i] >= 0) s["dominated_by"] = leading_id(report, i);
    out["settings"].push_back(s);
  }
  out["plan"] = plan_json(plan_frame(report.job.scene, plain_settings(report.knobs, report.job.settings)));
  out["plan_costs"] = plan_costs_json(report);
  out["ambiguity"] = mask_json(report.mask);
  out["not_modelled"] = report.not_modelled;
  return out;
}

std::vector<std::string> find_not_modelled(const Job& job) {
  const SceneData& scene = job.scene.data();
  uint64_t glass = 0, emitting = 0;
  for (const Material& m : scene.materials) {
    glass += m.illum == 4 || m.illum == 6 || m.illum == 7 || m.illum == 9;
    emitting += m.emission[0] > 0 || m.emission[1] > 0 || m.emission[2] > 0;
  }
  std::vector<std::string> list;
  if (glass > 0)
    list.push_back(counted(glass, "material", "materials") +
                   " of glass (illum 4, 6, 7, 9): blended by opacity, no refraction, no mirror rays");
  if (emitting > 0) list.push_back(counted(emitting, "material", "materials") + " that emit: they are seen, but light nothing");
  list.push_back(
      "light by way of other surfaces (global illumination): one ambient radiance stands for it, in the ground truth as well");
  list.push_back("lights with an area: shadows have hard edges, in the ground truth as well");
  for (const std::string& message : job.messages) list.push_back("the loader says: " + message);
  return list;
}

std::string command_line() {
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  std::string text;
  for (std::string word; std::getline(file, word, '\0');) text += (text.empty() ? "" : " ") + shell_word(word);
  return text;
}

std::vector<std::pair<std::string, std::string>> describe_machine(const Report& report) {
  const FrameStats& frame = report.trade.settings.at(0).frames.back();
  const Settings& s = report.job.settings;
  const int other = second_grid(report.options.grid);
  std::vector<std::pair<std::string, std::string>> list = {
      {"scene", report.scene_path},
      {"scene hash", hash_text(report.job.scene.hash())},
      {"triangles", std::to_string(report.job.scene.triangle_count())},
      {"camera", camera_text(report.job.camera)},
      {"size", std::to_string(s.width) + "x" + std::to_string(s.height)},
      {"threads", std::to_string(frame.threads)},
      {"instruction set", frame.isa},
      {"frames", std::to_string(report.options.frames) + " of each setting after " + std::to_string(report.options.warmup) +
                     ", in turns of five after one that is not measured"},
      {"ground truth", "every knob exact, " + std::to_string(report.options.grid) + " x " + std::to_string(report.options.grid) +
                           " samples a pixel, double precision; its own error against a second one with " + std::to_string(other) + " x " + std::to_string(other) +
                           " at other places; " + std::to_string(std::lround(report.trade.truth_seconds)) +
                           " s; no random numbers, so there is no seed"}};
  for (auto& line : describe_program()) list.push_back(std::move(line));
  return list;
}

}  // namespace spanray::demo
