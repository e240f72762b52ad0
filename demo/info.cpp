// spanray info: what a scene is made of, and which stages a frame of it needs.
#include <algorithm>
#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>

#include "command.h"
#include "core/counted.h"
#include "core/hash.h"
#include "frame_options.h"
#include "render/ray_trees.h"
#include "scene/scene_data.h"
#include "scene/text_input.h"
#include "stats_json.h"

namespace spanray::demo {
namespace {

struct InfoOptions {
  FrameOptions frame;
  bool json = false;
};

size_t triangles_of_instances(const SceneData& scene) {
  size_t sum = 0;
  for (const Instance& i : scene.instances) sum += i.count;
  return sum;
}

std::string trees_in_words(const RayTrees::Makeup& trees) {
  if (trees.levels == 0) return "no ray is traced";
  char size[32];
  std::snprintf(size, sizeof size, ", %.1f MB", static_cast<double>(trees.bytes) * 1e-6);
  if (trees.levels == 1) return std::string("rays: one tree over all copies") + size;
  return "rays: a tree of two levels, shared by " + counted(trees.instances, "copy", "copies") + size;
}

void print_json(const Job& job, const std::string& path, const std::vector<PlanLine>& plan) {
  const SceneData& scene = job.scene.data();
  nlohmann::ordered_json out;
  out["scene"] = path;
  out["scene_hash"] = hash_text(job.scene.hash());
  out["triangles"] = scene.triangles.size();
  if (!scene.instances.empty()) {
    out["instances"] = {{"parts", scene.instanced_parts.size()},
                        {"places", scene.instances.size()},
                        {"triangles", triangles_of_instances(scene)}};
    const RayTrees::Makeup trees = tree_makeup(scene, job.settings);
    out["bvh_levels"] = trees.levels, out["bvh_instances"] = trees.instances, out["bvh_bytes"] = trees.bytes;
  }
  if (!scene.spheres.empty()) out["spheres"] = scene.spheres.size();
  if (!scene.planes.empty()) out["planes"] = scene.planes.size();
  out["vertices"] = scene.vertices.size();
  out["materials"] = scene.materials.size();
  out["textures"] = scene.textures.size();
  out["texels"] = scene.texels.size();
  out["lights"] = scene.lights.size();
  out["cameras"] = scene.camera_names;
  out["camera_path_keys"] = scene.camera_path.size();
  out["moving_parts"] = nlohmann::ordered_json::array();
  for (const Motion& motion : scene.motions) out["moving_parts"].push_back(motion.part);
  out["bounds"] = {{"min", scene.bounds_min}, {"max", scene.bounds_max}};
  for (const auto& [key, value] : settings_words(job.settings)) out["settings"][key] = value;
  out["messages"] = job.messages;
  out["plan"] = plan_json(plan);
  std::printf("%s\n", out.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace).c_str());
}

void print_text(const Job& job, const std::string& path, const std::vector<PlanLine>& plan) {
  const SceneData& scene = job.scene.data();
  const auto number = [](const char* name, size_t value) { std::printf("%-12s %zu\n", name, value); };
  std::printf("%-12s %s\n", "scene", path.c_str());
  std::printf("%-12s %s\n", "scene_hash", hash_text(job.scene.hash()).c_str());
  number("triangles", scene.triangles.size());
  if (!scene.instances.empty()) {
    std::printf("%-12s %s of %s, %s; %s\n", "instances", counted(scene.instances.size(), "copy", "copies").c_str(),
                counted(scene.instanced_parts.size(), "part", "parts").c_str(),
                counted(triangles_of_instances(scene), "triangle", "triangles").c_str(),
                trees_in_words(tree_makeup(scene, job.settings)).c_str());
  }
  if (!scene.spheres.empty()) number("spheres", scene.spheres.size());
  if (!scene.planes.empty()) number("planes", scene.planes.size());
  number("vertices", scene.vertices.size());
  number("materials", scene.materials.size());
  number("textures", scene.textures.size());
  number("lights", scene.lights.size());
  std::printf("%-12s %zu:", "cameras", scene.camera_names.size());
  for (const std::string& name : scene.camera_names) std::printf(" %s", name.c_str());
  const float *low = scene.bounds_min, *high = scene.bounds_max;
  std::printf("\n%-12s %g %g %g to %g %g %g\n", "bounds", low[0], low[1], low[2], high[0], high[1], high[2]);
  if (!scene.camera_path.empty())
    std::printf("%-12s %zu keys, %g s to %g s\n", "camera path", scene.camera_path.size(), scene.camera_path.front().time,
                scene.camera_path.back().time);
  if (!scene.motions.empty()) std::printf("%-12s %zu:", "moving parts", scene.motions.size());
  for (const Motion& motion : scene.motions) std::printf(" %s", spanray::quoted(motion.part).c_str());
  if (!scene.motions.empty()) std::printf("\n");
  std::printf("\nsettings\n");
  for (const auto& [key, value] : settings_words(job.settings)) std::printf("  %-14s %s\n", key.c_str(), value.c_str());
  if (!job.messages.empty()) std::printf("\nmessages\n");
  for (const std::string& text : job.messages) std::printf("  %s\n", text.c_str());
  std::printf("\nplan\n");
  size_t width = 0;
  for (const PlanLine& line : plan) width = std::max(width, line.stage.size());
  for (const PlanLine& line : plan)
    std::printf("  %-*s  %-10s  %s\n", static_cast<int>(width), line.stage.c_str(), line.needed ? "needed" : "not needed",
                line.reason.c_str());
}

int info(const InfoOptions& options) {
  Result<Job> loaded = options.frame.load();
  if (!loaded) return fail(loaded.error());
  const Job& job = loaded.value();
  const std::vector<PlanLine> plan = plan_frame(job.scene, job.settings);
  options.json ? print_json(job, options.frame.scene_path(), plan) : print_text(job, options.frame.scene_path(), plan);
  return kDone;
}

}  // namespace

void add_info(CLI::App& app, Run& run) {
  CLI::App* command = app.add_subcommand("info", "What a scene holds, and the plan of its frame");
  auto options = std::make_shared<InfoOptions>();
  options->frame.add_to(*command);
  command->add_flag("--json", options->json, "As JSON");
  command->callback([options, &run] { run = [options] { return info(*options); }; });
}

}  // namespace spanray::demo
