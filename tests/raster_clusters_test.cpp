// Clusters drop only what the tests of each triangle drop, or what nobody could see, and change nothing that is drawn: random
// patches of triangles at the borders of the picture, at the near plane, edge-on, around the eye, behind walls, at any scale
// and place.
#include "support/cluster_patches.h"

namespace spanray {
namespace {

// More than 10^5 clusters, each from several cameras; scales and places from 2^-20 to 2^20.
TEST(RasterClusters, DropWhatTheirTrianglesWouldBeDroppedFor) {
  constexpr int kClusters = 128;
  TestRandom random(1);
  Seen seen;
  Patches patches(2, kClusters);
  Parallel parallel(1);
  for (int n = 0; n < 1000; ++n) {
    const double scale = std::exp2(random.uniform(-20, 20));
    const dvec3 middle = random.below(3) ? unit(random) * std::exp2(random.uniform(-20, 20)) : dvec3(0);
    patches.place(middle, scale);
    const Clusters clusters = make_clusters(patches.scene(), {}, resolve_isa(Isa::kAuto), parallel);
    const bool wide = random.below(2) != 0;
    for (int view = 0; view < 3; ++view) {
      const dvec3 eye = middle + random_point(random, scale);
      Camera camera = camera_at(eye, eye + unit(random) * scale, scale * std::exp2(random.uniform(-8, 1)));
      camera.fov_y_degrees = wide ? random.uniform(30, 170) : std::exp2(random.uniform(-6, 5));
      const auto isas = supported_isas();
      const Isa isa = isas[static_cast<size_t>(random.below(static_cast<int>(isas.size())))];
      Settings settings = test_settings(random.between(1, 300), random.between(1, 300), isa, 1);
      settings.culling = random.below(4) ? Culling::kBack : Culling::kNone;
      compare(patches.scene(), camera, settings, clusters, seen);
      if (HasFatalFailure()) FAIL() << "round " << n << ", view " << view;
    }
  }
  EXPECT_GT(seen.clusters, 300000u);
  EXPECT_GT(seen.outside, seen.clusters / 10);
  EXPECT_GT(seen.back_face, seen.clusters / 50);
}

// One cluster, all of whose vertices lie outside of one side of the frustum, but for one that lies on that side as far as
// double can tell: in front of it or behind it by rounding. The box has its farthest corner there.
TEST(RasterClusters, AVertexOnASideOfTheFrustumIsDecidedByItsOwnTest) {
  TestRandom random(3);
  Seen seen;
  Parallel parallel(1);
  uint64_t kept = 0;
  SceneData scene = make_test_scene({soup_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0})});
  scene.triangles.resize(kClusterTriangles);
  for (int n = 0; n < 100000; ++n) {
    const double scale = std::exp2(random.uniform(-20, 20));
    const Settings settings = test_settings(random.between(1, 2000), random.between(1, 2000), Isa::kAuto, 1);
    Camera camera = camera_at({0, 0, 0}, unit(random), scale * std::exp2(random.uniform(-8, -1)));
    camera.fov_y_degrees = random.uniform(1, 150);
    const PrimaryRays rays = make_primary_rays(camera, settings.width, settings.height);
    const int side = random.below(5);
    const double x = side == 0 ? 0 : side == 1 ? rays.width : random.uniform(0, rays.width);
    const double y = side == 2 ? 0 : side == 3 ? rays.height : random.uniform(0, rays.height);
    const dvec3 inward[5] = {rays.pixel_row_x, rays.forward * static_cast<double>(rays.width) - rays.pixel_row_x,
                             rays.pixel_row_y, rays.forward * static_cast<double>(rays.height) - rays.pixel_row_y,
                             rays.forward};
    put(random_point(random, scale), scene.vertices[0]);
    const double size = scale * std::exp2(random.uniform(-30, -3));
    for (int i = 1; i < 3; ++i)
      for (int k = 0; k < 3; ++k) {
        const double away = inward[side][k] > 0 ? -1 : 1;
        scene.vertices[i].position[k] = scene.vertices[0].position[k] + static_cast<float>(away * size * random.uniform());
      }
    for (Triangle& t : scene.triangles)
      t = {{0, 1, 2}, random.below(2) ? kTriangleFlipped : 0}, order_vertices(scene.vertices, t);
    const double distance = side == 4 ? camera.near_plane : scale * std::exp2(random.uniform(0, 3));
    for (int k = 0; k < 3; ++k) {
      camera.eye[k] = scene.vertices[0].position[k] - (rays.corner[k] + rays.step_x[k] * x + rays.step_y[k] * y) * distance;
      camera.target[k] = camera.eye[k] + rays.forward[k] * scale * 16;
    }
    const uint64_t outside = seen.outside;
    compare(scene, camera, settings, make_clusters(scene, {}, resolve_isa(Isa::kAuto), parallel), seen);
    if (HasFatalFailure()) FAIL() << "round " << n << ", side " << side;
    kept += seen.outside == outside;
  }
  EXPECT_EQ(kept, 100000u);  // none can be told from outside
}

