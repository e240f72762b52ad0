// Patches of triangles, a cluster each, anywhere and of any shape; and the rasterizer with and without clusters.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "raster/clusters.h"
#include "support/camera_at.h"
#include "support/random.h"
#include "support/raster_front_end.h"

namespace spanray {

using glm::dvec3;

inline dvec3 unit(TestRandom& random) { return normalize3(random_point(random), dvec3(1, 0, 0)); }

// Any turn, its rows perpendicular unit vectors.
inline std::array<dvec3, 3> random_turn(TestRandom& random) {
  const dvec3 a = unit(random), b = normalize3(cross3(a, unit(random)), dvec3(0, 1, 0));
  return {a, b, cross3(a, b)};
}

inline void put(const dvec3& p, Vertex& v) {
  for (int k = 0; k < 3; ++k) v.position[k] = static_cast<float>(p[k]) + 0.0f;
}

// A scene of clusters that stand apart, each with vertices of its own: a strip of 64 triangles, bent or flat or crumpled,
// turned any way.
class Patches {
 public:
  static constexpr int kColumns = 32, kVertices = 2 * (kColumns + 1);
  Patches(uint32_t seed, int clusters) : random_(seed) {
    scene_ = make_test_scene({soup_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0})});
    scene_.vertices.resize(static_cast<size_t>(clusters) * kVertices),
        scene_.triangles.resize(static_cast<size_t>(clusters) * kClusterTriangles);
    for (Vertex& v : scene_.vertices) v = Vertex{{0, 0, 0}, {0, 0, 1}, {0, 0}};
  }
  SceneData& scene() { return scene_; }

  // Places all clusters anew about `middle`, where the camera may be, in units of `scale`.
  void place(const dvec3& middle, double scale) {
    for (size_t c = 0; c < scene_.triangles.size() / kClusterTriangles; ++c)
      place_one(c, middle + unit(random_) * (scale * std::exp2(random_.uniform(-4, 3))),
                scale * std::exp2(random_.uniform(-6, random_.below(8) ? 0 : 4)));
  }

  void place_one(size_t c, const dvec3& center, double size) {
    const auto turn = random_turn(random_);
    const double bend = random_.below(4) ? random_.uniform(-1.5, 1.5) * random_.uniform() : 0,
                 rough = random_.below(3) ? 0 : random_.uniform(0, 0.1);
    const double width = random_.below(4) ? random_.uniform(0, 1) : 1e-6;
    Vertex* const v = &scene_.vertices[c * kVertices];
    for (int row = 0; row < 2; ++row)
      for (int i = 0; i <= kColumns; ++i) {
        const double s = 2.0 * i / kColumns - 1, angle = s * bend;
        const dvec3 local(bend == 0 ? s : std::sin(angle) / bend, (row - 0.5) * width,
                          bend == 0 ? 0 : (std::cos(angle) - 1) / bend);
        put(center + (turn[0] * local.x + turn[1] * local.y + turn[2] * (local.z + rough * random_.uniform(-1, 1))) * size,
            v[row * (kColumns + 1) + i]);
      }
    if (random_.below(8) == 0) std::memcpy(v[3].position, v[4].position, sizeof v->position);  // no area
    if (random_.below(100) == 0)
      v[random_.below(kVertices)].position[random_.below(3)] = random_.below(2) ? std::nanf("") : INFINITY;
    connect(static_cast<uint32_t>(c), random_.below(2) ? kTriangleFlipped : 0);
  }

 private:
  void connect(uint32_t c, uint32_t flip) {
    const uint32_t first = c * kVertices;
    for (uint32_t i = 0; i < kColumns; ++i) {
      const uint32_t a = first + i, b = a + 1, d = a + kColumns + 1;
      Triangle* const t = &scene_.triangles[c * kClusterTriangles + 2 * i];
      t[0] = {{a, b, d}, flip}, t[1] = {{b, d + 1, d}, flip};
      order_vertices(scene_.vertices, t[0]), order_vertices(scene_.vertices, t[1]);
    }
  }

  TestRandom random_;
  SceneData scene_;
};

// What clip_triangles() makes, in order.
inline std::vector<ScreenTriangle> drawn(const TileBins& bins) {
  std::vector<ScreenTriangle> all;
  for (const BinChunk& c : bins.chunks) all.insert(all.end(), c.triangles.begin(), c.triangles.end());
  return all;
}
inline uint64_t sum(const FrameCounts& c) { return c.triangles_invalid + c.triangles_culled() + c.triangles_drawn; }

