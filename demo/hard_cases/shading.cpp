// Light on one surface at the edges of its domain (S1 to S8).
#include <cmath>

#include "cases.h"
#include "math/elementary.h"
#include "spanray/render.h"
#include "support/bvh_oracle.h"
#include "support/surface_scenes.h"
#include "support/test_surfaces.h"

namespace spanray::hard {

// pow_ in double, bases from 1 - 1e-6 and 1 + ulp, exponents to 1e4, and the special values; then highlights in float, as a share of
// their stated bound of (4 n + 8) ulp of the correctly rounded value.
Finding s1_powers(const Effort& effort) {
  TestRandom random(5);
  Worst share;
  for (int i = 0; i < effort.count(1000000, 100000); ++i) {
    const double base = i % 3 == 0   ? 1 + 0x1p-23 * random.between(-64, 64)
                        : i % 3 == 1 ? random.uniform(1e-6, 1)
                                     : 1 - random.uniform(0, 1e-3);
    const double n = std::pow(10.0, random.uniform(-3, 4));
    const long double exact = std::pow(static_cast<long double>(base), static_cast<long double>(n));
    if (exact < 0x1p-1000L) continue;  // underflows
    share.add(static_cast<double>(std::fabs(pow_(base, n) / exact - 1) / 0x1p-41L));
  }
  const double special[][3] = {{0, 0, 1}, {0, 3, 0}, {-0.0, 3, 0}, {1, 1e4, 1}, {1, 0, 1}, {0.5, 1e4, 0}, {0, 1e4, 0}};
  for (const auto& [base, n, want] : special) share.add(pow_(base, n) == want ? 0 : INFINITY);
  const float shininess[] = {0, 0x1p-149f, 0.5f, 1, 2, 100, 1e4f};
  for (const double tilt : {0.0, 1e-7, 1e-4, 0.01, 0.1, 1.0, 1.5, 1.5707}) {
    auto t = one_surface(directional_light({std::sin(tilt), 0, std::cos(tilt)}), 7);
    for (int i = 0; i < 7; ++i) t->surfaces.shininess[i] = shininess[i];
    for (const Isa isa : supported_isas()) {
      const TestRadiance r = shade_all(*t, isa);
      for (int i = 0; i < 7; ++i) {
        const double got = r.channel[0][static_cast<size_t>(i)], want = oracle_light(t->oracle(i), t->scene().lights[0]).x;
        share.add(std::fabs(got - want) / (want * (4 * shininess[i] + 8) * 0x1p-24 + 1e-38));
      }
    }
  }
  return within(share, 1, "of the stated bound", "values", 50000, "2^-41 relative in double, (4 n + 8) ulp in float");
}

// The view is the light's exact opposite, or nearly so: only the diffuse part is left.
Finding s2_zero_half_vector(const Effort& effort) {
  TestRandom random(51);
  Tally surfaces;
  for (int n = 0; n < effort.count(4000, 200); ++n) {
    const glm::dvec3 toward = normalize3(random_unit(random) + glm::dvec3(0, 0, 1.2), glm::dvec3(0, 0, 1));
    auto t = one_surface(directional_light(toward), 3);
    for (int i = 0; i < 3; ++i) {
      t->surfaces.shininess[i] = i == 0 ? 0.0f : i == 1 ? 1.0f : 1e4f;
      const glm::dvec3 nudge = n % 2 != 0 ? 1e-7 * random_unit(random) : glm::dvec3(0);
      for (int k = 0; k < 3; ++k) t->surfaces.view[k][i] = t->scene().lights[0].direction[k] + static_cast<float>(nudge[k]);
      put3(t->surfaces.diffuse, i, glm::dvec3(1));
    }
    for (const Isa isa : supported_isas()) {
      const TestRadiance r = shade_all(*t, isa);
      for (size_t i = 0; i < 3; ++i) surfaces.check(std::fabs(r.channel[0][i] - toward.z / kPi) <= 1e-6);
    }
  }
  return none_wrong(surfaces, "surfaces", 600);
}

// At height 0 there is no direction and no light; above it at most the cap of kMinAttenuation.
Finding s3_light_on_surface(const Effort&) {
  Worst share;
  const double cap = 1 / double(kMinAttenuation) * 2 / kPi;
  for (const double height : {0.0, 1e-45, 1e-30, 1e-20, 1e-12, 1e-8, 1e-6, 1e-4, 0.009}) {
    Light light;
    light.position[2] = static_cast<float>(height);
    auto t = one_surface(light);
    put3(t->surfaces.diffuse, 0, glm::dvec3(1));
    for (const Isa isa : supported_isas()) {
      const double got = shade_all(*t, isa).channel[0][0];
      share.add(got / cap);
      if (height == 0) share.add(got == 0 ? 0 : INFINITY);
      if (height > 1e-9) share.add(got >= cap * 0.999999 ? 0 : INFINITY);
    }
  }
  return within(share, 1.000001, "of the cap", "values", 9, "the cap is E = I / " + short_text(double(kMinAttenuation)));
}

Finding s4_fresnel(const Effort&) { return not_measured("this version has no Fresnel term: mirrors have one weight at all angles"); }

Finding s5_albedo(const Effort&) {
  return not_measured("the catalog of this version has Lambert and the highlight of MTL files, which is not normalized by definition");
}

// Surfaces at the corners of triangles, seen by the eye and by rays.
Finding s6_gouraud(const Effort& effort) {
  Worst codes;
  for (int n = 0; n < effort.count(40, 2); ++n) {
    auto t = make_test_surfaces(static_cast<uint32_t>(1 + n / 2), 60 * 3, Shading::kGouraud, n % 2 != 0);
    for (int i = 0; i < 180; ++i) {
      glm::dvec3 weight(0);
      weight[i % 3] = 1;
      if (t->surfaces.valid[i] != 0) put_surface(*t, i, static_cast<uint32_t>(i / 3), weight, t->viewer(i));
    }
    for (const Isa isa : supported_isas()) {
      t->frame().settings.shading = Shading::kGouraud;
      const TestRadiance gouraud = shade_all(*t, isa);
      t->frame().settings.shading = Shading::kPhong;
      const TestRadiance phong = shade_all(*t, isa);
      double brightest = 0;
      for (int i = 0; i < 180; ++i) {
        const auto s = static_cast<size_t>(i);
        const glm::dvec3 want(phong.channel[0][s], phong.channel[1][s], phong.channel[2][s]);
        codes.add(255 * gouraud.max_encoded_difference(i, want));
        brightest = std::max(brightest, want.x);
      }
      if (brightest < 0.5) codes.add(INFINITY);  // a dark picture shows nothing
    }
  }
  return within(codes, 1, "of 255", "corners", 360);
}

// A multiplier of 0 changes no bit; huge ones end at the horizon.
Finding s7_bump(const Effort& effort) {
  TestRandom random(4);
  auto t = full_frame(bumpy_scene(random), random_camera(random, 3), 256, 256);
  HitBatch hits;
  random_primary_hits(t->frame, random, effort.count(5000, 500), hits);
  TextureUse& use = t->scene.texture_uses.back();
  Tally surfaces;
  uint64_t moved = 0, clamped = 0;
  for (const Isa isa : supported_isas()) {
    t->frame.isa = isa;
    SurfaceBatch bumped, zero, off;
    use.bump_multiplier = 1;
    resolve_surfaces(t->frame, hits, bumped);
    use.bump_multiplier = 0;
    resolve_surfaces(t->frame, hits, zero);
    t->frame.plan.bump = false;
    resolve_surfaces(t->frame, hits, off);
    t->frame.plan.bump = true;
    for (int i = 0; i < hits.count; ++i) {
      surfaces.check(surface_difference(zero, i, off, i).empty());
      moved += bits_of(bumped.normal[0][i]) != bits_of(off.normal[0][i]);
    }
    for (const float multiplier : {1.0f, 50.0f, 1e6f, 1e38f, -1e38f}) {
      use.bump_multiplier = multiplier;
      SurfaceBatch s;
      resolve_surfaces(t->frame, hits, s);
      for (int i = 0; i < hits.count; ++i) {
        const Real cosine = dot_real(real3(s.normal, i), real3(s.geometric_normal, i));
        surfaces.check(cosine >= 0x1p-10L / 1.5L && std::fabs(length_real(real3(s.normal, i)) - 1) <= 1e-6L);
        clamped += cosine < 0x1.1p-10L;
      }
    }
  }
  if (moved < 200 || clamped < 120) surfaces.check(false, [] { return std::string("hardly a normal was bumped or clamped"); });
  return none_wrong(surfaces, "surfaces", 3000, grouped(clamped) + " clamped to the horizon");
}

// A smooth sphere of 20 * 4^levels triangles, lit from the side, with ray shadows: linear radiance and who was covered.
static Framebuffer smooth_sphere(int levels, ShadowTerminator terminator) {
  const IndexedMesh mesh = make_sphere(levels);
  std::vector<SoupTriangle> soup;
  add_mesh(soup, mesh, 1, glm::dvec3(0));
  for (SoupTriangle& t : soup)
    for (Vertex& v : t.corner) std::copy(v.position, v.position + 3, v.normal);
  Material white;
  for (int k = 0; k < 3; ++k) white.diffuse[k] = 1, white.ambient[k] = 0;
  SceneData scene = make_test_scene(soup, {white});
  scene.lights.push_back(directional_light({0.96, 0.28, 0}));
  for (float& c : scene.lights[0].intensity) c = 3;
  Camera camera;
  camera.eye[2] = 4, camera.fov_y_degrees = 32;
  Settings settings;
  settings.width = settings.height = 240, settings.shadow_terminator = terminator;
  Renderer renderer;
  Framebuffer out;
  FrameRequest request;
  request.primitive = true;
  if (!renderer.render(Scene(std::make_shared<SceneData>(std::move(scene))), camera, settings, out, request)) out.primitive.clear();
  return out;
}

// Against the sphere of 81,920 triangles. The error is reported, off and lifted (Settings::shadow_terminator); the law is that it falls
// with the size of the triangles, and that lifted rays take away more than half of it.
Finding s8_terminator(const Effort&) {
  const Framebuffer dense = smooth_sphere(6, ShadowTerminator::kOff);
  double rms[2][3] = {};
  std::string text;
  uint64_t pixels = 0;
  for (int levels = 2; levels <= 4; ++levels) {
    text += (levels == 2 ? "" : "; ") + grouped(20u << (2 * levels)) + " triangles";
    for (const ShadowTerminator terminator : {ShadowTerminator::kOff, ShadowTerminator::kLifted}) {
      const bool lifted = terminator == ShadowTerminator::kLifted;
      const Framebuffer coarse = smooth_sphere(levels, terminator);
      double& error = rms[lifted][levels - 2];
      uint64_t count = 0, far = 0;
      for (size_t i = 0; i < std::min(dense.primitive.size(), coarse.primitive.size()); ++i) {
        if (dense.primitive[i] == kNoPrimitive || coarse.primitive[i] == kNoPrimitive) continue;
        const double d = std::abs(int{dense.color.rgba[4 * i]} - int{coarse.color.rgba[4 * i]});
        ++count, far += d > 8, error += d * d;
      }
      error = count == 0 ? NAN : std::sqrt(error / static_cast<double>(count));
      text += (lifted ? ", lifted " : ": off ") + short_text(error) + " (" +
              short_text(100.0 * static_cast<double>(far) / static_cast<double>(count)) + " % of pixels off by more than 8)";
      pixels = count;
    }
  }
  Finding f;
  bool falls = true;
  for (const auto& errors : rms) falls &= errors[0] > errors[1] && errors[1] > errors[2];
  for (int k = 0; k < 3; ++k) falls &= rms[1][k] < 0.5 * rms[0][k];
  f.verdict = falls ? Verdict::kPass : Verdict::kFail;
  f.measured = rms[0][0], f.unit = "of 255, RMS, 320 triangles", f.checked = pixels;
  f.text = "RMS of 255: " + text;
  return f;
}

}  // namespace spanray::hard