// The eye in the plane of one triangle of a patch, as far as double can tell.
TEST(RasterClusters, ATriangleSeenEdgeOnIsDecidedByItsOwnTest) {
  TestRandom random(4);
  Seen seen, dropped;
  Patches patches(5, 1);
  Parallel parallel(1);
  uint64_t edge_on = 0;
  for (int n = 0; n < 100000; ++n) {
    const double scale = std::exp2(random.uniform(-20, 20));
    patches.place(dvec3(0), scale);
    const SceneData& scene = patches.scene();
    const Triangle& t = scene.triangles[static_cast<size_t>(random.below(3) ? random.below(2) * 63 : random.below(64))];
    dvec3 v[3];
    for (int i = 0; i < 3; ++i)
      v[i] = dvec3(scene.vertices[t.vertex[i]].position[0], scene.vertices[t.vertex[i]].position[1],
                   scene.vertices[t.vertex[i]].position[2]);
    const dvec3 across = normalize3(v[1] - v[0], dvec3(0)), along = normalize3(v[2] - v[0], dvec3(0));
    const double far = scale * std::exp2(random.uniform(-8, 8));
    const dvec3 eye = v[0] + (across * random.uniform(-1, 1) + along * random.uniform(-1, 1)) * far;
    if (!(std::fabs(eye.x) < 1e18 && std::fabs(eye.y) < 1e18 && std::fabs(eye.z) < 1e18) || eye == v[0]) continue;
    Camera camera = camera_at(eye, v[0], far * 1e-6);
    camera.fov_y_degrees = 170;
    Settings settings = test_settings(64, 64, Isa::kAuto, 1);
    settings.culling = Culling::kBack;
    const Clusters clusters = make_clusters(scene, {}, resolve_isa(Isa::kAuto), parallel);
    const double side = facing(scene, t, eye), size = length3(cross3(v[1] - v[0], v[2] - v[0])) * length3(eye - v[0]);
    edge_on += side != 0 && std::fabs(side) < 1e-12 * size;
    compare(scene, camera, settings, clusters, seen);
    // A little behind the plane, the cluster is dropped if the others let it.
    const dvec3 behind =
        normalize3(cross3(v[1] - v[0], v[2] - v[0]), dvec3(0)) * (0.01 * far * (t.bits & kTriangleFlipped ? 1 : -1));
    for (int k = 0; k < 3; ++k) camera.eye[k] += behind[k];
    compare(scene, camera, settings, clusters, dropped);
    if (HasFatalFailure()) FAIL() << "round " << n;
  }
  EXPECT_GT(edge_on, 20000u);
  EXPECT_GT(dropped.back_face, 10000u);
}

