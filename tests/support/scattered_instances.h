// Instances of balls and messy parts among triangles, and trees of one level and of two over them.
#pragma once
#include <cmath>
#include <memory>
#include <vector>

#include "ray/bvh_data.h"
#include "ray/bvh_instances.h"
#include "support/instance_scene.h"
#include "support/test_frame.h"

namespace spanray {

inline Bvh build(const TestFrame& t, InstanceUse use, TreeQuality quality = TreeQuality::kFast) {
  return build_bvh(t.scene, t.material_flags.data(), 0, 0, *t.parallel, quality, false, use);
}

inline size_t places(const Bvh& bvh) { return bvh.data().instances ? bvh.data().instances->placed.size() : 0; }

inline std::unique_ptr<TestFrame> frame_of_scene(SceneData scene) { return make_test_frame(std::move(scene), Camera(), test_settings(16, 16)); }

inline std::vector<SoupTriangle> ball(int levels, double size = 1) {
  std::vector<SoupTriangle> soup;
  add_mesh(soup, make_sphere(levels), size, glm::dvec3(0));
  return soup;
}

inline std::vector<SoupTriangle> mess(TestRandom& random, int n) {
  std::vector<SoupTriangle> soup;
  add_random_triangles(soup, random, n, 0.3);
  add_random_triangles(soup, random, n / 10, 2);
  for (int i = 0; i < n / 4; ++i) {  // needles
    const glm::dvec3 p = random_point(random, 1), d = random_point(random, 1);
    soup.push_back(soup_triangle(p, p + d, p + d + random_point(random, 1e-3)));
  }
  return soup;
}

// Instances of two parts among triangles that stand; where gives each one's scale and offset.
template <class Where> std::unique_ptr<TestFrame> scattered(TestRandom& random, int instances, const Where& where) {
  InstanceScene s;
  s.add_part(mess(random, 40));
  s.add_part(ball(2));
  s.add_part(mess(random, 150));
  for (int i = 0; i < instances; ++i) {
    glm::dvec3 scale(1), offset(0);
    where(i, scale, offset);
    s.place(static_cast<size_t>(1 + i % 2), random_map(random, scale, offset));
  }
  return frame_of_scene(s.build());
}

}  // namespace spanray
