// What others than the renderer say of a frame's pixels: `why`, and questions outside of frames.
#pragma once
#include <cstring>

#include "render/trace_pixel.h"
#include "spanray/query.h"
#include "support/sphere_scenes.h"

namespace spanray {

// `why` derives what the picture shows, on a grid of its pixels. counts(primitive): adds to seen.
template <class Counts>
void expect_why_agrees(const Scene& scene, const Camera& view, const Settings& s, const Counts& counts, int& seen) {
  const Framebuffer f = render(scene, view, s);
  for (int y = 3; y < s.height; y += 7)
    for (int x = 1; x < s.width; x += 5) {
      const size_t i = static_cast<size_t>(y * s.width + x);
      const Result<PixelTrace> trace = trace_pixel(scene, view, s, x, y);
      ASSERT_TRUE(trace);
      ASSERT_EQ(trace.value().primitive, f.primitive[i]) << x << "," << y;
      ASSERT_EQ(0, std::memcmp(trace.value().radiance, &f.radiance[3 * i], 12)) << x << "," << y;
      seen += f.primitive[i] != kNoPrimitive && counts(f.primitive[i]);
    }
}

// SceneQuery::pixel() names what a frame by rays shows, at its depth. tolerance(z): of depths.
template <class Tolerance, class Counts>
void expect_questions_agree(const Scene& scene, const Camera& view, Settings s, const Tolerance& tolerance, const Counts& counts,
                            int& seen) {
  s.visibility = Visibility::kRay;
  const Framebuffer f = render(scene, view, s);
  const SceneQuery query(scene);
  for (int y = 0; y < s.height; y += 3)
    for (int x = 0; x < s.width; x += 3) {
      const size_t i = static_cast<size_t>(y * s.width + x);
      const auto hit = query.pixel(view, s, x, y);
      ASSERT_TRUE(hit);
      ASSERT_EQ(hit.value().has_value(), f.primitive[i] != kNoPrimitive);
      if (!hit.value()) continue;
      ASSERT_EQ(hit.value()->name.triangle, f.primitive[i]) << x << "," << y;
      ASSERT_EQ(hit.value()->name.plane, scene.data().is_plane(f.primitive[i]));
      ASSERT_EQ(hit.value()->name.sphere, scene.data().is_sphere(f.primitive[i]));
      const double z = view.near_plane / double{f.depth[i]};
      ASSERT_NEAR(hit.value()->t + view.near_plane, z, tolerance(z));
      seen += counts(f.primitive[i]);
    }
}

}  // namespace spanray