// Parallel triangles, one behind the other, seen from behind along their normal by an eye in the plane of the hindmost.
TEST(RasterClusters, AStackSeenFromTheHindmostPlaneIsDecidedByItsOwnTest) {
  TestRandom random(10);
  Seen seen;
  Parallel parallel(1);
  uint64_t edge_on = 0;
  SceneData scene = make_test_scene({soup_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0})});
  scene.triangles.resize(kClusterTriangles), scene.vertices.resize(3 * kClusterTriangles);
  for (int n = 0; n < 100000; ++n) {
    const double scale = std::exp2(random.uniform(-20, 20));
    const auto turn = random_turn(random);
    for (uint32_t i = 0; i < kClusterTriangles; ++i) {
      const dvec3 at = (turn[0] * random.uniform(-0.1, 0.1) + turn[1] * random.uniform(-0.1, 0.1) +
                        turn[2] * random.uniform(-1, i == 0 ? -0.99 : 1)) *
                       scale;
      const dvec3 corner[3] = {at, at + turn[0] * (scale * 0.1), at + turn[1] * (scale * 0.1)};
      for (uint32_t k = 0; k < 3; ++k) put(corner[k], scene.vertices[3 * i + k]);
      scene.triangles[i] = {{3 * i, 3 * i + 1, 3 * i + 2}, 0};
      order_vertices(scene.vertices, scene.triangles[i]);
    }
    const Clusters clusters = make_clusters(scene, {}, resolve_isa(Isa::kAuto), parallel);
    double hindmost = 1e30;
    uint32_t last = 0;
    const auto at = [&](uint32_t v) {
      return dvec3(scene.vertices[v].position[0], scene.vertices[v].position[1], scene.vertices[v].position[2]);
    };
    for (uint32_t i = 0; i < kClusterTriangles; ++i)
      if (dot3(at(3 * i), turn[2]) < hindmost) hindmost = dot3(at(3 * i), turn[2]), last = 3 * i;
    const dvec3 across = at(last + 1) - at(last), along = at(last + 2) - at(last),
                center(clusters.center[0][0], clusters.center[1][0], clusters.center[2][0]);
    const dvec3 toward = center - at(last);
    const dvec3 eye = at(last) + across * (dot3(toward, across) / dot3(across, across) + random.uniform(-1e-3, 1e-3)) +
                      along * (dot3(toward, along) / dot3(along, along));
    Camera camera = camera_at(eye, center, scale * 1e-6);
    camera.fov_y_degrees = 170;
    Settings settings = test_settings(64, 64, Isa::kAuto, 1);
    settings.culling = Culling::kBack;
    const double side = facing(scene, scene.triangles[last / 3], eye);
    edge_on += side > 0 && side < 1e-14 * scale * scale * scale;
    compare(scene, camera, settings, clusters, seen);
    if (HasFatalFailure()) FAIL() << "round " << n;
  }
  EXPECT_GT(edge_on, 10000u);
}

// Walls of every kind, and patches behind, before and in them, as close as float can tell.
TEST(RasterClusters, HiddenOnesShowNothing) {
  constexpr int kClusters = 100;
  TestRandom random(11);
  Seen seen;
  Parallel parallel(1);
  for (int n = 0; n < 1500; ++n) {
    const double scale = std::exp2(random.uniform(-20, 20));
    const dvec3 eye = random.below(3) ? unit(random) * std::exp2(random.uniform(-20, 4)) * scale : dvec3(0),
                forward = unit(random);
    Patches patches(static_cast<uint32_t>(n), kClusters);
    SceneData& scene = patches.scene();
    Material mask;
    mask.transparency = static_cast<int32_t>(MaterialTransparency::kScreenDoor), mask.opacity = 0.5f;
    scene.materials = {Material(), translucent_material(), mask};
    const dvec3 wall = eye + forward * scale;
    const dvec3 normal = normalize3(unit(random) * 0.99 - forward, dvec3(0, 1, 0)),
                side = normalize3(cross3(normal, unit(random)), dvec3(1, 0, 0)), up = cross3(normal, side);
    for (size_t c = 0; c < kClusters; ++c) {
      const dvec3 on_wall = wall + (side * random.uniform(-1, 1) + up * random.uniform(-1, 1)) * (scale * 1.5);
      const double depth = random.uniform(-1, 0.1) * std::exp2(random.uniform(-24, 3));
      patches.place_one(c, on_wall + normal * (depth * scale), scale * std::exp2(random.uniform(-24, -3)));
    }
    for (size_t i = kClusterTriangles; i < scene.triangles.size(); ++i)
      scene.triangles[i].bits |= static_cast<uint32_t>(random.below(9) ? 0 : random.below(3));
    // Large ones among the triangles of the first cluster.
    const int walls = random.between(1, 4);
    for (size_t k = 0; k < kClusterTriangles; ++k) scene.triangles[k] = {{60, 60, 60}, 0};
    for (int w = 0; w < walls; ++w) {
      const uint32_t first = static_cast<uint32_t>(w) * 4;
      const double size = scale * random.uniform(0.5, 12),
                   tilt = w == 0 ? 0 : random.uniform(-1, 1) * std::exp2(random.uniform(-20, 0));
      const dvec3 a = side + normal * tilt;
      put(wall - a * size - up * size, scene.vertices[first]), put(wall + a * size - up * size, scene.vertices[first + 1]);
      put(wall + a * size + up * size, scene.vertices[first + 2]), put(wall - a * size + up * size, scene.vertices[first + 3]);
      const uint32_t material = random.below(3) ? 0 : static_cast<uint32_t>(random.below(3));
      scene.triangles[2 * static_cast<size_t>(w)] = {{first, first + 1, first + 2}, material};
      scene.triangles[2 * static_cast<size_t>(w) + 1] = {{first, first + 2, first + 3}, material};
    }
    for (size_t i = 0; i < kClusterTriangles; ++i) order_vertices(scene.vertices, scene.triangles[i]);
    const auto isas = supported_isas();
    constexpr int kSamples[] = {1, 1, 4, 16};
    Settings settings = test_settings(random.between(16, 200), random.between(16, 200),
                                      isas[static_cast<size_t>(random.below(static_cast<int>(isas.size())))], 1);
    settings.culling = random.below(8) ? Culling::kNone : Culling::kBack, settings.samples = kSamples[random.below(4)];
    Camera camera = camera_at(eye, eye + (forward + unit(random) * 0.2) * scale, scale * std::exp2(random.uniform(-12, -1)));
    camera.fov_y_degrees = random.uniform(5, 120);
    compare(scene, camera, settings, make_clusters(scene, {}, resolve_isa(Isa::kAuto), parallel), seen);
    if (HasFatalFailure()) FAIL() << "round " << n;
  }
  EXPECT_GT(seen.hidden, 800u);
}

