// embree_frame_bench SCENE: a frame of ours (rasterized primary rays, traced shadow and mirror rays) and the same frame from Embree's rays
// alone, in turns. A table on stdout. Exit 0 done, 1 could not (or they disagree and --require-agreement was given), 2 wrong usage.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <thread>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "agreement.h"
#include "embree_frame.h"
#include "frame_options.h"
#include "measure.h"
#include "ray_agreement.h"

namespace spanray::peers {
namespace {

struct Options {
  demo::FrameOptions frame;
  int frames = 9, warmup = 2, tries = 2;
  bool require_agreement = false, header = false;
  std::string json, label, pictures;
};

void add_options(CLI::App& app, Options& o) {
  o.frame.add_to(app);
  app.add_option("--frames", o.frames, "Timed frames of each side, in turns")->check(CLI::Range(1, 10000));
  app.add_option("--warmup", o.warmup, "Frames of each side before these")->check(CLI::Range(0, 10000));
  app.add_option("--tries", o.tries, "Frames in each of Embree's modes, to find its best for each kind of ray")->check(CLI::Range(1, 100));
  app.add_option("--json", o.json, "Append one JSON object, a line, to this file");
  app.add_option("--pictures", o.pictures, "Write PREFIX-ours.png, PREFIX-embree.png and PREFIX-difference.png");
  app.add_option("--label", o.label, "Name of the scene in the table");
  app.add_flag("--header", o.header, "Print the head of the table before the line");
  app.add_flag("--require-agreement", o.require_agreement, "Exit 1 unless 99.9 % of the ids and of the rays of every kind agree, with both of Embree's trees");
}

// What both sides can do. Throws where the user asked for more.
Settings restrict_settings(Settings s) {
  if (s.samples != 1) throw demo::UsageError("--samples: one sample a pixel is compared");
  if (s.culling != Culling::kNone) throw demo::UsageError("--culling: Embree sees both sides of triangles, so we must");
  if (s.shading == Shading::kGouraud) throw demo::UsageError("--shading: Gouraud lights vertices, which rays alone know nothing of");
  if (s.visibility != Visibility::kRaster) throw demo::UsageError("--visibility: our side rasterizes");
  s.transparency = Transparency::kNone;
  s.max_bounces = std::min(s.max_bounces, 1);
  if (s.threads == 0) s.threads = Parallel::available();
  return s;
}

// At rest, and without masks: Embree is asked without filter functions.
Scene opaque_scene(const Scene& scene, double time) {
  struct Kept {
    Scene standing;
    SceneData data;
  };
  const auto kept = std::make_shared<Kept>(Kept{scene_at(scene, time), {}});
  const SceneData& from = kept->standing.data();
  SceneData& data = kept->data;
  static_cast<SceneTables&>(data) = from;
  data.vertices = AlignedBuffer<Vertex>::borrow(from.vertices);
  data.triangles = AlignedBuffer<Triangle>::borrow(from.triangles);
  data.borrow_texels(from);
  for (Material& m : data.materials) m.map_opacity = -1, m.opacity = 1, m.transparency = static_cast<int32_t>(MaterialTransparency::kOpaque);
  return Scene(std::shared_ptr<const SceneData>(kept, &data));
}

// Median milliseconds of our frame; the stages as in StageTimes.
struct OurTimes {
  std::vector<double> front, shadow, bounce, shade, encode, frame;
  void add(const StageTimes& t) {
    front.push_back(t.transform + t.clip + t.bin + t.raster);
    shadow.push_back(t.shadow_rays), bounce.push_back(t.bounce_rays), shade.push_back(t.shade), encode.push_back(t.encode), frame.push_back(t.frame);
  }
  double visibility() const { return median(front) + median(shadow) + median(bounce); }
};

// One of Embree's trees, its best modes, and how it does.
struct Peer {
  const char* name = "";
  std::unique_ptr<EmbreeTracer> tracer;
  EmbreeModes modes;
  std::vector<EmbreeFrameTimes> times;
  EmbreeFrameErrors errors;
  uint64_t different_ids = 0;  // pixels where the pictures show another triangle, at another depth
  Agreement picture;

