#include "reference/emitters.h"

#include <algorithm>
#include <cmath>

namespace spanray::reference {

double Emitters::glow(const Material& m) const {
  const double ke = std::max({m.emission[0], m.emission[1], m.emission[2]});
  if (m.map_emission < 0) return ke;
  const TextureUse& map = world_.scene.texture_uses[static_cast<size_t>(m.map_emission)];
  // Never zero where the texture might glow; without a texture (switched off, or missing) Ke alone counts.
  return ke * std::max(1.0, std::fabs(double{map.base}) + std::fabs(double{map.gain}));
}

Emitters::Emitters(const World& world) : world_(world) {
  const SceneData& scene = world.scene;
  for (const Material& m : scene.materials) glow_.push_back(glow(m));
  for (uint32_t i = 0; i < scene.triangles.size(); ++i) {
    const double radiance = glow_[material_of(scene.triangles[i])];
    if (!(radiance > 0)) continue;
    Item item{i, 0, {}};
    for (int k = 0; k < 3; ++k) item.corner[k] = to_dvec(scene.vertices[scene.triangles[i].vertex[k]].position);
    const double area = 0.5 * length3(cross3(item.corner[1] - item.corner[0], item.corner[2] - item.corner[0]));
    if (!(area > 0)) continue;
    item.until = power_ += area * radiance;
    list_.push_back(item);
  }
  for (Item& item : list_) item.until /= power_;
}

double Emitters::density(uint32_t primitive) const {
  if (!world_.scene.is_triangle(primitive)) return 0;
  return power_ > 0 ? glow_[material_of(world_.scene, primitive)] / power_ : 0;
}

Emitters::Point Emitters::pick(double which, double u, double v) const {
  const auto found =
      std::upper_bound(list_.begin(), list_.end(), which, [](double w, const Item& item) { return w < item.until; });
  const Item& item = found == list_.end() ? list_.back() : *found;
  const double root = std::sqrt(u);  // uniform in area (Turk 1990, "Generating Random Points in Triangles")
  const double b1 = 1 - root, b2 = v * root;
  return {item.primitive, item.corner[0] * (1 - b1 - b2) + item.corner[1] * b1 + item.corner[2] * b2};
}

}  // namespace spanray::reference
