// From scene, camera and settings to a picture.
#pragma once
#include <memory>
#include <vector>

#include "spanray/image.h"
#include "spanray/scene.h"
#include "spanray/stats.h"

namespace spanray {

class Ladder;  // engine/frame/ladder.h: the hash ladder

struct FrameRequest {
  // Which arrays of Framebuffer to fill besides color.
  bool radiance = false, depth = false, primitive = false, normal = false, uv = false;
  Ladder* ladder = nullptr;
};

// Keeps buffers and acceleration structures between frames. One frame at a time.
class Renderer {
 public:
  Renderer();
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  // The picture is a pure function of scene, camera and settings, threads and isa excepted: those change nothing.
  // Errors: settings or camera out of range, an instruction set that this machine lacks, out of memory.
  Result<FrameStats> render(const Scene& scene, const Camera& camera, const Settings& settings, Framebuffer& out,
                            const FrameRequest& request = {});

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// What this frame would need, and why. Needs no rendering.
std::vector<PlanLine> plan_frame(const Scene& scene, const Settings& settings);

}  // namespace spanray