// A wall before all patches but one, of each kind.
TEST(RasterClusters, OnlyOpaqueWallsThatAreSeenHide) {
  struct Case {
    uint32_t bits;  // of the wall
    Culling culling;
    bool hides;
  };
  constexpr Case kCases[] = {{0, Culling::kNone, true},  {kTriangleFlipped, Culling::kNone, true},
                             {1, Culling::kNone, false}, {2, Culling::kNone, false},
                             {0, Culling::kBack, true},  {kTriangleFlipped, Culling::kBack, false}};
  constexpr int kClusters = 40;
  Patches patches(12, kClusters);
  SceneData& scene = patches.scene();
  Material mask;
  mask.transparency = static_cast<int32_t>(MaterialTransparency::kScreenDoor), mask.opacity = 0.5f;
  scene.materials = {Material(), translucent_material(), mask};
  Parallel parallel(1);
  for (const Case& c : kCases) {
    for (size_t i = 0; i < kClusters; ++i)
      patches.place_one(i, {0.3 * static_cast<double>(i % 8) - 1, 0.3, i == 1 ? -2 : -6}, 0.01);
    for (Vertex& v : scene.vertices)
      if (!std::isfinite(v.position[0] + v.position[1] + v.position[2]))
        std::memcpy(v.position, scene.vertices[&v == &scene.vertices[0]].position, 12);
    const dvec3 corner[] = {{-20, -20, -4}, {20, -20, -4}, {0, 20, -4}};
    for (int i = 0; i < 3; ++i) put(corner[i], scene.vertices[static_cast<size_t>(i)]);
    for (size_t k = 1; k < kClusterTriangles; ++k) scene.triangles[k] = {{60, 60, 60}, 0};
    scene.triangles[0] = {{0, 1, 2}, c.bits & kTriangleMaterialMask};
    order_vertices(scene.vertices, scene.triangles[0]);
    scene.triangles[0].bits ^= c.bits & kTriangleFlipped;
    const Clusters clusters = make_clusters(scene, {}, resolve_isa(Isa::kAuto), parallel);
    Settings settings = test_settings(640, 480);
    settings.culling = c.culling;
    Seen seen;
    compare(scene, camera_at({0, 0, 0}, {0, 0, -1}), settings, clusters, seen);
    EXPECT_EQ(seen.hidden > 10, c.hides) << c.bits;
    // Patches that face away may be dropped before.
    if (c.hides) {
      EXPECT_GE(seen.hidden + seen.back_face, uint64_t{kClusters - 2}) << c.bits;
    }
  }
}

