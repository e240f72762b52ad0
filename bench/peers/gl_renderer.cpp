#include "gl_renderer.h"

#include <cstddef>
#include <string>

#include "frame/primary_rays.h"
#include "frame/transparency.h"
#include "gl_context.h"
#include "math/color.h"
#include "scene/default_view.h"

namespace spanray::peers {
namespace {

constexpr float kInversePi = 0.318309886f;
constexpr GLfloat kOffset = 1 - 2e-7f;  // a batch lies this much farther, relatively, than the one before

const TextureUse* use_of(const SceneData& scene, int32_t index) {
  if (index < 0 || scene.texture_uses[static_cast<size_t>(index)].texture < 0) return nullptr;
  return &scene.texture_uses[static_cast<size_t>(index)];
}

bool moved(const TextureUse* use) {
  if (use == nullptr) return false;
  return use->offset[0] != 0 || use->offset[1] != 0 || use->scale[0] != 1 || use->scale[1] != 1 || use->base != 0 || use->gain != 1;
}

void set_use(GLuint program, const char* uv, const char* range, const TextureUse* use) {
  if (use == nullptr) return;
  glUniform4f(glGetUniformLocation(program, uv), use->scale[0], use->scale[1], use->offset[0], use->offset[1]);
  glUniform2f(glGetUniformLocation(program, range), use->base, use->gain);
}

void set_lights(GLuint program, const char* name, const std::vector<Light>& lights, const float (Light::*field)[3], float scale) {
  std::vector<float> values;
  for (const Light& light : lights)
    for (const float v : light.*field) values.push_back(v * scale);
  if (!values.empty()) glUniform3fv(glGetUniformLocation(program, name), static_cast<GLsizei>(lights.size()), values.data());
}

// As render/render_frame.cpp takes them: a default light follows the eye.
std::vector<Light> lights_of(const SceneData& scene, const Camera& camera) {
  if (scene.light_follows_eye) return {default_light(scene, camera)};
  return scene.lights;
}

}  // namespace

GlRenderer::GlRenderer(const Scene& scene, const Settings& settings, const GlExactness& exactness, TexelFormat)
    : scene_(scene), settings_(settings) {
  style_.shading = settings.shading;
  style_.two_sided = settings.culling == Culling::kNone;
  style_.exactness = exactness;
  style_.blend_levels = settings.filter == Filter::kTrilinear;
  const bool with_faces = settings.shading == Shading::kFlat || exactness.horizon || settings.bump;
  mesh_ = make_gl_mesh(scene.data(), settings.culling == Culling::kNone, with_faces);
}

Result<std::unique_ptr<GlRenderer>> GlRenderer::create(const Scene& scene, const Settings& settings, const GlExactness& exactness,
                                                       TexelFormat texels) {
  std::unique_ptr<GlRenderer> renderer(new GlRenderer(scene, settings, exactness, texels));
  if (Result<void> made = renderer->make_target(); !made) return made.error();
  renderer->upload_mesh();
  if (Result<void> made = renderer->make_materials(texels); !made) return made.error();
  glViewport(0, 0, settings.width, settings.height);
  // Depth as ours: near / view depth, 1 at the near plane, 0 infinitely far away.
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GREATER);
  glClearDepth(0.0);
  glDisable(GL_DITHER);
  glFrontFace(GL_CW);  // rows count from the top, as in our pictures, so everything is seen mirrored
  if (settings.culling == Culling::kBack) glEnable(GL_CULL_FACE);
  else glDisable(GL_CULL_FACE);
  if (exactness.shader_srgb) glDisable(GL_FRAMEBUFFER_SRGB);
  else glEnable(GL_FRAMEBUFFER_SRGB);
  if (Result<void> done = check_gl("setup"); !done) return done.error();
  return renderer;
}

GlRenderer::~GlRenderer() {
  for (const auto& [features, program] : programs_) glDeleteProgram(program);
  for (const auto& textures : {colors_, masks_, heights_})
    for (const auto& [use, name] : textures) glDeleteTextures(1, &name);
  glDeleteFramebuffers(1, &target_);
  glDeleteRenderbuffers(2, planes_);
  glDeleteBuffers(3, buffers_);
  glDeleteVertexArrays(1, &arrays_);
}

Result<void> GlRenderer::make_target() {
  glGenFramebuffers(1, &target_);
  glGenRenderbuffers(2, planes_);
  glBindFramebuffer(GL_FRAMEBUFFER, target_);
  const GLenum format[2] = {static_cast<GLenum>(style_.exactness.shader_srgb ? GL_RGBA8 : GL_SRGB8_ALPHA8), GL_DEPTH_COMPONENT32F};
  const GLenum place[2] = {GL_COLOR_ATTACHMENT0, GL_DEPTH_ATTACHMENT};
  for (int i = 0; i < 2; ++i) {
    glBindRenderbuffer(GL_RENDERBUFFER, planes_[i]);
    glRenderbufferStorage(GL_RENDERBUFFER, format[i], settings_.width, settings_.height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, place[i], GL_RENDERBUFFER, planes_[i]);
  }
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) return Error{"OpenGL refuses the framebuffer"};
  return check_gl("framebuffer");
}

