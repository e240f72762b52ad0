// Batches of surfaces: a hit's surface depends on nothing but the hit, whatever is beside it, and the plan.
#include <gtest/gtest.h>

#include "core/hash.h"
#include "support/surface_scenes.h"

namespace spanray {
namespace {

TEST(ShadeSurfaceBatch, MissesAreZero) {
  auto t = full_frame(random_surface_scene(11, 5), Camera{}, 64, 64);
  for (const Isa isa : supported_isas()) {
    t->frame.isa = isa;
    HitBatch hits;
    for (uint32_t i = 0; i < 70; ++i) add_hit(hits, pack_pixel(i % 64, 5), 0, i % 3 == 0 || i >= 32 ? kNoPrimitive : i % 5);
    SurfaceBatch s;
    resolve_surfaces(t->frame, hits, s);
    ASSERT_EQ(s.count, 70);
    for (int i = 0; i < 70; ++i)
      for (const BatchField& f : batch_fields(s))
        if (const bool miss = hits.primitive[static_cast<size_t>(i)] == kNoPrimitive; miss || f.name == "valid") {
          ASSERT_EQ(bits_of(f.data[i]), miss ? 0u : 1u) << f.name;
        }
    HitBatch none;
    resolve_surfaces(t->frame, none, s);
    EXPECT_EQ(s.count, 0);
  }
}

TEST(ShadeSurfaceBatch, OneBitPatternForEveryInstructionSetAndBatchSplit) {
  TestRandom random(12);
  Hash hash;
  for (const Shading shading : {Shading::kFlat, Shading::kPhong})
    for (const Filter filter : {Filter::kNearest, Filter::kBilinear, Filter::kTrilinear}) {
      auto t = full_frame(random_surface_scene(13, 60), random_camera(random, 3), 512, 512, Isa::kScalar);
      t->frame.settings.shading = shading, t->frame.settings.filter = filter;
      HitBatch hits;
      constexpr int kCount = 1301;  // more than planes are set up for at once
      random_primary_hits(t->frame, random, kCount, hits);
      for (size_t i = 40; i < 80; ++i) hits.primitive[i] = hits.primitive[40];  // a run of one triangle: the uniform path
      for (const size_t miss : {50u, 1020u, 1023u, 1024u, 1040u}) hits.primitive[miss] = kNoPrimitive;
      SurfaceBatch want;
      resolve_surfaces(t->frame, hits, want);
      for (const BatchField& f : batch_fields(want)) hash.add(f.data, kCount * sizeof(float));
      for (const Isa isa : supported_isas()) {
        t->frame.isa = isa;
        for (const int size : {1, 3, 16, 1000, kCount}) {
          if (size == 1 && isa == Isa::kScalar) continue;
          SurfaceBatch s;
          for (int first = 0; first < kCount; first += size) {
            HitBatch part;
            for (int i = std::min(first + size, kCount); i-- > first;)  // reversed
              add_hit(part, hits.pixel[static_cast<size_t>(i)], 0, hits.primitive[static_cast<size_t>(i)]);
            resolve_surfaces(t->frame, part, s);
            for (int i = 0; i < part.count; ++i)
              ASSERT_EQ(surface_difference(want, first + part.count - 1 - i, s, i), "") << isa_name(isa) << " batch " << size;
          }
        }
      }
    }
  RecordProperty("hash", hash_text(hash.value()));  // to compare compilers by hand
}

TEST(ShadeSurfaceBatch, PrimaryRaysAsABatch) {
  TestRandom random(14);
  auto t = full_frame(random_surface_scene(15, 100), random_camera(random, 3), 1024, 1024);
  t->frame.plan.textures = t->frame.plan.bump = false;
  HitBatch hits, by_rays;
  random_primary_hits(t->frame, random, 1000, hits);
  RayBatch rays;
  for (int i = 0; i < hits.count; ++i) {
    const uint32_t pixel = hits.pixel[static_cast<size_t>(i)];
    const OracleRay r = oracle_primary(t->frame, pixel);
    const auto d = [](Real3 v) { return glm::dvec3(static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)); };
    add_hit(by_rays, pixel, static_cast<uint32_t>(add_ray(rays, d(r.origin), d(r.direction), pixel)), hits.primitive[static_cast<size_t>(i)]);
  }
  by_rays.rays = &rays;
  SurfaceBatch a, b;
  resolve_surfaces(t->frame, hits, a);
  resolve_surfaces(t->frame, by_rays, b);
  int checked = 0;
  for (int i = 0; i < hits.count; ++i) {
    const OracleHit h = oracle_hit(t->scene, hits.primitive[static_cast<size_t>(i)], oracle_primary(t->frame, hits.pixel[static_cast<size_t>(i)]));
    if (!h.inside || h.cosine < 0.1L) continue;
    ++checked;
    // The ray moved by half an ulp of origin (eye at 3) and direction: times 1 / cosine on the surface.
    for (int k = 0; k < 3; ++k) ASSERT_NEAR(a.position[k][i], b.position[k][i], 2e-6 / static_cast<double>(h.cosine));
  }
  EXPECT_GT(checked, 400);
  rays.primary = true;  // now the same numbers stand behind both
  resolve_surfaces(t->frame, by_rays, b);
  for (int i = 0; i < hits.count; ++i) ASSERT_EQ(surface_difference(a, i, b, i, "ray"), "");
}

TEST(ShadeSurfaceBatch, ThePlanChangesOnlyWhatItLeavesOut) {
  TestRandom random(16);
  auto t = full_frame(random_surface_scene(17, 60), random_camera(random, 3), 512, 512);
  HitBatch hits;
  random_primary_hits(t->frame, random, 200, hits);
  hits.primitive[33] = kNoPrimitive;
  SurfaceBatch all, less;
  resolve_surfaces(t->frame, hits, all);
  {
    HitBatch more;  // what stood there before must not be seen
    random_primary_hits(t->frame, random, 700, more);
    resolve_surfaces(t->frame, more, less);
  }
  t->frame.plan.specular = t->frame.plan.emission = t->frame.plan.ambient = t->frame.plan.bounces = t->frame.plan.bump = false;
  resolve_surfaces(t->frame, hits, less);
  for (int i = 0; i < hits.count; ++i)
    for (int k = 0; k < 3; ++k) {
      ASSERT_EQ(bits_of(all.diffuse[k][i]), bits_of(less.diffuse[k][i]));
      ASSERT_EQ(bits_of(all.position[k][i]), bits_of(less.position[k][i]));
      ASSERT_EQ(bits_of(less.specular[k][i]) | bits_of(less.emission[k][i]) | bits_of(less.ambient[k][i]) | bits_of(less.mirror[k][i]) |
                    bits_of(less.dpdx[k][i]) | bits_of(less.dpdy[k][i]), 0u);
    }
}

TEST(ShadeSurfaceBatch, StorageIsAlignedPaddedAndReused) {
  SurfaceBatch s;
  s.resize(1000);
  const float* block = s.position[0];
  const size_t bytes = s.memory_bytes();
  for (const BatchField& f : batch_fields(s)) EXPECT_EQ(reinterpret_cast<uintptr_t>(f.data) % 64, 0u) << f.name;
  auto fields = batch_fields(s);
  std::sort(fields.begin(), fields.end(), [](const BatchField& a, const BatchField& b) { return a.data < b.data; });
  for (size_t i = 1; i < fields.size(); ++i) EXPECT_GE(fields[i].data - fields[i - 1].data, 1016) << fields[i].name;
  s.resize(10), s.resize(999);
  EXPECT_EQ(s.position[0], block);
  EXPECT_EQ(s.memory_bytes(), bytes);
}

}  // namespace
}  // namespace spanray