TEST(RasterClusters, NeverDropWhatMovesNorWhatIsNotFinite) {
  Patches patches(6, 40);
  patches.place(dvec3(0), 1e-3);
  SceneData& scene = patches.scene();
  for (Vertex& v : scene.vertices)
    if (!std::isfinite(v.position[0] + v.position[1] + v.position[2])) v = Vertex{};
  scene.vertices[scene.triangles[20 * kClusterTriangles].vertex[1]].position[1] = std::nanf("");
  Parallel parallel(2);
  const std::vector<MovingRun> moving = {
      {0, 1, 0}, {5 * kClusterTriangles - 1, 2, 0}, {30 * kClusterTriangles, 2 * kClusterTriangles, 0}};
  const Clusters clusters = make_clusters(scene, moving, resolve_isa(Isa::kAuto), parallel);
  Settings settings = test_settings(50, 50);
  const auto t = make_test_frame(SceneData(), camera_at({0, 0, 9}, {0, 0, 10}), settings);
  t->material_flags.assign(1, 0);
  t->frame.scene = &scene, t->frame.material_flags = t->material_flags.data();
  ClusterFates fates;
  find_cluster_fates(t->frame, clusters, fates);
  for (uint32_t c = 0; c < 40; ++c) {
    const bool kept = c == 0 || c == 4 || c == 5 || c == 20 || c == 30 || c == 31;
    EXPECT_EQ(fates.fate[c], kept ? kClusterKept : kClusterOutside) << c;
  }
}

// Clusters whose vertices lie all over the scene: their vertices are transformed.
TEST(RasterClusters, ScatteredTrianglesAreDrawnWhole) {
  TestRandom random(7);
  Patches patches(8, 2000);
  patches.place(dvec3(0), 1);
  SceneData& scene = patches.scene();
  for (const size_t shuffled : {size_t{6400}, scene.triangles.size()}) {
    for (size_t i = shuffled - 1; i > 0; --i)
      std::swap(scene.triangles[i], scene.triangles[static_cast<size_t>(random.below(static_cast<int>(i + 1)))]);
    for (const int threads : {1, 2}) {
      Parallel parallel(threads);
      const Clusters clusters = make_clusters(scene, {}, resolve_isa(Isa::kAuto), parallel);
      EXPECT_EQ(clusters.scattered, shuffled / kClusterTriangles);
      Seen seen;
      Settings settings = test_settings(200, 150, Isa::kAuto, threads);
      settings.culling = Culling::kBack;
      compare(scene, camera_at({0, 0, 5}, {0, 4, 0}), settings, clusters, seen);
      if (shuffled < scene.triangles.size()) {
        EXPECT_GT(seen.outside, 10u);
      }
    }
  }
}

// Nothing but the instruction set differs: not what is dropped either.
TEST(RasterClusters, AreTheSameOnEveryInstructionSetAndThread) {
  Patches patches(9, 3000);
  patches.place(dvec3(0), 1);
  Parallel one(1), two(2);
  const Clusters clusters = make_clusters(patches.scene(), {}, Isa::kScalar, one);
  for (const Isa isa : supported_isas()) {
    const Clusters again = make_clusters(patches.scene(), {}, isa, two);
    const auto same = [&](const AlignedBuffer<float>& a, const AlignedBuffer<float>& b) {
      return std::memcmp(a.data(), b.data(), 4 * clusters.count()) == 0;
    };
    EXPECT_EQ(0, std::memcmp(clusters.blocks.data(), again.blocks.data(), clusters.count() * sizeof(ClusterBlocks)));
    EXPECT_TRUE(same(clusters.cosine, again.cosine) && same(clusters.sine, again.sine) && same(clusters.offset, again.offset));
    for (int a = 0; a < 3; ++a)
      EXPECT_TRUE(same(clusters.center[a], again.center[a]) && same(clusters.half[a], again.half[a]) &&
                  same(clusters.axis[a], again.axis[a]));
  }
  std::vector<uint8_t> want;
  for (const Isa isa : supported_isas())
    for (const int threads : {1, 2}) {
      Settings settings = test_settings(200, 150, isa, threads);
      settings.culling = Culling::kBack;
      const auto t = make_test_frame(SceneData(), camera_at({0, 0, 1}, {0, 0, 0}), settings);
      t->material_flags.assign(1, 0);
      t->frame.scene = &patches.scene(), t->frame.material_flags = t->material_flags.data();
      ClusterFates fates;
      find_cluster_fates(t->frame, clusters, fates);
      const std::vector<uint8_t> got(fates.fate.begin(), fates.fate.end());
      if (want.empty()) want = got;
      EXPECT_EQ(got, want) << static_cast<int>(isa);
    }
  for (const uint8_t fate : {kClusterKept, kClusterOutside, kClusterBackFace})
    EXPECT_GT(std::count(want.begin(), want.end(), fate), 100);
}

}  // namespace
}  // namespace spanray
