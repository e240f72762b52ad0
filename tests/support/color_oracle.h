// The color of a primary hit, geometry in long double, light and texels in double, written from the model's definitions (no code of engine/shade or engine/catalog): the
// triangle's plane, interpolated normals, color maps by footprint, direct light without shadows. Given: what the pixel sees, and no map of
// shininess.
// Texture coordinates and levels of detail count in 1/256, as DESIGN 3.13 defines sampling.
#pragma once
#include "support/shading_oracle.h"
#include "support/surface_oracle.h"

namespace spanray {

class ColorOracle {
 public:
  ColorOracle(const SceneData& scene, const Frame& frame) : scene_(scene), frame_(frame) {}

  // Linear radiance at the center of a pixel that sees `primitive`.
  glm::dvec3 radiance(uint32_t pixel, uint32_t primitive) const {
    const Triangle& triangle = scene_.triangles[primitive];
    const Material& m = scene_.materials[material_of(triangle)];
    OracleHit hit = oracle_hit(scene_, primitive, oracle_primary(frame_, pixel));
    clamp_to_triangle(primitive, hit);
    const Real3 view = unit(real3(frame_.primary.eye) - hit.position);
    const Real3 geometric = dot_real(hit.normal, view) < 0 ? hit.normal * -1 : hit.normal;
    const Uv uv = uv_of(pixel, primitive, hit);
    OracleSurface s;
    s.position = to_double(hit.position), s.view = to_double(view);
    s.geometric_normal = to_double(geometric), s.normal = to_double(normal_of(triangle, hit, geometric));
    s.diffuse = color(m.diffuse, m.map_diffuse, uv);
    s.ambient = color(m.ambient, m.map_ambient >= 0 ? m.map_ambient : m.map_diffuse, uv);
    s.specular = color(m.specular, m.map_specular, uv);
    s.emission = color(m.emission, m.map_emission, uv);
    s.shininess = m.shininess;
    return oracle_radiance(s, scene_, ~uint64_t{0}, m.reflectance);
  }

 private:
  struct Uv { Real at[2], dx[2], dy[2]; };

  static Real3 unit(Real3 a) { return a * (1 / length_real(a)); }
  static glm::dvec3 to_double(Real3 a) { return {static_cast<double>(a.x), static_cast<double>(a.y), static_cast<double>(a.z)}; }

  // Snapping may show a triangle up to half a 1/256 pixel outside of it: its nearest weights are taken.
  void clamp_to_triangle(uint32_t primitive, OracleHit& hit) const {
    Real sum = 0;
    for (Real& b : hit.b) sum += b = std::min(std::max(b, Real(0)), Real(1));
    hit.position = {};
    for (int k = 0; k < 3; ++k) hit.b[k] /= sum, hit.position = hit.position + oracle_vertex(scene_, primitive, k) * hit.b[k];
  }

  Real3 normal_of(const Triangle& triangle, const OracleHit& hit, Real3 geometric) const {
    Real3 sum, blend;
    for (int k = 0; k < 3; ++k) {
      const Real3 corner = real3(scene_.vertices[triangle.vertex[k]].normal);
      sum = sum + corner, blend = blend + corner * hit.b[k];
    }
    if (dot_real(sum, geometric) < 0) blend = blend * -1;
    if (dot_real(blend, blend) <= Real(1e-6)) return geometric;
    const Real3 n = unit(blend);
    const Real least = Real(1) / 1024, cosine = dot_real(n, geometric);  // held above the horizon
    return cosine < least ? unit(n + geometric * (least - cosine)) : n;
  }

