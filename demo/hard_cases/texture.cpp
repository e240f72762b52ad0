// Where textures are read, and what is read there (I6, I7, I8).
#include <cmath>

#include "cases.h"
#include "math/color.h"
#include "support/surface_scenes.h"
#include "support/texture_probe.h"

namespace spanray::hard {
namespace {

constexpr double kCode = 1.0 / 65535;  // of a texel

// Every level of a square texture filled with its number.
TextureProbe level_probe(int size, int step) {
  return TextureProbe([&](SceneData& scene, Material& m) {
    m.map_diffuse = add_texture(scene, size, size, [](int, int) { return Texel{0, 0, 0, 0}; });
    fill_levels(scene, [&](int k) { return static_cast<uint16_t>(k * step); });
  });
}

// Footprints from 1/8 to 32768 texels: log2 of the larger side, clamped, never falling; infinite and NaN footprints: the last level.
void check_levels(const Effort& effort, Tally& samples) {
  constexpr int kStep = 4096;
  TextureProbe probe = level_probe(1024, kStep);
  std::vector<double> sizes;
  const int steps = effort.count(2000, 200);
  for (int i = -3 * steps; i <= 15 * steps; ++i) sizes.push_back(std::pow(2.0, static_cast<double>(i) / steps));
  for (const double texels : sizes) probe.add(0.3, 0.4, texels / 1024, texels / 4096);
  for (const Filter filter : kFilters) {
    probe.frame().settings.filter = filter;
    const SurfaceBatch& s = probe.run();
    for (int i = 0; i < s.count; ++i) {
      const double level = s.diffuse[0][i] / kCode / kStep, want = std::clamp(std::log2(sizes[static_cast<size_t>(i)]), 0.0, 10.0);
      const double room = (filter == Filter::kTrilinear ? 0 : 0.5) + 0.6 / 256;
      samples.check(std::fabs(level - want) <= room && (i == 0 || s.diffuse[0][i] >= s.diffuse[0][i - 1]));
    }
  }
  TextureProbe far = level_probe(64, 1000);
  for (const double step : {1e10, 1e30, static_cast<double>(INFINITY), static_cast<double>(NAN)})
    far.add(0.3, 0.4, step, 0), far.add(0.3, 0.4, 0, -step);
  for (const Isa isa : supported_isas()) {
    const SurfaceBatch& s = far.run(isa);
    for (int i = 0; i < s.count; ++i) samples.check(std::fabs(s.diffuse[0][i] - 6000 * kCode) <= 1e-6);
  }
}

// From the feet of the viewer up to the horizon and past it.
void check_horizon(Tally& samples) {
  Material m;
  m.diffuse[0] = m.diffuse[1] = m.diffuse[2] = 1;
  const SoupTriangle tri = with_uv(soup_triangle({-1e6, 0, 1e6}, {1e6, 0, 1e6}, {0, 0, -1e6}), {-1e6, -1e6}, {1e6, -1e6}, {0, 1e6});
  SceneData scene = make_test_scene({tri}, {m});
  scene.materials[0].map_diffuse = add_texture(scene, 256, 256, [](int, int) { return Texel{0, 0, 0, 0}; });
  fill_levels(scene, [](int k) { return static_cast<uint16_t>(k * 4096); });
  Camera camera;
  camera.eye[1] = camera.target[1] = 1, camera.target[2] = -1;
  auto t = full_frame(std::move(scene), camera, 512, 512);
  HitBatch hits;
  for (uint32_t y = 512; y-- > 250;) add_hit(hits, pack_pixel(256, y), 0, 0);
  for (const Isa isa : supported_isas()) {
    t->frame.isa = isa;
    SurfaceBatch s;
    resolve_surfaces(t->frame, hits, s);
    for (int i = 0; i < s.count; ++i)
      samples.check(std::isfinite(s.diffuse[0][i]) && (i == 0 || i >= 256 || s.diffuse[0][i] >= s.diffuse[0][i - 1]));
    samples.check(s.diffuse[0][255] == 8 * 4096 * (1.0f / 65535) && s.diffuse[0][0] < 2 * 4096 * kCode);
  }
}

// A ramp over 4096 texels turns the sample into the coordinate that was read. Errors as a share of the bound.
void check_ramp(const Effort& effort, Worst& share) {
  TestRandom random(4);
  for (const double scale : {1e3, 1e4, 1e5, 1e6, 1e7}) {
    TextureProbe probe(
        [](SceneData& scene, Material& m) {
          m.map_diffuse = add_texture(scene, 4096, 1, [](int x, int) {
            const auto v = static_cast<uint16_t>(16 * x);
            return Texel{v, v, v, v};
          });
        },
        scale);
    probe.frame().settings.filter = Filter::kBilinear;
    for (int i = 0; i < effort.count(20000, 1000); ++i) {
      const glm::dvec3 p = random_point(random, 2.9) - glm::dvec3(1, 1, 0);
      probe.add(p.x, p.y);
    }
    const SurfaceBatch& s = probe.run();
    for (int i = 0; i < s.count; ++i) {
      const OracleHit hit = oracle_hit(probe.scene(), 0, oracle_ray(probe.rays(), i));
      Real uv[2];
      oracle_uv(probe.scene(), 0, hit.b, uv);
      const double texel = static_cast<double>((uv[0] - std::floor(uv[0])) * 4096);
      if (texel < 2 || texel > 4094) continue;  // the jump of the ramp
      const double ulp = std::ldexp(1.0, std::ilogb(static_cast<double>(uv[0])) - 23);
      share.add(std::fabs(s.diffuse[0][i] * 65535.0 / 16 + 0.5 - texel) / (ulp * 4096 + 1.0 / 256));
    }
  }
}

// A texture between two white ones: whatever the coordinate, nothing else than its own gray is read. Returns samples that did.
uint64_t read_outside(int width, int height, Worst& share) {
  TextureProbe probe([&](SceneData& scene, Material& m) {
    const auto guard = [&] { add_texture(scene, 64, 64, [](int, int) { return Texel{65535, 65535, 65535, 65535}; }); };
    guard();
    m.map_diffuse = add_texture(scene, width, height, [](int, int) { return Texel{1000, 1000, 1000, 1000}; });
    guard();
  });
  for (const double x : {0.0, 1.0, -1.0, 0.5, 1 - 1e-9, -1e-9, 1e-30, -1e-30, -3.9, 1.9})
    for (const double y : {0.0, 1.0, -1.0, 1 - 1e-9, -1e-9, 0.3})
      for (const double step : {0.0, 1e-3, 1.0, 1e9}) probe.add(x, y, step, step);
  TextureUse& use = probe.scene().texture_uses[1];
  uint64_t outside = 0;
  for (const Isa isa : supported_isas())
    for (const Filter filter : kFilters)
      for (const int clamp : {0, 1})
        for (const float scale : {1.0f, -1.0f, 1e7f, 1e20f, 3e38f, INFINITY, NAN}) {
          use.scale[0] = scale, use.scale[1] = -scale, use.clamp = clamp, use.offset[0] = scale > 1e30f ? -scale : 0;
          probe.frame().settings.filter = filter;
          const SurfaceBatch& s = probe.run(isa);
          for (int i = 0; i < s.count; ++i) {
            const bool wrong = s.diffuse[0][i] != 1000 * (1.0f / 65535);
            outside += wrong, share.add(wrong ? INFINITY : 0);
          }
        }
  return outside;
}

}  // namespace

Finding i6_level_of_detail(const Effort& effort) {
  Tally samples;
  check_levels(effort, samples);
  check_horizon(samples);
  return none_wrong(samples, "samples", 10000);
}

Finding i7_huge_uv(const Effort& effort) {
  Worst share;
  check_ramp(effort, share);
  uint64_t outside = 0;
  for (const auto& [w, h] : {std::pair{1, 1}, {2, 1}, {64, 32}, {1, 256}}) outside += read_outside(w, h, share);
  // Exactly 1 is 0.
  TextureProbe probe([](SceneData& scene, Material& m) {
    TestRandom random(5);
    m.map_diffuse = add_texture(scene, 64, 64, [&](int, int) { return noise_texel(random); });
  });
  for (const double x : {0.0, 1.0, -1.0, -2.0}) probe.add(x, 0.37), probe.add(0.37, x);
  for (const Filter filter : kFilters) {
    probe.frame().settings.filter = filter;
    const SurfaceBatch& s = probe.run();
    for (int i = 2; i < s.count; ++i) share.add(s.diffuse[0][i] == s.diffuse[0][i & 1] ? 0 : INFINITY);
  }
  return within(share, 1, "of the bound", "samples", 4000, grouped(outside) + " read outside the texture");
}

// A quad of two triangles with one texel a pixel, and every sRGB code at texel centers.
Finding i8_blit(const Effort& effort) {
  Tally texels;
  TestRandom random(1);
  const auto gray = [](uint8_t code) { const uint16_t v = linear16_from_srgb8(code); return Texel{v, v, v, v}; };
  for (int n = 0; n < effort.count(20, 2); ++n) {
    std::vector<uint8_t> code(64 * 64);
    for (uint8_t& c : code) c = static_cast<uint8_t>(random.bits());
    Material m;
    m.diffuse[0] = m.diffuse[1] = m.diffuse[2] = 1;
    const SoupTriangle a = with_uv(soup_triangle({-32, -32, 0}, {32, -32, 0}, {32, 32, 0}), {0, 0}, {1, 0}, {1, 1});
    const SoupTriangle b = with_uv(soup_triangle({-32, -32, 0}, {32, 32, 0}, {-32, 32, 0}), {0, 0}, {1, 1}, {0, 1});
    SceneData scene = make_test_scene({a, b}, {m});
    scene.materials[0].map_diffuse = add_texture(scene, 64, 64, [&](int x, int y) { return gray(code[static_cast<size_t>(y * 64 + x)]); });
    Camera camera;
    camera.fov_y_degrees = 90, camera.eye[2] = 32;
    auto t = full_frame(std::move(scene), camera, 64, 64);
    HitBatch hits;
    for (uint32_t y = 0; y < 64; ++y)
      for (uint32_t x = 0; x < 64; ++x) add_hit(hits, pack_pixel(x, y), 0, 63 - y > x ? 1 : 0);
    for (const Isa isa : supported_isas())
      for (const Filter filter : kFilters) {
        t->frame.isa = isa, t->frame.settings.filter = filter;
        SurfaceBatch s;
        resolve_surfaces(t->frame, hits, s);
        for (int i = 0; i < 64 * 64; ++i) texels.check(srgb8_from_linear(s.diffuse[1][i]) == code[static_cast<size_t>(i)]);
      }
  }
  TextureProbe probe([&](SceneData& scene, Material& m) {
    m.map_diffuse = add_texture(scene, 256, 2, [&](int x, int) { return gray(static_cast<uint8_t>(x)); });
  });
  for (int x = 0; x < 256; ++x) probe.add((x + 0.5) / 256, 0.25), probe.add((x + 0.5) / 256, 0.75, 1.0 / 256, 1.0 / 2);
  for (const Isa isa : supported_isas())
    for (const Filter filter : kFilters) {
      probe.frame().settings.filter = filter;
      const SurfaceBatch& s = probe.run(isa);
      for (int i = 0; i < s.count; ++i) texels.check(srgb8_from_linear(s.diffuse[0][i]) == i / 2);
    }
  return none_wrong(texels, "texels", 10000);
}

}  // namespace spanray::hard
