// embree_bench SCENE: our tracer and Embree 3 answer the same rays of one of our frames, in turns; Mrays/s, and how far they agree.
// A table on stdout. Exit 0 done, 1 could not (or they disagree and --require-agreement was given), 2 wrong usage.
#include <algorithm>
#include <cstdio>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "embree_tracer.h"
#include "frame_options.h"
#include "measure.h"
#include "ray_agreement.h"
#include "ray_classes.h"

namespace spanray::peers {
namespace {

// A tracer with a way to ask it: ours, or Embree's fast or robust tree in one mode.
struct Asked {
  const TracedScene* ours = nullptr;
  const EmbreeTracer* embree = nullptr;
  bool robust = false;
  EmbreeMode mode = EmbreeMode::kSingle;
};

struct Answers {
  std::vector<std::vector<uint32_t>> primitive;  // by part; bits for any-hit classes
  std::vector<std::vector<float>> t;             // Embree, closest hit
};

struct Cell {
  Asked asked;
  std::vector<double> ms;
  uint64_t different = 0;  // rays whose answer is not ours
  double warm_up_ms = 0;
  double mrays(size_t rays) const { return static_cast<double>(rays) / median(ms) * 1e-3; }
};

struct Options {
  demo::FrameOptions frame;
  int passes = 7, builds = 3;
  bool require_agreement = false, header = false;
  std::vector<std::string> rays;  // kinds; empty: all
  std::string json, label;
};

void add_options(CLI::App& app, Options& o) {
  o.frame.add_to(app);
  app.add_option("--passes", o.passes, "Timed passes over all rays of a kind, in turns")->check(CLI::Range(1, 10000));
  app.add_option("--rays", o.rays, "Only these kinds, e.g. shadow,ao")->delimiter(',')->check(CLI::IsMember({"primary", "shadow", "mirror", "diffuse", "ao"}));
  app.add_option("--builds", o.builds, "Times that each tree is built")->check(CLI::Range(1, 1000));
  app.add_option("--json", o.json, "Append one JSON object, a line, to this file");
  app.add_option("--label", o.label, "Name of the scene in the table");
  app.add_flag("--header", o.header, "Print the head of the table before the lines");
  app.add_flag("--require-agreement", o.require_agreement, "Exit 1 unless 99.9 % of the rays of every kind have our answer from Embree's robust tree");
}

void make_room(const RayClass& c, Answers& a) {
  a.primitive.resize(c.parts.size()), a.t.resize(c.parts.size());
  for (size_t i = 0; i < c.parts.size(); ++i) {
    const auto n = static_cast<size_t>(c.parts[i].count);
    a.primitive[i].assign(n + 1, 0), a.t[i].assign(n + 1, 0);
  }
}

void ask(const Asked& asked, const RayClass& c, Parallel& parallel, Answers& a) {
  parallel.for_each(c.parts.size(), [&](size_t i, int) {
    uint32_t* const out = a.primitive[i].data();
    if (asked.embree != nullptr) {
      if (c.any_hit) asked.embree->any(asked.mode, c.parts[i], out);
      else asked.embree->closest(asked.mode, c.parts[i], out, a.t[i].data());
    } else if (c.any_hit) {
      trace_any(asked.ours->frame, asked.ours->bvh, c.parts[i], out);
    } else {
      trace_closest(asked.ours->frame, asked.ours->bvh, c.parts[i], out);
    }
  });
}

uint64_t count_different(const SceneData& scene, const RayClass& c, const Answers& ours, const Answers& theirs) {
  uint64_t different = 0;
  for (size_t p = 0; p < c.parts.size(); ++p)
    different += c.any_hit ? different_bits(c.parts[p].count, ours.primitive[p].data(), theirs.primitive[p].data())
                           : different_hits(scene, c.parts[p], ours.primitive[p].data(), theirs.primitive[p].data(), theirs.t[p].data());
  return different;
}

std::vector<Cell> make_cells(const TracedScene& ours, const EmbreeTracer& fast, const EmbreeTracer& robust) {
  std::vector<Cell> cells = {{{&ours, nullptr}, {}, 0}};
  for (const EmbreeTracer* tree : {&fast, &robust})
    for (int m = 0; m < kEmbreeModes; ++m) cells.push_back({{nullptr, tree, tree == &robust, static_cast<EmbreeMode>(m)}, {}, 0});
  return cells;
}

constexpr double kOutOfTheRace = 1.5;  // modes that were this much slower than the best in the warm-up are not timed

void measure(const Options& o, const RayClass& c, Parallel& parallel, const SceneData& scene, std::vector<Cell>& cells) {
  Answers ours, theirs;
  make_room(c, ours), make_room(c, theirs);
  double fastest[2] = {1e300, 1e300};  // of Embree's trees
  for (Cell& cell : cells) {  // warm-up, checked
    const Stopwatch watch;
    ask(cell.asked, c, parallel, cell.asked.embree == nullptr ? ours : theirs);
    cell.warm_up_ms = watch.wall();
    if (cell.asked.embree == nullptr) continue;
    cell.different = count_different(scene, c, ours, theirs);
    fastest[cell.asked.robust] = std::min(fastest[cell.asked.robust], cell.warm_up_ms);
  }
  for (int pass = 0; pass < o.passes; ++pass) {
    for (Cell& cell : cells) {
      if (cell.asked.embree != nullptr && cell.warm_up_ms > kOutOfTheRace * fastest[cell.asked.robust]) continue;
      const Stopwatch watch;
      ask(cell.asked, c, parallel, theirs);
      cell.ms.push_back(watch.wall());
    }
  }
}

const Cell& best(const std::vector<Cell>& cells, bool robust) {
  const Cell* found = nullptr;
  for (const Cell& cell : cells)
    if (cell.asked.embree != nullptr && cell.asked.robust == robust && !cell.ms.empty() && (found == nullptr || median(cell.ms) < median(found->ms))) found = &cell;
  return *found;
}

double agreement(const Cell& cell, size_t rays) { return 1 - static_cast<double>(cell.different) / static_cast<double>(std::max<size_t>(rays, 1)); }

std::string name_of(const Options& o) { return scene_name(o.label, o.frame.scene_path()); }

void print_header() {
  std::printf("| scene | threads | rays | Mrays | ours, Mrays/s | Embree, best mode | Embree robust, best mode | ours : Embree | ours : robust | "
              "agreement | agreement, robust |\n|---|---|---|---|---|---|---|---|---|---|---|\n");
}

void print_line(const Options& o, int threads, const RayClass& c, const std::vector<Cell>& cells) {
  const size_t rays = c.count();
  const Cell &fast = best(cells, false), &robust = best(cells, true);
  const double ours = cells[0].mrays(rays);
  std::printf("| %s | %d | %s | %.2f | %.2f | %.2f (%s) | %.2f (%s) | %.2f | %.2f | %.3f %% | %.3f %% |\n", name_of(o).c_str(), threads,
              c.name.c_str(), static_cast<double>(rays) * 1e-6, ours, fast.mrays(rays), embree_mode_name(fast.asked.mode), robust.mrays(rays),
              embree_mode_name(robust.asked.mode), ours / fast.mrays(rays), ours / robust.mrays(rays), 100 * agreement(fast, rays),
              100 * agreement(robust, rays));
}

nlohmann::ordered_json json_of(const RayClass& c, const std::vector<Cell>& cells) {
  const size_t rays = c.count();
  nlohmann::ordered_json modes;
  for (const Cell& cell : cells) {
    const std::string name = cell.asked.embree == nullptr ? "ours" : std::string(cell.asked.robust ? "embree robust " : "embree ") + embree_mode_name(cell.asked.mode);
    modes[name] = {{"different", cell.different}, {"warm_up_ms", cell.warm_up_ms}, {"all_ms", cell.ms}};
    if (!cell.ms.empty()) modes[name]["mrays_per_s"] = cell.mrays(rays);
  }
  return {{"kind", c.name}, {"rays", rays}, {"tracers", modes}};
}

int compare(const CLI::App& app, const Options& o) {
  Result<demo::Job> loaded = o.frame.load();
  if (!loaded) return fail(app, loaded.error());
  demo::Job& job = loaded.value();
  const int threads = job.settings.threads > 0 ? job.settings.threads : Parallel::available();
  Parallel parallel(threads);
  const TracedScene ours(job.scene, job.camera, job.settings, parallel, o.builds);
  const SceneData& scene = job.scene.data();
  const auto fast = EmbreeTracer::create(scene, false, threads, o.builds), robust = EmbreeTracer::create(scene, true, threads, o.builds);
  if (!fast) return fail(app, fast.error());
  if (!robust) return fail(app, robust.error());
  if (o.header) print_header();
  nlohmann::ordered_json line = {{"scene", name_of(o)}, {"scene_hash", job.scene.hash()}, {"triangles", scene.triangles.size()},
                                 {"width", job.settings.width}, {"height", job.settings.height}, {"threads", threads},
                                 {"camera", demo::camera_text(job.camera)}};
  const auto build = [](double ms, size_t bytes) { return nlohmann::ordered_json{{"median_ms", ms}, {"memory_bytes", bytes}}; };
  line["build"] = {{"ours", build(ours.build_ms, ours.bvh.memory_bytes())}, {"embree", build(fast.value()->build_ms(), fast.value()->memory_bytes())},
                   {"embree_robust", build(robust.value()->build_ms(), robust.value()->memory_bytes())}};
  double least = 1;
  for (const RayClass& c : make_ray_classes(ours)) {
    if (c.count() == 0 || (!o.rays.empty() && std::find(o.rays.begin(), o.rays.end(), c.name) == o.rays.end())) continue;
    std::vector<Cell> cells = make_cells(ours, *fast.value(), *robust.value());
    measure(o, c, parallel, scene, cells);
    print_line(o, threads, c, cells);
    line["classes"].push_back(json_of(c, cells));
    for (const Cell& cell : cells)
      if (cell.asked.robust) least = std::min(least, agreement(cell, c.count()));
  }
  std::printf("| %s | %d | build, ms (MB) | | %.1f (%.1f) | %.1f (%.1f) | %.1f (%.1f) | %.2f | %.2f | | |\n", name_of(o).c_str(), threads,
              ours.build_ms, static_cast<double>(ours.bvh.memory_bytes()) * 1e-6, fast.value()->build_ms(),
              static_cast<double>(fast.value()->memory_bytes()) * 1e-6, robust.value()->build_ms(),
              static_cast<double>(robust.value()->memory_bytes()) * 1e-6, fast.value()->build_ms() / ours.build_ms,
              robust.value()->build_ms() / ours.build_ms);
  if (!o.json.empty())
    if (Result<void> done = append_line(o.json, line.dump()); !done) return fail(app, done.error());
  if (o.require_agreement && least < kEnoughRays)
    return fail(app, Error{"Embree's robust tree has our answer for only " + std::to_string(100 * least) + " % of the rays; 99.9 % are needed"});
  return demo::kDone;
}

}  // namespace
}  // namespace spanray::peers

int main(int argc, char** argv) {
  CLI::App app("Our tracer against Embree 3: the same rays, in turns", "embree_bench");
  spanray::peers::Options options;
  spanray::peers::add_options(app, options);
  return spanray::peers::run(app, argc, argv, [&] { return spanray::peers::compare(app, options); });
}