  // Derivatives by pixel along the triangle's plane, from differences: exact to 1e-8 of them.
  Uv uv_of(uint32_t pixel, uint32_t primitive, const OracleHit& hit) const {
    Uv uv;
    oracle_uv(scene_, primitive, hit.b, uv.at);
    const Real h = Real(1e-5);
    Real low[2], high[2];
    for (const bool x : {true, false}) {
      oracle_uv(scene_, primitive, oracle_hit(scene_, primitive, oracle_primary(frame_, pixel, x ? -h : 0, x ? 0 : -h)).b, low);
      oracle_uv(scene_, primitive, oracle_hit(scene_, primitive, oracle_primary(frame_, pixel, x ? h : 0, x ? 0 : h)).b, high);
      for (int k = 0; k < 2; ++k) (x ? uv.dx : uv.dy)[k] = (high[k] - low[k]) / (2 * h);
    }
    return uv;
  }

  // 256 times log2 of the longer side of the footprint: per octave x + x (1 - x) q(x), q quadratic (Williams 1983 leaves the measure open; the
  // renderer defines it so).
  static int level_256(Real square) {
    int exponent;
    const Real x = 2 * std::frexp(square, &exponent) - 1;
    const Real q = ((Real(0.0816157f) * x + Real(-0.2426695f)) * x + Real(0.4407808f));
    return static_cast<int>(std::nearbyint(128 * (exponent - 1 + x + x * (1 - x) * q)));
  }

  // Bilinear on one level, [0, 1].
  glm::dvec3 bilinear(const Texture& t, int level, bool clamp, const Real uv[2]) const {
    const int w = std::max(1, t.width >> level), h = std::max(1, t.height >> level);
    const auto place = [&](Real u, int size) {
      u = clamp ? std::min(std::max(u, Real(0)), Real(1)) : u - std::floor(u);
      return static_cast<int>(std::nearbyint(u * size * 256)) - 128;
    };
    const Real down = 1 - (clamp ? uv[1] : uv[1] - std::floor(uv[1]));
    const int x = place(uv[0], w), y = down == 1 ? 256 * h - 128 : place(down, h);
    const auto wrap = [&](int i, int n) { return clamp ? std::min(std::max(i, 0), n - 1) : ((i % n) + n) % n; };
    const auto texel = [&](int i, int j) {
      const Texel& p = scene_.texels[static_cast<size_t>(t.offset[level] + wrap(j, h) * w + wrap(i, w))];
      return glm::dvec3(p.r, p.g, p.b) / 65535.0;
    };
    const int i = x >> 8, j = y >> 8;
    const double fx = (x & 255) / 256.0, fy = (y & 255) / 256.0;
    return (1 - fy) * ((1 - fx) * texel(i, j) + fx * texel(i + 1, j)) + fy * ((1 - fx) * texel(i, j + 1) + fx * texel(i + 1, j + 1));
  }

  glm::dvec3 color(const float* constant, int map, const Uv& uv) const {
    const glm::dvec3 base = oracle_vec(constant);
    if (map < 0) return base;
    const TextureUse& use = scene_.texture_uses[static_cast<size_t>(map)];
    const Texture& t = scene_.textures[static_cast<size_t>(use.texture)];
    const Real scale[2] = {use.scale[0], use.scale[1]}, size[2] = {Real(t.width), Real(t.height)};
    Real at[2], square[2] = {0, 0};
    for (int k = 0; k < 2; ++k) {
      at[k] = uv.at[k] * scale[k] + Real(use.offset[k]);
      const Real dx = uv.dx[k] * scale[k] * size[k], dy = uv.dy[k] * scale[k] * size[k];
      square[0] += dx * dx, square[1] += dy * dy;
    }
    const int level = std::min(std::max(level_256(std::max(square[0], square[1])), 0), (t.levels - 1) * 256);
    const int first = level >> 8, second = std::min(first + 1, t.levels - 1);
    const double weight = (level & 255) / 256.0;
    glm::dvec3 value = (1 - weight) * bilinear(t, first, use.clamp != 0, at);
    if (weight > 0) value += weight * bilinear(t, second, use.clamp != 0, at);
    value = glm::dvec3(use.base) + double{use.gain} * value;
    for (int c = 0; c < 3; ++c) value[c] = std::max(value[c], 0.0);
    return base * value;
  }

  const SceneData& scene_;
  const Frame& frame_;
};

}  // namespace spanray
