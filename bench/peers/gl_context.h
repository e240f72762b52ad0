// An OpenGL context without a window, on Mesa's software renderer and on nothing else.
#pragma once
#include <memory>
#include <string>

#include "spanray/result.h"

namespace spanray::peers {

class GlContext {
 public:
  // Makes the context current on this thread. rasterizer_threads: LP_NUM_THREADS. Mesa reads it once, so a process has one
  // number of threads. Errors: no surfaceless EGL, no OpenGL 4.5, or a renderer that is not llvmpipe.
  static Result<std::unique_ptr<GlContext>> create(int rasterizer_threads);
  ~GlContext();
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;

  const std::string& renderer() const { return renderer_; }  // "llvmpipe (LLVM 15.0.6, 256 bits)"
  const std::string& version() const { return version_; }    // "4.5 (Core Profile) Mesa 22.3.6"

 private:
  GlContext() = default;
  void* display_ = nullptr;
  void* context_ = nullptr;
  std::string renderer_, version_;
};

// The first OpenGL error since the last call, in words.
Result<void> check_gl(const char* where);

}  // namespace spanray::peers
