// Reads one texture at chosen uv and footprint, through whole surfaces: a triangle with uv = uv_scale * (x, y), seen along -z.
#pragma once
#include <cmath>

#include "support/surface_oracle.h"

namespace spanray {

inline constexpr Filter kFilters[] = {Filter::kNearest, Filter::kBilinear, Filter::kTrilinear};

class TextureProbe {
 public:
  // setup adds textures and sets the slots of material 0 (white, every reflectance 1).
  explicit TextureProbe(const std::function<void(SceneData&, Material&)>& setup, double uv_scale = 1) {
    Material m;
    for (float* color : {m.ambient, m.diffuse, m.specular, m.emission, m.mirror}) color[0] = color[1] = color[2] = 1;
    m.shininess = 100;
    SoupTriangle t = soup_triangle({-4, -4, 0}, {8, -4, 0}, {-4, 8, 0});
    t = with_uv(t, glm::dvec2(-4 * uv_scale), {8 * uv_scale, -4 * uv_scale}, {-4 * uv_scale, 8 * uv_scale});
    SceneData scene = make_test_scene({t}, {m});
    setup(scene, scene.materials[0]);
    frame_ = make_test_frame(std::move(scene), Camera{}, test_settings(16, 16));
    plan_all(frame_->frame);
  }
  Frame& frame() { return frame_->frame; }
  SceneData& scene() { return frame_->scene; }
  // One more point (x, y) in [-3.9, 1.9]; its footprint is step_x by step_y along the axes (in x and y).
  void add(double x, double y, double step_x = 0, double step_y = 0) {
    const int ray = add_ray(rays_, {x, y, 1}, {0, 0, -1});
    for (int k = 0; k < 3; ++k)
      for (auto* a : {&rays_.direction_dx[k], &rays_.direction_dy[k], &rays_.origin_dx[k], &rays_.origin_dy[k]}) a->push_back(0);
    rays_.origin_dx[0][static_cast<size_t>(ray)] = static_cast<float>(step_x);
    rays_.origin_dy[1][static_cast<size_t>(ray)] = static_cast<float>(step_y);
    add_hit(hits_, 0, static_cast<uint32_t>(ray), 0);
  }
  int count() const { return hits_.count; }
  const RayBatch& rays() const { return rays_; }
  const SurfaceBatch& run() {
    hits_.rays = &rays_;
    resolve_surfaces(frame_->frame, hits_, surfaces_);
    return surfaces_;
  }
  const SurfaceBatch& run(Isa isa) {
    frame_->frame.isa = isa;
    return run();
  }

 private:
  std::unique_ptr<TestFrame> frame_;
  RayBatch rays_;
  HitBatch hits_;
  SurfaceBatch surfaces_;
};

// Writes `value(level)` into every texel of each level of the last texture.
inline void fill_levels(SceneData& scene, const std::function<uint16_t(int level)>& value) {
  const Texture& t = scene.textures.back();
  for (int k = 0; k < t.levels; ++k)
    for (int i = 0; i < std::max(1, t.width >> k) * std::max(1, t.height >> k); ++i) {
      const uint16_t v = value(k);
      scene.texels[static_cast<size_t>(t.offset[k] + i)] = {v, v, v, v};
    }
}

}  // namespace spanray