void GlRenderer::upload_mesh() {
  glGenVertexArrays(1, &arrays_);
  glBindVertexArray(arrays_);
  glGenBuffers(3, buffers_);
  const auto attribute = [](GLuint index, int floats, size_t stride, size_t offset) {
    glEnableVertexAttribArray(index);
    glVertexAttribPointer(index, floats, GL_FLOAT, GL_FALSE, static_cast<GLsizei>(stride), reinterpret_cast<const void*>(offset));
  };
  const auto upload = [](GLenum kind, GLuint buffer, const auto& array) {
    glBindBuffer(kind, buffer);
    glBufferData(kind, static_cast<GLsizeiptr>(array.size() * sizeof(array[0])), array.data(), GL_STATIC_DRAW);
  };
  upload(GL_ARRAY_BUFFER, buffers_[0], mesh_.vertices);
  attribute(0, 3, sizeof(Vertex), offsetof(Vertex, position));
  attribute(1, 3, sizeof(Vertex), offsetof(Vertex, normal));
  attribute(2, 2, sizeof(Vertex), offsetof(Vertex, uv));
  if (!mesh_.faces.empty()) {
    upload(GL_ARRAY_BUFFER, buffers_[1], mesh_.faces);
    attribute(3, 3, sizeof(GlFace), offsetof(GlFace, normal));
    attribute(4, 3, sizeof(GlFace), offsetof(GlFace, centroid));
    if (settings_.bump) {
      attribute(5, 3, sizeof(GlFace), offsetof(GlFace, tangent_u));
      attribute(6, 3, sizeof(GlFace), offsetof(GlFace, tangent_v));
    }
  }
  upload(GL_ELEMENT_ARRAY_BUFFER, buffers_[2], mesh_.indices);
}

Result<GLuint> GlRenderer::program_for(uint32_t features) {
  if (const auto it = programs_.find(features); it != programs_.end()) return it->second;
  Result<GLuint> program = make_program(scene_.data(), style_, features);
  if (program) programs_[features] = program.value();
  return program;
}

Result<void> GlRenderer::make_materials(TexelFormat texels) {
  const SceneData& scene = scene_.data();
  materials_.resize(scene.materials.size());
  std::vector<bool> used(scene.materials.size(), false);
  for (const GlBatch& batch : mesh_.batches) used[batch.material] = true;
  for (size_t i = 0; i < materials_.size(); ++i) {
    if (!used[i]) continue;
    const spanray::Material& m = scene.materials[i];
    const bool masked = effective_transparency(m, settings_) == MaterialTransparency::kMask;
    const TextureUse* color = settings_.textures ? use_of(scene, m.map_diffuse) : nullptr;
    const TextureUse* opacity = masked ? use_of(scene, m.map_opacity) : nullptr;
    const TextureUse* height = settings_.bump && settings_.shading == Shading::kPhong ? use_of(scene, m.map_bump) : nullptr;
    uint32_t features = 0;
    if (color != nullptr) features |= kTextured;
    if (opacity != nullptr) features |= kMasked;
    if (m.specular[0] > 0 || m.specular[1] > 0 || m.specular[2] > 0) features |= kHighlight;
    if (height != nullptr) features |= kBumped;
    if (moved(color) || moved(opacity) || moved(height)) features |= kMovedUv;
    const Result<GLuint> program = program_for(features);
    if (!program) return program.error();
    if (color != nullptr && colors_.count(m.map_diffuse) == 0)
      colors_[m.map_diffuse] = make_color_texture(scene, *color, settings_.filter, texels);
    if (opacity != nullptr && masks_.count(m.map_opacity) == 0)
      masks_[m.map_opacity] = make_mask_texture(scene, *opacity, settings_.filter);
    if (height != nullptr && heights_.count(m.map_bump) == 0) heights_[m.map_bump] = make_height_texture(scene, *height);
    materials_[i] = {program.value(), color != nullptr ? colors_[m.map_diffuse] : 0, opacity != nullptr ? masks_[m.map_opacity] : 0,
                     height != nullptr ? heights_[m.map_bump] : 0, &m};
  }
  return check_gl("materials");
}

