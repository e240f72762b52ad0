// llvmpipe_bench SCENE: our renderer and Mesa llvmpipe draw the same frame in turns; times, and how far the pictures agree.
// No shadows, no reflections; height maps with --with-bump; what is translucent is drawn opaque by both. A line of a table on stdout.
// Exit 0 done, 1 could not (or the pictures disagree and --require-agreement was given), 2 wrong usage, 77 no llvmpipe here.
#include <cstdio>
#include <memory>
#include <sstream>
#include <thread>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "agreement.h"
#include "frame_options.h"
#include "gl_context.h"
#include "gl_renderer.h"
#include "measure.h"
#include "spanray/render.h"
#include "spanray/settings_text.h"

namespace spanray::peers {
namespace {

constexpr int kSkipped = 77;  // what ctest takes for "skipped"

struct Options {
  demo::FrameOptions frame;
  int frames = 15, warmup = 3;
  GlExactness exactness;
  TexelFormat texels = TexelFormat::kSrgb8;
  bool fixed_exactness = false;  // --gl: as given instead of the cheapest that agrees
  bool require_agreement = false, header = false, with_bump = false;
  std::string json, pictures, label;
};

std::string exactness_text(const GlExactness& e) {
  std::string text;
  for (const auto& [on, word] : {std::pair{e.offset, "offset"}, std::pair{e.horizon, "horizon"}, std::pair{e.own_lod, "lod"}})
    if (on) text += (text.empty() ? "" : "+") + std::string(word);
  return text.empty() ? "plain" : text;
}

GlExactness read_exactness(const std::string& words) {
  GlExactness e;
  std::stringstream stream(words);
  for (std::string word; std::getline(stream, word, '+');) {
    if (word == "offset") e.offset = true;
    else if (word == "horizon") e.horizon = true;
    else if (word == "lod") e.own_lod = true;
    else if (word != "plain") throw CLI::ValidationError("--gl", "'" + word + "' is not plain, offset, horizon or lod");
  }
  return e;
}

void add_options(CLI::App& app, Options& o) {
  o.frame.add_to(app);
  app.add_option("--frames", o.frames, "Timed frames of each, in turns")->check(CLI::Range(1, 100000));
  app.add_option("--warmup", o.warmup, "Frames before the clock starts")->check(CLI::Range(1, 1000));
  const auto gl = [&o](const std::string& words) { o.exactness = read_exactness(words), o.fixed_exactness = true; };
  app.add_option_function<std::string>("--gl", gl,
                                       "plain, or what the GL program adds to agree, joined by +: offset (coplanar surfaces in our order), "
                                       "horizon (no light from below the geometric horizon), lod (our mip level formula). Without this "
                                       "option: the cheapest that agrees");
  app.add_flag("--with-bump", o.with_bump, "Both draw height maps (map_bump), Phong shading only; normal maps are ours alone");
  app.add_flag("--gl-shader-srgb", o.exactness.shader_srgb, "GL encodes sRGB in the shader instead of the framebuffer");
  app.add_flag_callback("--gl-rgba16", [&o] { o.texels = TexelFormat::kRgba16; }, "GL samples our 16-bit linear texels instead of 8-bit sRGB");
  app.add_option("--json", o.json, "Append one JSON object, a line, to this file");
  app.add_option("--pictures", o.pictures, "Write PREFIX-ours.png, PREFIX-theirs.png and PREFIX-difference.png");
  app.add_option("--label", o.label, "Name of the scene in the table");
  app.add_flag("--header", o.header, "Print the head of the table before the line");
  app.add_flag("--require-agreement", o.require_agreement, "Exit 1 unless 99.9 % of the pixels agree");
}

// One side of the comparison, median milliseconds.
struct Times {
  std::vector<double> frame, with_read, cpu;
  void add(double frame_ms, double with_read_ms, double cpu_ms) {
    frame.push_back(frame_ms), with_read.push_back(with_read_ms), cpu.push_back(cpu_ms);
  }
};

struct Comparison {
  Times ours, theirs;
  Agreement agreement;
  Framebuffer our_picture;
  Image their_picture;
  std::vector<float> their_depth;
  std::string gl_renderer, gl_version;
};

// Idle threads of the other side may still spin for a moment.
void settle() { std::this_thread::sleep_for(std::chrono::milliseconds(3)); }

Result<void> run_in_turns(const Options& o, const demo::Job& job, GlRenderer& gl, Comparison& c) {
  Renderer renderer;
  Framebuffer picture;
  for (int i = -o.warmup; i < o.frames; ++i) {
    settle();
    const Stopwatch our_watch;
    const auto stats = renderer.render(job.scene, job.camera, job.settings, picture);
    if (!stats) return stats.error();
    if (i >= 0) c.ours.add(our_watch.wall(), our_watch.wall(), our_watch.cpu());
    settle();
    const Stopwatch their_watch;
    gl.draw(job.camera);
    const double drawn = their_watch.wall();
    gl.read(c.their_picture);
    if (i >= 0) c.theirs.add(drawn, their_watch.wall(), their_watch.cpu());
  }
  FrameRequest request;
  request.depth = true;
  const auto stats = renderer.render(job.scene, job.camera, job.settings, c.our_picture, request);
  if (!stats) return stats.error();
  c.their_depth = gl.read_depth();
  c.agreement = compare_pictures(c.our_picture.color, c.our_picture.depth, c.their_picture, c.their_depth);
  return check_gl("frames");
}

// Cheapest first.
const GlExactness kLadder[] = {{}, {.offset = true}, {.horizon = true}, {.offset = true, .horizon = true},
                               {.offset = true, .horizon = true, .own_lod = true}};

// The peer with the cheapest program whose picture agrees with ours; with the most exact one if none does.
Result<std::unique_ptr<GlRenderer>> make_peer(Options& o, const demo::Job& job) {
  if (o.fixed_exactness) return GlRenderer::create(job.scene, job.settings, o.exactness, o.texels);
  Renderer renderer;
  Framebuffer ours;
  FrameRequest request;
  request.depth = true;
  if (const auto stats = renderer.render(job.scene, job.camera, job.settings, ours, request); !stats) return stats.error();
  for (const GlExactness& step : kLadder) {
    const bool shader_srgb = o.exactness.shader_srgb;
    o.exactness = step, o.exactness.shader_srgb = shader_srgb;
    auto peer = GlRenderer::create(job.scene, job.settings, o.exactness, o.texels);
    if (!peer) return peer;
    Image theirs;
    peer.value()->draw(job.camera);
    peer.value()->read(theirs);
    const bool last = &step == std::end(kLadder) - 1;
    if (last || compare_pictures(ours.color, ours.depth, theirs, peer.value()->read_depth()).counts()) return peer;
  }
  return Error{"no GL program"};
}

// What both can draw alike.
void restrict_settings(Settings& s, bool with_bump) {
  s.shadows = Shadows::kNone;
  s.reflections = Reflections::kNone;
  s.transparency = Transparency::kNone;
  s.bump = with_bump;
  if (s.threads == 0) s.threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
}

std::string name_of(const Options& o) { return scene_name(o.label, o.frame.scene_path()); }

void print_line(const Options& o, const Settings& s, const Comparison& c) {
  if (o.header) {
    std::printf("| scene | size | threads | shading | filter | ours, ms | llvmpipe, ms | llvmpipe without read-back, ms | llvmpipe : ours | "
                "GL program | agreement | counts |\n|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  }
  const double ours = median(c.ours.with_read), theirs = median(c.theirs.with_read);
  std::printf("| %s | %dx%d | %d | %s | %s | %.1f | %.1f | %.1f | %.2f | %s | %.3f %% | %s |\n", name_of(o).c_str(), s.width, s.height, s.threads,
              enum_text(s.shading), s.textures ? enum_text(s.filter) : "no textures", ours, theirs, median(c.theirs.frame), theirs / ours,
              exactness_text(o.exactness).c_str(), 100 * c.agreement.share(), c.agreement.counts() ? "yes" : "no");
}

Result<void> write_json(const Options& o, const demo::Job& job, const Comparison& c) {
  const auto side = [](const Times& t) {
    return nlohmann::ordered_json{{"median_ms", median(t.with_read)}, {"median_without_read_ms", median(t.frame)}, {"median_cpu_ms", median(t.cpu)},
                                  {"all_ms", t.with_read}};
  };
  const Agreement& a = c.agreement;
  std::vector<uint64_t> histogram(a.by_difference, a.by_difference + 256);
  while (histogram.size() > 1 && histogram.back() == 0) histogram.pop_back();
  const Settings& s = job.settings;
  const nlohmann::ordered_json line = {
      {"scene", name_of(o)}, {"scene_hash", job.scene.hash()}, {"triangles", job.scene.triangle_count()}, {"lights", job.scene.light_count()},
      {"width", s.width}, {"height", s.height}, {"threads", s.threads}, {"shading", enum_text(s.shading)}, {"filter", enum_text(s.filter)},
      {"textures", s.textures}, {"culling", enum_text(s.culling)}, {"camera", demo::camera_text(job.camera)}, {"frames", o.frames},
      {"ours", side(c.ours)}, {"theirs", side(c.theirs)}, {"ratio", median(c.theirs.with_read) / median(c.ours.with_read)},
      {"ratio_cpu", median(c.theirs.cpu) / median(c.ours.cpu)}, {"agreement", a.share()}, {"counts", a.counts()}, {"pixels_both", a.both},
      {"pixels_only_ours", a.only_ours}, {"pixels_only_theirs", a.only_theirs}, {"pixels_by_difference", histogram},
      {"gl", {{"renderer", c.gl_renderer}, {"version", c.gl_version}, {"program", exactness_text(o.exactness)},
              {"shader_srgb", o.exactness.shader_srgb}, {"texels", o.texels == TexelFormat::kSrgb8 ? "srgb8" : "rgba16"}}}};
  return append_line(o.json, line.dump());
}

Result<void> write_pictures(const Options& o, const Comparison& c) {
  const Image difference = difference_picture(c.our_picture.color, c.our_picture.depth, c.their_picture, c.their_depth);
  for (const auto& [name, image] : {std::pair<const char*, const Image*>{"-ours.png", &c.our_picture.color},
                                    {"-theirs.png", &c.their_picture}, {"-difference.png", &difference}})
    if (Result<void> done = write_png(o.pictures + name, *image); !done) return done.error();
  return {};
}

int compare(const CLI::App& app, Options& o) {
  Result<demo::Job> loaded = o.frame.load();
  if (!loaded) return fail(app, loaded.error());
  demo::Job& job = loaded.value();
  restrict_settings(job.settings, o.with_bump);
  const auto context = GlContext::create(job.settings.threads);
  if (!context) return fail(app, context.error(), kSkipped);
  const auto gl = make_peer(o, job);
  if (!gl) return fail(app, gl.error());
  Comparison c;
  c.gl_renderer = context.value()->renderer(), c.gl_version = context.value()->version();
  if (Result<void> done = run_in_turns(o, job, *gl.value(), c); !done) return fail(app, done.error());
  print_line(o, job.settings, c);
  if (!o.json.empty())
    if (Result<void> done = write_json(o, job, c); !done) return fail(app, done.error());
  if (!o.pictures.empty())
    if (Result<void> done = write_pictures(o, c); !done) return fail(app, done.error());
  if (!o.require_agreement || c.agreement.counts()) return demo::kDone;
  return fail(app, Error{"the pictures agree on " + std::to_string(100 * c.agreement.share()) + " % of the pixels; 99.9 % are needed"});
}

}  // namespace
}  // namespace spanray::peers

int main(int argc, char** argv) {
  CLI::App app("Our renderer against Mesa llvmpipe: the same scene, camera, shading and threads, in turns", "llvmpipe_bench");
  spanray::peers::Options options;
  spanray::peers::add_options(app, options);
  return spanray::peers::run(app, argc, argv, [&] { return spanray::peers::compare(app, options); });
}
