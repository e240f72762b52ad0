#include <gtest/gtest.h>

#include <chrono>
#include <mutex>
#include <new>
#include <set>
#include <thread>

#include "math/elementary.h"
#include "shade/lit_vertex_cache.h"
#include "support/test_surfaces.h"

namespace spanray {
namespace {

constexpr int kCount = 1009;

size_t vertex_count(TestSurfaces& t) { return t.scene().vertices.size(); }

TEST(Gouraud, InterpolatesTheCornersOfTheSideThatIsSeen) {
  for (const bool bounce : {false, true}) {
    auto t = make_test_surfaces(2, kCount, Shading::kGouraud, bounce);
    LitVertexCache cache(vertex_count(*t), t->scene().lights.size());
    const TestRadiance radiance = shade_all(*t, Isa::kScalar, nullptr, &cache);
    double worst = 0;
    int compared = 0;
    for (int i = 0; i < kCount; ++i) {
      if (!t->surfaces.valid[i]) continue;
      const OracleSurface s = t->oracle(i);
      glm::dvec3 want = s.ambient * oracle_vec(t->scene().ambient_radiance) + s.emission;
      bool near = false;
      for (const Light& light : t->scene().lights) {
        const double facing = dot3(s.geometric_normal, oracle_incidence(s.position, light).to_light);
        near |= std::fabs(facing) < 1e-5;
        if (facing <= 0) continue;
        for (int j = 0; j < 3; ++j) {
          const glm::dvec3 p = t->corner(i, j);
          glm::dvec3 n = t->corner_normal(i, j);
          if (dot3(n, s.geometric_normal) < 0) n = -n;
          const OracleIncidence in = oracle_incidence(p, light);
          near |= std::fabs(dot3(n, in.to_light)) < 1e-5;
          const OracleReflected r = oracle_reflected(n, in.to_light, normalize3(t->viewer(i) - p, n), s.shininess, t->reflectance(i));
          const glm::dvec3 color = s.diffuse * r.diffuse + s.specular * r.specular;
          want += double(t->surfaces.weight[j][i]) * in.irradiance * oracle_vec(light.intensity) * color;
        }
      }
      if (near) continue;
      ++compared;
      worst = std::max(worst, radiance.max_encoded_difference(i, want));
    }
    EXPECT_LE(worst, 1.0 / 255);
    EXPECT_GT(compared, kCount * 8 / 10);
  }
}

TEST(Gouraud, LightsEachVisibleVertexOnce) {
  auto t = make_test_surfaces(3, 40, Shading::kGouraud, false);
  LitVertexCache cache(vertex_count(*t), t->scene().lights.size());
  std::set<uint32_t> visible;
  for (int i = 0; i < 40; ++i)
    if (t->surfaces.valid[i]) visible.insert(t->triangle(i).vertex, t->triangle(i).vertex + 3);
  ASSERT_LT(visible.size(), vertex_count(*t));
  const TestRadiance without = shade_all(*t, Isa::kScalar);
  EXPECT_EQ(cache.lit_count(), 0u);
  for (int frame = 0; frame < 3; ++frame) {
    for (int again = 0; again < 2; ++again) {
      EXPECT_TRUE(shade_all(*t, Isa::kScalar, nullptr, &cache) == without);
      EXPECT_EQ(cache.lit_count(), visible.size());
    }
    cache.reset();
    EXPECT_EQ(cache.lit_count(), 0u);
  }
  // A new frame with another light: nothing old is left.
  t->scene().lights[0].intensity[0] += 1, t->scene().lights[1].position[1] += 1;
  const TestRadiance moved = shade_all(*t, Isa::kScalar);
  EXPECT_TRUE(shade_all(*t, Isa::kScalar, nullptr, &cache) == moved);
  EXPECT_FALSE(moved == without);
}

TEST(Gouraud, CacheDoesNotDependOnTasksOrOrder) {
  auto t = make_test_surfaces(4, kCount, Shading::kGouraud, false);
  t->frame().isa = resolve_isa(Isa::kAuto);
  const TestRadiance want = shade_all(*t, t->frame().isa);
  std::set<uint32_t> visible;
  for (int i = 0; i < kCount; ++i)
    if (t->surfaces.valid[i]) visible.insert(t->triangle(i).vertex, t->triangle(i).vertex + 3);
  constexpr int kTasks = 16;
  std::vector<SurfaceBatch> parts(kTasks);
  for (int k = 0; k < kTasks; ++k) {
    const int first = kCount * k / kTasks;
    copy_surfaces(t->surfaces, first, kCount * (k + 1) / kTasks - first, parts[static_cast<size_t>(k)]);
  }
  LitVertexCache cache(vertex_count(*t), t->scene().lights.size());
  t->test->parallel.reset();  // oneTBB's limit on threads is the least of all pools alive
  std::mutex mutex;
  for (const int threads : {1, 2, 7}) {
    Parallel pool(threads);
    std::set<std::thread::id> workers;
    // On a busy machine it takes many short frames until a second worker finds any work left.
    for (int frame = 0; frame < 20 || (threads > 1 && workers.size() < 2 && frame < 2000); ++frame) {
      cache.reset();
      TestRadiance got(kCount);
      // All parts see the same sixty triangles: tasks meet at nearly every vertex.
      pool.for_each(kTasks, [&](size_t k, int) {
        {
          const std::lock_guard<std::mutex> lock(mutex);
          workers.insert(std::this_thread::get_id());
        }
        TestRadiance::Pointers out = got.at(kCount * static_cast<int>(k) / kTasks);
        shade_ambient(t->frame(), parts[k], out.p);
        for (int l = 0; l < 6; ++l) shade_light(t->frame(), parts[k], t->hits, l, nullptr, &cache, out.p);
      });
      ASSERT_TRUE(got == want) << threads << " threads";
      ASSERT_EQ(cache.lit_count(), visible.size());
    }
    EXPECT_GE(workers.size(), threads > 1 ? 2u : 1u);
  }
}

TEST(Gouraud, BothSidesOfASheetAreLitFromTheirOwnSide) {
  auto t = make_test_surfaces(5, 2, Shading::kGouraud, false);
  std::vector<SoupTriangle> soup = {soup_triangle({-1, -1, 0}, {1, -1, 0}, {0, 1, 0})};
  t->scene() = make_test_scene(soup);
  for (const double side : {1.0, -1.0}) {
    Light light;
    light.position[2] = static_cast<float>(2 * side);
    t->scene().lights = {light};
    for (const double eye : {5.0, -5.0}) {
      t->frame().primary.eye = {0, 0, eye};
      clear_surfaces(t->surfaces, 1);
      put_surface(*t, 0, 0, glm::dvec3(1.0 / 3), t->frame().primary.eye);
      put3(t->surfaces.diffuse, 0, glm::dvec3(1));
      LitVertexCache cache(3, 1);
      const float got = shade_all(*t, Isa::kScalar, nullptr, &cache).channel[0][0];
      if (side * eye > 0) EXPECT_GT(got, 0.03);
      else EXPECT_EQ(got, 0);
    }
  }
}

TEST(Gouraud, CornerNormalsAreTurnedAsOne) {
  auto t = make_test_surfaces(7, 1, Shading::kGouraud, false);
  t->frame().primary.eye = {0, 0, 5};
  Light light = t->scene().lights[2];
  const glm::dvec3 toward = normalize3(glm::dvec3(1, 0, 0.5), glm::dvec3(0));
  for (int k = 0; k < 3; ++k) light.direction[k] = static_cast<float>(-toward[k]), light.intensity[k] = 1;
  float seen[2];
  for (const int opposed : {0, 1}) {
    SoupTriangle soup = soup_triangle({-1, -1, 0}, {1, -1, 0}, {0, 1, 0});
    // The third normal lies 10 degrees below the horizon, on the side of the light; or all of them oppose the winding.
    const double bent[3] = {0, 0, 100 * kPi / 180};
    glm::dvec3 n[3];
    for (int j = 0; j < 3; ++j) {
      n[j] = glm::dvec3(std::sin(bent[j]), 0, std::cos(bent[j])) * (opposed ? -1.0 : 1.0);
      for (int k = 0; k < 3; ++k) soup.corner[j].normal[k] = static_cast<float>(n[j][k]);
    }
    t->scene() = make_test_scene({soup});
    t->scene().lights = {light};
    clear_surfaces(t->surfaces, 1);
    put_surface(*t, 0, 0, glm::dvec3(1.0 / 3), t->frame().primary.eye);
    put3(t->surfaces.diffuse, 0, glm::dvec3(1));
    t->frame().plan.ambient = false;
    seen[opposed] = shade_all(*t, Isa::kScalar).channel[0][0];
    const double up = toward.z / kPi, third = std::max(0.0, toward.x * std::sin(bent[2]) + toward.z * std::cos(bent[2])) / kPi;
    EXPECT_NEAR(seen[opposed], (2 * up + third) / 3, 1e-6);
  }
  EXPECT_EQ(seen[0], seen[1]);
}

// A task that throws while it has claims must not leave the others waiting for ever: they return, and its exception ends the frame.
TEST(Gouraud, NobodyWaitsForATaskThatFailed) {
  auto t = make_test_surfaces(7, kCount, Shading::kGouraud, false);
  LitVertexCache cache(vertex_count(*t), t->scene().lights.size());
  for (uint32_t v = 0; v < vertex_count(*t); v += 2) ASSERT_TRUE(cache.impl().try_claim(v));
  std::thread other([&] { cache.impl().light_vertices_of(t->frame(), t->surfaces); });
  try {
    const ClaimGuard guard(cache.impl().abandoned);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    throw std::bad_alloc();
  } catch (const std::bad_alloc&) {
  }
  other.join();  // hangs, were it not for the guard
  EXPECT_TRUE(cache.impl().abandoned);
  EXPECT_GT(cache.lit_count(), 0u) << "it lit what it could claim";
  cache.reset();
  EXPECT_FALSE(cache.impl().abandoned);
  cache.impl().light_vertices_of(t->frame(), t->surfaces);
  EXPECT_FALSE(cache.impl().abandoned) << "a task that ends well releases its guard";
}

TEST(Gouraud, EmptyCacheAndEmptyBatchAreFine) {
  auto t = make_test_surfaces(6, 5, Shading::kGouraud, false);
  clear_surfaces(t->surfaces, 5);
  LitVertexCache cache(0, 0);
  EXPECT_TRUE(shade_all(*t, Isa::kScalar, nullptr, &cache) == TestRadiance(5));
  t->surfaces.resize(0);
  shade_all(*t, Isa::kScalar, nullptr, &cache);
  EXPECT_EQ(cache.lit_count(), 0u);
}

}  // namespace
}  // namespace spanray
