// A whole frame from Embree's rays alone: primary rays, a shadow ray a light, mirror rays with theirs. Origins, directions, shading and
// bytes are made by our own stages, so that the two renderers differ in nothing but who finds what is seen.
#pragma once
#include "embree_tracer.h"
#include "ray/bvh.h"
#include "render/plan.h"
#include "render/tile.h"

namespace spanray::peers {

// How each kind of ray is asked.
struct EmbreeModes {
  EmbreeMode primary = EmbreeMode::kCoherent16, shadow = EmbreeMode::kCoherent16, bounce = EmbreeMode::kCoherent16;
};

// What a frame of Embree's took, in milliseconds of thread time divided by threads, but for the wall time of the frame. The first three:
// reading rays from our arrays, traversal, writing answers.
struct EmbreeFrameTimes {
  double primary = 0, shadow = 0, bounce = 0;
  double making_primary = 0, making_secondary = 0;  // of rays
  double shade = 0, encode = 0;
  double frame = 0;
  uint64_t rays_primary = 0, rays_shadow = 0, rays_bounce = 0;
  double traversal() const { return primary + shadow + bounce; }
};

// Answers that are not those of our tracer to the very same rays.
struct EmbreeFrameErrors {
  uint64_t primary = 0, shadow = 0, bounce = 0;
};

class EmbreeFrame {
 public:
  // scene: at rest, without masks; settings: one sample a pixel, both sides of a triangle seen, opaque, not Gouraud. All must outlive it.
  EmbreeFrame(const Scene& scene, const Camera& camera, const Settings& settings, Parallel& parallel);
  ~EmbreeFrame();
  EmbreeFrame(const EmbreeFrame&) = delete;
  EmbreeFrame& operator=(const EmbreeFrame&) = delete;

  // out: color, and what else the request asks for.
  EmbreeFrameTimes render(const EmbreeTracer& tracer, const EmbreeModes& modes, Framebuffer& out, const FrameRequest& request = {});

  // The same, asking our tracer about each ray, too.
  EmbreeFrameErrors judge(const EmbreeTracer& tracer, const EmbreeModes& modes, Framebuffer& out, const FrameRequest& request);

 private:
  struct Worker;
  struct Asked {
    const EmbreeTracer& tracer;
    const EmbreeModes& modes;
    bool judged;
  };
  void render_all(const Asked& asked, Framebuffer& out, const FrameRequest& request);
  void render_chunk(const Asked& asked, const FrameJob& job, const Chunk& chunk, Worker& w) const;
  void trace_primary(const Asked& asked, Worker& w) const;
  void shade_level(const Asked& asked, const FrameJob& job, Worker& w, Level& level, bool primary) const;
  void find_lit(const Asked& asked, const SurfaceBatch& surfaces, int light, Worker& w, uint32_t* lit) const;
  bool start_bounce(const Asked& asked, const Level& level, Level& next, Worker& w) const;

  Plan plan_;
  Parallel& parallel_;
  Frame frame_;
  Bvh bvh_;  // ours, for the judge
  std::vector<std::unique_ptr<Worker>> workers_;
};

}  // namespace spanray::peers