  template <class Pick> double middle(const Pick& pick) const {
    std::vector<double> v;
    for (const EmbreeFrameTimes& t : times) v.push_back(pick(t));
    return median(v);
  }
  double traversal() const { return middle([](const EmbreeFrameTimes& t) { return t.traversal(); }); }
  double making() const { return middle([](const EmbreeFrameTimes& t) { return t.making_secondary; }); }
  // Primary rays are as if they were given: a renderer that has nothing else would make them faster than our double-precision code.
  double frame() const { return middle([](const EmbreeFrameTimes& t) { return t.frame - t.making_primary; }); }
};

double share(uint64_t different, uint64_t of) { return 1 - static_cast<double>(different) / static_cast<double>(std::max<uint64_t>(of, 1)); }
double least_agreement(const Peer& p) {
  const EmbreeFrameTimes& t = p.times.back();
  return std::min(std::min(share(p.different_ids, t.rays_primary), share(p.errors.primary, t.rays_primary)),
                  std::min(share(p.errors.shadow, t.rays_shadow), share(p.errors.bounce, t.rays_bounce)));
}
bool counts(const Peer& p) { return least_agreement(p) >= kEnoughRays; }

struct Comparison {
  OurTimes ours;
  uint64_t our_shadow = 0, our_bounce = 0, triangles_drawn = 0;
  Peer peers[2];
  Framebuffer our_picture, their_picture;
};

uint64_t count_of(const FrameStats& stats, const char* name) {
  for (const auto& [key, value] : stats.counts)
    if (key == name) return value;
  return 0;
}

// Idle threads of the other side may still spin for a moment.
void settle() { std::this_thread::sleep_for(std::chrono::milliseconds(3)); }

constexpr double kOutOfTheRace = 1.3;  // a mode that was this much slower than the best for every kind of ray is not tried again

// Each kind of ray in the mode that is fastest for it, in frames whose rays are all asked in one mode.
void find_modes(const Options& o, EmbreeFrame& frame, Peer& peer) {
  constexpr int kKinds = 3;
  EmbreeMode* const best[kKinds] = {&peer.modes.primary, &peer.modes.shadow, &peer.modes.bounce};
  double least[kKinds][kEmbreeModes], fastest[kKinds];
  std::fill_n(&least[0][0], kKinds * kEmbreeModes, 1e300), std::fill_n(fastest, kKinds, 1e300);
  Framebuffer out;
  for (int i = 0; i < o.tries; ++i) {
    for (int m = 0; m < kEmbreeModes; ++m) {
      bool in_the_race = i == 0;
      for (int k = 0; k < kKinds; ++k) in_the_race |= least[k][m] < kOutOfTheRace * fastest[k];
      if (!in_the_race) continue;
      const auto mode = static_cast<EmbreeMode>(m);
      const EmbreeFrameTimes t = frame.render(*peer.tracer, {mode, mode, mode}, out);
      const double ms[kKinds] = {t.primary, t.shadow, t.bounce};
      for (int k = 0; k < kKinds; ++k) {
        least[k][m] = std::min(least[k][m], ms[k]);
        if (least[k][m] < fastest[k]) fastest[k] = least[k][m], *best[k] = mode;
      }
    }
  }
}

// depth is near / (view depth), 0 for the background.
uint64_t count_different_ids(const Framebuffer& ours, const Framebuffer& theirs) {
  uint64_t different = 0;
  for (size_t i = 0; i < ours.primitive.size(); ++i) {
    if (ours.primitive[i] == theirs.primitive[i]) continue;
    const double a = ours.depth[i], b = theirs.depth[i];
    different += a == 0 || b == 0 || !(std::fabs(a - b) <= kSameDistance * std::max(a, b));
  }
  return different;
}

Result<void> judge(const Scene& scene, const demo::Job& job, Renderer& renderer, EmbreeFrame& frame, Comparison& c) {
  FrameRequest request;
  request.depth = request.primitive = true;
  const auto stats = renderer.render(scene, job.camera, job.settings, c.our_picture, request);
  if (!stats) return stats.error();
  c.our_shadow = count_of(stats.value(), "rays_shadow"), c.our_bounce = count_of(stats.value(), "rays_bounce");
  c.triangles_drawn = count_of(stats.value(), "triangles_drawn");
  for (Peer& peer : c.peers) {
    peer.errors = frame.judge(*peer.tracer, peer.modes, c.their_picture, request);
    peer.different_ids = count_different_ids(c.our_picture, c.their_picture);
    peer.picture = compare_pictures(c.our_picture.color, c.our_picture.depth, c.their_picture.color, c.their_picture.depth);
  }
  return {};
}

Result<void> run_in_turns(const Options& o, const Scene& scene, const demo::Job& job, Comparison& c) {
  const int threads = job.settings.threads;
  for (Peer& peer : c.peers) {
    const bool robust = &peer != c.peers;
    peer.name = robust ? "robust" : "fast";
    auto tracer = EmbreeTracer::create(scene.data(), robust, threads, 1);
    if (!tracer) return tracer.error();
    peer.tracer = std::move(tracer.value());
  }
  Parallel parallel(threads);
  EmbreeFrame frame(scene, job.camera, job.settings, parallel);
  Renderer renderer;
  for (Peer& peer : c.peers) find_modes(o, frame, peer);
  if (Result<void> done = judge(scene, job, renderer, frame, c); !done) return done;
  Framebuffer out;
  for (int i = -o.warmup; i < o.frames; ++i) {
    settle();
    const auto stats = renderer.render(scene, job.camera, job.settings, out);
    if (!stats) return stats.error();
    if (i >= 0) c.ours.add(stats.value().ms);
    for (Peer& peer : c.peers) {
      settle();
      const EmbreeFrameTimes t = frame.render(*peer.tracer, peer.modes, out);
      if (i >= 0) peer.times.push_back(t);
    }
  }
  return {};
}

void print_header() {
  std::printf("| scene | threads | shadow + mirror rays, M | ours: raster + shadow + mirror, ms | Embree: primary + shadow + mirror (making), ms | "
              "Embree robust: likewise | Embree : ours (with making) | robust : ours (with making) | our frame, ms | Embree's frame, ms | robust, ms | "
              "Embree : ours | robust : ours | same ids | same answers | counts |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
}

template <class... Number> std::string text(const char* format, Number... numbers) {
  char line[120];
  std::snprintf(line, sizeof line, format, numbers...);
  return line;
}

std::string rays_text(const Comparison& c) {
  const auto of = [](uint64_t shadow, uint64_t bounce) { return text("%.3f + %.3f", static_cast<double>(shadow) * 1e-6, static_cast<double>(bounce) * 1e-6); };
  const EmbreeFrameTimes& t = c.peers[0].times.back();
  const std::string ours = of(c.our_shadow, c.our_bounce), theirs = of(t.rays_shadow, t.rays_bounce);
  return ours == theirs ? ours : ours + "; Embree's " + theirs;
}

// What the table says of one of Embree's trees, ours beside it.
struct PeerText {
  std::string ms, visibility_ratio, frame, frame_ratio, ids, answers;
  PeerText(const Peer& p, const OurTimes& ours) {
    ms = text("%.1f + %.1f + %.1f (%.1f)", p.middle([](const EmbreeFrameTimes& t) { return t.primary; }),
              p.middle([](const EmbreeFrameTimes& t) { return t.shadow; }), p.middle([](const EmbreeFrameTimes& t) { return t.bounce; }), p.making());
    visibility_ratio = text("%.2f (%.2f)", p.traversal() / ours.visibility(), (p.traversal() + p.making()) / ours.visibility());
    frame = text("%.1f", p.frame()), frame_ratio = text("%.2f", p.frame() / median(ours.frame));
    const EmbreeFrameTimes& n = p.times.back();
    ids = text("%.3f", 100 * share(p.different_ids, n.rays_primary));
    answers = text("%.3f", 100 * share(p.errors.primary + p.errors.shadow + p.errors.bounce, n.rays_primary + n.rays_shadow + n.rays_bounce));
  }
};

void print_line(const Options& o, int threads, const Comparison& c) {
  const PeerText fast(c.peers[0], c.ours), robust(c.peers[1], c.ours);
  const std::string ours = text("%.1f + %.1f + %.1f", median(c.ours.front), median(c.ours.shadow), median(c.ours.bounce));
  const bool fast_counts = counts(c.peers[0]), robust_counts = counts(c.peers[1]);
  std::printf("| %s | %d | %s | %s | %s | %s | %s | %s | %.1f | %s | %s | %s | %s | %s, %s %% | %s, %s %% | %s |\n",
              scene_name(o.label, o.frame.scene_path()).c_str(), threads, rays_text(c).c_str(), ours.c_str(), fast.ms.c_str(), robust.ms.c_str(),
              fast.visibility_ratio.c_str(), robust.visibility_ratio.c_str(), median(c.ours.frame), fast.frame.c_str(), robust.frame.c_str(),
              fast.frame_ratio.c_str(), robust.frame_ratio.c_str(), fast.ids.c_str(), robust.ids.c_str(), fast.answers.c_str(), robust.answers.c_str(),
              fast_counts && robust_counts ? "yes" : robust_counts ? "robust only" : fast_counts ? "fast only" : "no");
}

nlohmann::ordered_json json_of(const Peer& p) {
  const EmbreeFrameTimes& n = p.times.back();
  nlohmann::ordered_json j = {{"modes", {{"primary", embree_mode_name(p.modes.primary)}, {"shadow", embree_mode_name(p.modes.shadow)},
                                         {"bounce", embree_mode_name(p.modes.bounce)}}},
                              {"rays", {{"primary", n.rays_primary}, {"shadow", n.rays_shadow}, {"bounce", n.rays_bounce}}},
                              {"different_rays", {{"primary", p.errors.primary}, {"shadow", p.errors.shadow}, {"bounce", p.errors.bounce}}},
                              {"different_ids", p.different_ids}, {"pixels_within_2_of_255", p.picture.share()},
                              {"traversal_median_ms", p.traversal()}, {"making_secondary_median_ms", p.making()},
                              {"frame_without_making_primary_median_ms", p.frame()}, {"counts", counts(p)}};
  for (const EmbreeFrameTimes& t : p.times)
    j["frames"].push_back({{"primary", t.primary}, {"shadow", t.shadow}, {"bounce", t.bounce}, {"making_primary", t.making_primary},
                           {"making_secondary", t.making_secondary}, {"shade", t.shade}, {"encode", t.encode}, {"frame", t.frame}});
  return j;
}

Result<void> write_json(const Options& o, const demo::Job& job, const Scene& scene, const Comparison& c) {
  nlohmann::ordered_json line = {{"scene", scene_name(o.label, o.frame.scene_path())}, {"triangles", scene.triangle_count()},
                                 {"lights", scene.light_count()}, {"width", job.settings.width}, {"height", job.settings.height},
                                 {"threads", job.settings.threads}, {"camera", demo::camera_text(job.camera)}, {"frames", o.frames}};
  const OurTimes& t = c.ours;
  line["ours"] = {{"rays", {{"shadow", c.our_shadow}, {"bounce", c.our_bounce}}}, {"triangles_drawn", c.triangles_drawn},
                  {"visibility_median_ms", t.visibility()}, {"frame_median_ms", median(t.frame)}, {"front_ms", t.front},
                  {"shadow_ms", t.shadow}, {"bounce_ms", t.bounce}, {"shade_ms", t.shade}, {"encode_ms", t.encode}, {"frame_ms", t.frame}};
  for (const Peer& p : c.peers) line[std::string("embree_") + p.name] = json_of(p);
  return append_line(o.json, line.dump());
}

Result<void> write_pictures(const Options& o, const Comparison& c) {
  const Image difference = difference_picture(c.our_picture.color, c.our_picture.depth, c.their_picture.color, c.their_picture.depth);
  for (const auto& [name, image] : {std::pair<const char*, const Image*>{"-ours.png", &c.our_picture.color},
                                    {"-embree.png", &c.their_picture.color}, {"-difference.png", &difference}})
    if (Result<void> done = write_png(o.pictures + name, *image); !done) return done.error();
  return {};
}

int compare(const CLI::App& app, const Options& o) {
  Result<demo::Job> loaded = o.frame.load();
  if (!loaded) return fail(app, loaded.error());
  demo::Job& job = loaded.value();
  job.settings = restrict_settings(job.settings);
  const Scene scene = opaque_scene(job.scene, job.settings.time);
  Comparison c;
  if (Result<void> done = run_in_turns(o, scene, job, c); !done) return fail(app, done.error());
  if (o.header) print_header();
  print_line(o, job.settings.threads, c);
  if (!o.json.empty())
    if (Result<void> done = write_json(o, job, scene, c); !done) return fail(app, done.error());
  if (!o.pictures.empty())
    if (Result<void> done = write_pictures(o, c); !done) return fail(app, done.error());
  const double least = std::min(least_agreement(c.peers[0]), least_agreement(c.peers[1]));
  if (o.require_agreement && least < kEnoughRays)
    return fail(app, Error{"only " + std::to_string(100 * least) + " % of the ids or of the rays of a kind agree; 99.9 % are needed"});
  return demo::kDone;
}

}  // namespace
}  // namespace spanray::peers

int main(int argc, char** argv) {
  CLI::App app("Our frame, rasterized and traced, against the same frame from Embree's rays alone: in turns", "embree_frame_bench");
  spanray::peers::Options options;
  spanray::peers::add_options(app, options);
  return spanray::peers::run(app, argc, argv, [&] { return spanray::peers::compare(app, options); });
}
