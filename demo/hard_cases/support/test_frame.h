// A frame for tests of single stages: scene, pool and flags kept alive behind one pointer.
#pragma once
#include <memory>
#include <utility>
#include <vector>

#include "frame/frame.h"
#include "frame/primary_rays.h"
#include "frame/transparency.h"
#include "scene/scene_builder.h"

namespace spanray {

struct TestFrame {
  SceneData scene;
  std::unique_ptr<Parallel> parallel;
  std::vector<uint32_t> material_flags;
  Frame frame;  // points into the members above: the struct never moves
  TestFrame() = default;
  TestFrame(const TestFrame&) = delete;
  TestFrame& operator=(const TestFrame&) = delete;
};

// To be called again after a change of materials.
inline void find_material_flags(TestFrame& t) {
  t.material_flags.clear();
  for (const Material& m : t.scene.materials) t.material_flags.push_back(material_flags(m, t.frame.settings));
  t.frame.material_flags = t.material_flags.data();
}

// settings.width and height give the picture, isa and threads (0: one) are used as they are; flags follow the materials.
inline std::unique_ptr<TestFrame> make_test_frame(SceneData scene, const Camera& camera, const Settings& settings) {
  auto t = std::make_unique<TestFrame>();
  t->scene = std::move(scene);
  t->parallel = std::make_unique<Parallel>(settings.threads > 0 ? settings.threads : 1);
  Frame& f = t->frame;
  f.scene = &t->scene;
  f.settings = settings;
  f.primary = make_primary_rays(camera, settings.width, settings.height);
  f.grid = TileGrid(settings.width, settings.height);
  f.isa = resolve_isa(settings.isa);
  f.parallel = t->parallel.get();
  find_material_flags(*t);
  return t;
}

inline Settings test_settings(int width, int height, Isa isa = Isa::kAuto, int threads = 1) {
  Settings s;
  s.width = width, s.height = height, s.isa = isa, s.threads = threads;
  return s;
}

// Every concrete instruction set that this machine can run.
inline std::vector<Isa> supported_isas() {
  std::vector<Isa> list;
  for (const Isa isa : {Isa::kScalar, Isa::kSse4, Isa::kAvx2, Isa::kAvx512})
    if (isa_supported(isa)) list.push_back(isa);
  return list;
}

// A bare triangle, counter-clockwise from the front; normals are filled in by the scene builder.
inline SoupTriangle soup_triangle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, uint32_t material = 0) {
  SoupTriangle t{};
  const glm::dvec3* corner[3] = {&a, &b, &c};
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) t.corner[i].position[k] = static_cast<float>((*corner[i])[k]);
  t.material = material;
  return t;
}

}  // namespace spanray
