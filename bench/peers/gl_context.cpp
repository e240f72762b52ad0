#include "gl_context.h"

#include <cstdlib>

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include "gl.h"

namespace spanray::peers {
namespace {

const EGLint kConfig[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_NONE};
// 4.5: glClipControl, for the depth that we have too (reversed, far plane at infinity).
const EGLint kVersion[] = {EGL_CONTEXT_MAJOR_VERSION, 4, EGL_CONTEXT_MINOR_VERSION, 5, EGL_CONTEXT_OPENGL_PROFILE_MASK,
                           EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};

std::string text_of(GLenum name) {
  const GLubyte* text = glGetString(name);
  return text == nullptr ? "" : reinterpret_cast<const char*>(text);
}

}  // namespace

Result<std::unique_ptr<GlContext>> GlContext::create(int rasterizer_threads) {
  setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
  setenv("GALLIUM_DRIVER", "llvmpipe", 1);
  setenv("LP_NUM_THREADS", std::to_string(rasterizer_threads).c_str(), 1);
  std::unique_ptr<GlContext> context(new GlContext);
  const EGLDisplay display = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, nullptr, nullptr);
  if (display == EGL_NO_DISPLAY || !eglInitialize(display, nullptr, nullptr)) return Error{"EGL has no surfaceless platform"};
  context->display_ = display;
  eglBindAPI(EGL_OPENGL_API);
  EGLConfig config = nullptr;
  EGLint configs = 0;
  if (!eglChooseConfig(display, kConfig, &config, 1, &configs) || configs == 0) return Error{"EGL has no configuration for OpenGL"};
  context->context_ = eglCreateContext(display, config, EGL_NO_CONTEXT, kVersion);
  if (context->context_ == EGL_NO_CONTEXT) return Error{"EGL makes no OpenGL 4.5 core context"};
  if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context->context_)) return Error{"the OpenGL context cannot be made current"};
  context->renderer_ = text_of(GL_RENDERER);
  context->version_ = text_of(GL_VERSION);
  if (context->renderer_.rfind("llvmpipe", 0) != 0) return Error{"the OpenGL renderer is " + context->renderer_ + ", not llvmpipe"};
  return context;
}

GlContext::~GlContext() {
  if (display_ == nullptr) return;
  eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  if (context_ != nullptr) eglDestroyContext(display_, context_);
  eglTerminate(display_);
}

Result<void> check_gl(const char* where) {
  const GLenum error = glGetError();
  if (error == GL_NO_ERROR) return {};
  return Error{std::string("OpenGL error ") + std::to_string(error) + " in " + where};
}

}  // namespace spanray::peers