struct Seen {
  uint64_t clusters = 0, outside = 0, back_face = 0, hidden = 0;
};

// A vertex may be read only if it was transformed: the others stand as what would be seen.
inline void poison(ScreenVertices& v, size_t n) {
  for (AlignedBuffer<double>* a : {&v.x, &v.y, &v.w}) a->resize(0), a->assign(n, 1.0);
  v.x_24_8.resize(0), v.x_24_8.assign(n, 128), v.y_24_8.resize(0), v.y_24_8.assign(n, 128), v.outcode.resize(0),
      v.outcode.assign(n, 0);
}

// accept() of masked materials: every third column.
inline uint32_t accept_columns(const Frame&, uint32_t, int x0, int, uint32_t candidates, int) {
  for (int i = 0; i < 32; ++i)
    if ((x0 + i) % 3 != 0) candidates &= ~(1u << i);
  return candidates;
}

inline void compare_pictures(const Frame& frame, const TileBins& all, const TileBins& some) {
  for (int place = frame.places.first(); place < frame.places.end(); ++place) {
    const Picture want = rasterize(frame, all, place), got = rasterize(frame, some, place);
    ASSERT_EQ(got.primitive, want.primitive);
    ASSERT_EQ(0, std::memcmp(got.depth.data(), want.depth.data(), want.depth.size() * 4));
    const FragmentList layers = all_fragments(frame, all, place), found = all_fragments(frame, some, place);
    ASSERT_TRUE(std::equal(layers.primitive.begin(), layers.primitive.end(), found.primitive.begin(), found.primitive.end()));
    ASSERT_TRUE(std::equal(layers.pixel.begin(), layers.pixel.end(), found.pixel.begin(), found.pixel.end()));
  }
}

// The frame with and without clusters.
inline void compare(const SceneData& scene, const Camera& camera, const Settings& settings, const Clusters& clusters,
                    Seen& seen) {
  const auto t = make_test_frame(SceneData(), camera, settings);
  for (const Material& m : scene.materials) t->material_flags.push_back(material_flags(m, settings));
  Frame& frame = t->frame;
  frame.scene = &scene, frame.material_flags = t->material_flags.data(), frame.accept_row = accept_columns;
  frame.places = make_sample_places(settings.samples);
  FrontEnd all, some;
  transform_vertices(frame, all.vertices);
  clip_triangles(frame, all.vertices, all.bins, all.counts);
  ClusterFates fates;
  find_cluster_fates(frame, clusters, fates);
  poison(some.vertices, frame.scene->vertices.size());
  transform_vertices(frame, some.vertices, &fates);
  clip_triangles(frame, some.vertices, some.bins, some.counts, &fates);
  const FrameCounts &a = all.counts, &s = some.counts;
  ASSERT_EQ(s.triangles_in, frame.scene->triangles.size());
  ASSERT_EQ(sum(s), s.triangles_in);
  ASSERT_EQ(s.triangles_invalid, a.triangles_invalid);
  if (s.triangles_hidden == 0) {
    ASSERT_EQ(s.triangles_clipped, a.triangles_clipped);
    ASSERT_EQ(s.triangles_drawn, a.triangles_drawn);
    ASSERT_EQ(s.triangles_empty, a.triangles_empty);
  }
  ASSERT_LE(s.triangles_outside, a.triangles_outside);  // some of those are back faces as well
  auto want = drawn(all.bins);
  const auto got = drawn(some.bins);
  std::erase_if(want, [&](const ScreenTriangle& x) { return fates.fate[x.primitive / kClusterTriangles] == kClusterHidden; });
  ASSERT_EQ(got.size(), want.size());
  if (!want.empty()) {
    ASSERT_EQ(0, std::memcmp(got.data(), want.data(), want.size() * sizeof(ScreenTriangle)));
  }
  if (s.triangles_hidden > 0) {
    bin_triangles(frame, all.bins), bin_triangles(frame, some.bins);
    compare_pictures(frame, all.bins, some.bins);
  }
  seen.clusters += clusters.count();
  for (const uint8_t f : fates.fate)
    seen.outside += f == kClusterOutside, seen.back_face += f == kClusterBackFace, seen.hidden += f == kClusterHidden;
}

}  // namespace spanray
