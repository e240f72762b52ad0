// One scene drawn by OpenGL into a picture like ours: everything uploaded once, a frame is clear, uniforms and draws.
#pragma once
#include <map>
#include <memory>
#include <vector>

#include "gl_mesh.h"
#include "gl_program.h"
#include "gl_texture.h"
#include "spanray/image.h"
#include "spanray/scene.h"

namespace spanray::peers {

class GlRenderer {
 public:
  // The context must be current. settings: size, shading, filter, culling, textures, bump, transparency.
  static Result<std::unique_ptr<GlRenderer>> create(const Scene& scene, const Settings& settings, const GlExactness& exactness,
                                                    TexelFormat texels);
  GlRenderer(const GlRenderer&) = delete;
  GlRenderer& operator=(const GlRenderer&) = delete;
  ~GlRenderer();

  // Clears and draws; returns when the picture is finished in the driver's memory.
  void draw(const Camera& camera);
  // The picture, top row first, into memory of ours.
  void read(Image& out);
  // near / view depth as Framebuffer::depth, 0 = background.
  std::vector<float> read_depth();

 private:
  GlRenderer(const Scene& scene, const Settings& settings, const GlExactness& exactness, TexelFormat texels);
  struct Material {
    GLuint program = 0, color = 0, opacity = 0, height = 0;
    const spanray::Material* source = nullptr;
  };
  Result<void> make_target();
  Result<void> make_materials(TexelFormat texels);
  void upload_mesh();
  Result<GLuint> program_for(uint32_t features);
  void set_frame_uniforms(GLuint program, const Camera& camera) const;
  void set_material(const Material& material) const;

  Scene scene_;
  Settings settings_;
  GlStyle style_;
  std::map<uint32_t, GLuint> programs_;
  std::map<int32_t, GLuint> colors_, masks_, heights_;  // by texture use
  std::vector<Material> materials_;
  GlMesh mesh_;
  GLuint target_ = 0, buffers_[3] = {}, planes_[2] = {}, arrays_ = 0;
};

}  // namespace spanray::peers