void GlRenderer::set_frame_uniforms(GLuint program, const Camera& camera) const {
  const SceneData& scene = scene_.data();
  const PrimaryRays rays = make_primary_rays(camera, settings_.width, settings_.height);
  // Pixels (frame/rays.h) to clip space; row 0 at the bottom of OpenGL's window, which is the first row that is read back.
  const glm::dvec3 rows[4] = {rays.pixel_row_x * (2.0 / settings_.width) - rays.forward,
                              rays.pixel_row_y * (2.0 / settings_.height) - rays.forward, glm::dvec3(0), rays.forward};
  float m[16];
  for (int r = 0; r < 4; ++r) {
    for (int c = 0; c < 3; ++c) m[4 * r + c] = static_cast<float>(rows[r][c]);
    m[4 * r + 3] = static_cast<float>(r == 2 ? rays.near_plane : -dot3(rows[r], rays.eye));
  }
  glUniformMatrix4fv(glGetUniformLocation(program, "uClipFromWorld"), 1, GL_TRUE, m);
  glUniform3f(glGetUniformLocation(program, "uEye"), static_cast<float>(rays.eye.x), static_cast<float>(rays.eye.y), static_cast<float>(rays.eye.z));
  const std::vector<Light> lights = lights_of(scene, camera);
  set_lights(program, "uPosition", lights, &Light::position, 1);
  set_lights(program, "uDirection", lights, &Light::direction, 1);
  set_lights(program, "uFalloff", lights, &Light::attenuation, 1);
  set_lights(program, "uIntensity", lights, &Light::intensity, kInversePi);
  glUniform1i(glGetUniformLocation(program, "uColor"), 0);
  glUniform1i(glGetUniformLocation(program, "uOpacity"), 1);
  glUniform1i(glGetUniformLocation(program, "uHeight"), 2);
}

void GlRenderer::set_material(const Material& material) const {
  const SceneData& scene = scene_.data();
  const spanray::Material& m = *material.source;
  const GLuint p = material.program;
  const auto color = [p](const char* name, const float v[3]) { glUniform3f(glGetUniformLocation(p, name), v[0], v[1], v[2]); };
  const float constant[3] = {m.ambient[0] * scene.ambient_radiance[0], m.ambient[1] * scene.ambient_radiance[1],
                             m.ambient[2] * scene.ambient_radiance[2]};
  color("uConstant", constant);
  color("uKd", m.diffuse);
  color("uKs", m.specular);
  color("uEmission", m.emission);
  glUniform1f(glGetUniformLocation(p, "uShininess"), m.shininess);
  set_use(p, "uColorUv", "uColorRange", use_of(scene, m.map_diffuse));
  set_use(p, "uOpacityUv", "uOpacityRange", use_of(scene, m.map_opacity));
  if (const TextureUse* const height = use_of(scene, m.map_bump); material.height != 0) {
    glUniform4f(glGetUniformLocation(p, "uHeightUv"), height->scale[0], height->scale[1], height->offset[0], height->offset[1]);
    glUniform1f(glGetUniformLocation(p, "uHeightScale"), height->gain * height->bump_multiplier);
    glActiveTexture(GL_TEXTURE2);
    glBindTexture(GL_TEXTURE_2D, material.height);
  }
  glActiveTexture(GL_TEXTURE1);
  glBindTexture(GL_TEXTURE_2D, material.opacity);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, material.color);
}

void GlRenderer::draw(const Camera& camera) {
  const SceneData& scene = scene_.data();
  glBindFramebuffer(GL_FRAMEBUFFER, target_);
  float background[3];
  for (int c = 0; c < 3; ++c)
    background[c] = style_.exactness.shader_srgb ? static_cast<float>(srgb8_from_linear(scene.background[c])) / 255.0f : scene.background[c];
  glClearColor(background[0], background[1], background[2], 1);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  GLuint current = 0;
  GLfloat nearer = 1;
  for (const GlBatch& batch : mesh_.batches) {
    const Material& material = materials_[batch.material];
    if (material.program != current) {
      current = material.program;
      glUseProgram(current);
      set_frame_uniforms(current, camera);
    }
    set_material(material);
    glUniform1f(glGetUniformLocation(current, "uNearer"), nearer);
    if (style_.exactness.offset) nearer *= kOffset;
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(batch.count), GL_UNSIGNED_INT, reinterpret_cast<const void*>(size_t{4} * batch.first));
  }
  glFinish();
}

void GlRenderer::read(Image& out) {
  out.width = settings_.width, out.height = settings_.height;
  out.rgba.resize(size_t{4} * static_cast<size_t>(out.width) * static_cast<size_t>(out.height));
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, out.width, out.height, GL_RGBA, GL_UNSIGNED_BYTE, out.rgba.data());
}

std::vector<float> GlRenderer::read_depth() {
  std::vector<float> depth(static_cast<size_t>(settings_.width) * static_cast<size_t>(settings_.height));
  glReadPixels(0, 0, settings_.width, settings_.height, GL_DEPTH_COMPONENT, GL_FLOAT, depth.data());
  return depth;
}

}  // namespace spanray::peers
