#include "reference/surface.h"

#include <algorithm>
#include <cmath>

namespace spanray::reference {
namespace {

constexpr double kLeastLiftAngle = 0x1p-16;  // radians
constexpr double kLiftShare = 0.75;

double max_abs(const glm::dvec3& v) { return std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)}); }

// A shading normal below the horizon is lifted to it.
glm::dvec3 above_horizon(const glm::dvec3& n, const glm::dvec3& geometric) {
  const double cosine = dot3(n, geometric);
  return cosine < kHorizon ? normalize3(n + geometric * (kHorizon - cosine), geometric) : n;
}

// The part of a direction that is perpendicular to n; zero where nothing is left of it.
glm::dvec3 tangent(const glm::dvec3& along, const glm::dvec3& n, double scale) {
  const glm::dvec3 flat = along - n * dot3(n, along);
  return dot3(flat, flat) > 0x1p-20 ? normalize3(flat, glm::dvec3(0)) * (scale < 0 ? -1.0 : 1.0) : glm::dvec3(0);
}

}  // namespace

Role role_of(const Material& m, const Settings& settings) {
  const bool cut = m.map_opacity >= 0, thin = m.opacity < 1;
  if (!cut && !thin) return Role::kOpaque;
  const auto wish = static_cast<MaterialTransparency>(m.transparency);
  const Role own = wish == MaterialTransparency::kMask         ? Role::kMask
                   : wish == MaterialTransparency::kAlpha      ? Role::kBlended
                   : wish == MaterialTransparency::kScreenDoor ? Role::kScreenDoor
                                                               : Role::kOpaque;
  const bool translucent = thin || own == Role::kBlended || own == Role::kScreenDoor;
  if (settings.transparency == Transparency::kNone) return cut ? Role::kMask : Role::kOpaque;
  if (settings.transparency == Transparency::kAlpha && translucent) return Role::kBlended;
  if (settings.transparency == Transparency::kScreenDoor && translucent) return Role::kScreenDoor;
  return own;
}

Surfaces::Surfaces(const SceneData& scene, const Settings& settings)
    : scene_(scene), settings_(settings), textures_(scene, settings.filter) {
  for (const Material& m : scene.materials) role_.push_back(role_of(m, settings));
}

const TextureUse* Surfaces::use(int32_t map) const {
  if (map < 0 || scene_.textures.empty()) return nullptr;
  const TextureUse& u = scene_.texture_uses[static_cast<size_t>(map)];
  return u.texture < 0 ? nullptr : &u;
}

struct Surfaces::Point {
  glm::dvec3 v[3], edge1{0}, edge2{0}, normal{0};  // cross(edge1, edge2)
  double t = 0, weight[3] = {};
  glm::dvec3 position{0}, geometric{0}, position_dx{0}, position_dy{0};
  double du[2] = {}, dv[2] = {};  // what the weights 1 and 2 add to u and v
  Coordinates uv;

  // How the position moves on the plane that touches the surface there, with the footprint of its ray, t and normal being known.
  void move(const Ray& ray) {
    const glm::dvec3& d = ray.line.direction;
    const auto on_plane = [&](const glm::dvec3& origin_d, const glm::dvec3& direction_d) {
      const glm::dvec3 moved = origin_d + direction_d * t;
      return moved - d * (dot3(moved, normal) / dot3(d, normal));
    };
    position_dx = on_plane(ray.origin_dx, ray.direction_dx), position_dy = on_plane(ray.origin_dy, ray.direction_dy);
  }
};

// As point_at, of a sphere, with the tangent plane for that of a triangle; v[0] is the center, the edges stand for its size.
Surfaces::Point Surfaces::point_on_sphere(const Ray& ray, uint32_t primitive) const {
  const Sphere& sphere = scene_.sphere(primitive);
  const glm::dvec3 &o = ray.line.origin, &d = ray.line.direction;
  Point p;
  p.v[0] = to_dvec(sphere.center), p.edge1 = p.edge2 = glm::dvec3(sphere.radius);
  double t[2] = {0, 0};
  if (!meets(ray.line, p.v[0], sphere.radius, t)) t[0] = t[1] = dot3(p.v[0] - o, d) / dot3(d, d);
  // The one that the ray was stopped by: rays start off the surface, by the clearance, so that one is in front.
  const bool enters = t[0] > ray.t_min;
  p.t = enters ? t[0] : t[1];
  const glm::dvec3 outward = normalize3(o + d * p.t - p.v[0], glm::dvec3(0, 0, 1));
  p.position = p.v[0] + outward * double{sphere.radius};
  p.normal = p.geometric = enters ? outward : -outward;
  p.move(ray);
  return p;
}

// As point_at, of a plane. What the clearance is made from, v[0] and the edges, is the position and the way to it.
Surfaces::Point Surfaces::point_on_plane(const Ray& ray, uint32_t primitive) const {
  const Plane& plane = scene_.plane(primitive);
  const glm::dvec3 &o = ray.line.origin, &d = ray.line.direction, normal = to_dvec(plane.normal);
  Point p;
  if (!meets(ray.line, plane, p.t)) p.t = 0;
  p.position = o + d * p.t;
  p.v[0] = p.position, p.edge1 = d * p.t;
  p.geometric = normalize3(normal, glm::dvec3(0));
  if (dot3(normal, o - to_dvec(plane.point)) < 0) p.geometric = -p.geometric;
  p.normal = p.geometric;
  p.move(ray);
  return p;
}

// o + t d = v0 + b1 edge1 + b2 edge2, by Cramer's rule; derivatives by differentiating it: the tip moves with the footprint,
// then back along the ray onto the plane (Igehy 1999, 10 to 12).
Surfaces::Point Surfaces::point_at(const Ray& ray, uint32_t primitive, const Nudge& nudge) const {
  if (scene_.is_sphere(primitive)) return point_on_sphere(ray, primitive);
  if (scene_.is_plane(primitive)) return point_on_plane(ray, primitive);
  const Triangle& triangle = scene_.triangles[primitive];
  Point p;
  for (int k = 0; k < 3; ++k) p.v[k] = to_dvec(scene_.vertices[triangle.vertex[k]].position);
  p.edge1 = p.v[1] - p.v[0], p.edge2 = p.v[2] - p.v[0], p.normal = cross3(p.edge1, p.edge2);
  const glm::dvec3 &d = ray.line.direction, s = ray.line.origin - p.v[0];
  const double det = dot3(p.edge1, cross3(d, p.edge2));
  p.weight[1] = dot3(s, cross3(d, p.edge2)) / det, p.weight[2] = dot3(d, cross3(s, p.edge1)) / det;
  p.weight[0] = 1 - p.weight[1] - p.weight[2];
  p.t = dot3(p.edge2, cross3(s, p.edge1)) / det;
  p.position = p.v[0] + p.edge1 * p.weight[1] + p.edge2 * p.weight[2];
  p.geometric = normalize3(p.normal, glm::dvec3(0));
  if (dot3(p.geometric, s) < 0) p.geometric = -p.geometric;
  p.move(ray);

  const float *c0 = scene_.vertices[triangle.vertex[0]].uv, *c1 = scene_.vertices[triangle.vertex[1]].uv,
              *c2 = scene_.vertices[triangle.vertex[2]].uv;
  p.du[0] = double{c1[0]} - c0[0], p.du[1] = double{c2[0]} - c0[0], p.dv[0] = double{c1[1]} - c0[1],
  p.dv[1] = double{c2[1]} - c0[1];
  p.uv.u = c0[0] + p.weight[1] * p.du[0] + p.weight[2] * p.du[1];
  p.uv.v = c0[1] + p.weight[1] * p.dv[0] + p.weight[2] * p.dv[1];
  p.uv.nudge = nudge;
  // Weights of a step within the plane.
  const double square = dot3(p.normal, p.normal);
  const auto step = [&](const glm::dvec3& move, double& du, double& dv) {
    const double b1 = dot3(cross3(move, p.edge2), p.normal) / square, b2 = dot3(cross3(p.edge1, move), p.normal) / square;
    du = b1 * p.du[0] + b2 * p.du[1], dv = b1 * p.dv[0] + b2 * p.dv[1];
  };
  step(p.position_dx, p.uv.du_dx, p.uv.dv_dx), step(p.position_dy, p.uv.du_dy, p.uv.dv_dy);
  return p;
}

bool Surfaces::culled(const Ray& ray, uint32_t primitive) const {
  if (settings_.culling != Culling::kBack) return false;
  if (scene_.is_sphere(primitive)) {
    // Faces seen from within: all of it for rays from there, and nothing where it is entered.
    double t[2];
    const Sphere& sphere = scene_.sphere(primitive);
    return !meets(ray.line, to_dvec(sphere.center), sphere.radius, t) || !(t[0] > ray.t_min);
  }
  if (scene_.is_plane(primitive))
    return !(dot3(to_dvec(scene_.plane(primitive).normal), ray.line.origin - to_dvec(scene_.plane(primitive).point)) > 0);
  const Triangle& triangle = scene_.triangles[primitive];
  const glm::dvec3 v0 = to_dvec(scene_.vertices[triangle.vertex[0]].position);
  const glm::dvec3 n = cross3(to_dvec(scene_.vertices[triangle.vertex[1]].position) - v0,
                              to_dvec(scene_.vertices[triangle.vertex[2]].position) - v0);
  const double side = dot3(n, ray.line.origin - v0);
  return !((triangle.bits & kTriangleFlipped) != 0 ? side < 0 : side > 0);
}

double Surfaces::stop_opacity(const Ray& ray, uint32_t primitive, const Nudge& nudge) const {
  const Role how = role(primitive);
  if (how != Role::kMask && how != Role::kScreenDoor) return 1;
  const Material& m = material(primitive);
  double opacity = settings_.transparency == Transparency::kNone ? 1.0 : double{m.opacity};
  constexpr double kMaskLastLevel = 2;  // coarser ones would thin a fence until it is gone
  if (const TextureUse* map = use(m.map_opacity))
    opacity *= textures_.scalar(*map, point_at(ray, primitive, nudge).uv, kMaskLastLevel);
  return opacity;
}

bool Surfaces::stops(const Ray& ray, uint32_t primitive) const {
  return !culled(ray, primitive) && stops(ray, primitive, stop_opacity(ray, primitive));
}

bool Surfaces::stops(const Ray& ray, uint32_t primitive, double opacity) const {
  const Role how = role(primitive);
  if (how != Role::kMask && how != Role::kScreenDoor) return true;
  if (how == Role::kMask) return opacity >= 0.5;
  // Bayer 1973: rank in an ordered dither of 8 x 8, the bits of x ^ y and y from the lowest up, as digits from the highest
  // down.
  int rank = 0;
  for (int bit = 0; bit < 3; ++bit) rank |= (((ray.x ^ ray.y) >> bit & 1) * 2 + (ray.y >> bit & 1)) << (4 - 2 * bit);
  return ((rank + ray.rank_shift) & 63) < static_cast<int>(std::floor(std::clamp(opacity, 0.0, 1.0) * 64 + 0.5));
}

// Blended corner normals, all turned to the side of the ray as one.
glm::dvec3 Surfaces::interpolated_normal(const Point& point, uint32_t primitive) const {
  if (!scene_.is_triangle(primitive)) return point.geometric;
  glm::dvec3 sum(0), blend(0);
  for (int k = 0; k < 3; ++k) {
    const glm::dvec3 corner = to_dvec(scene_.vertices[scene_.triangles[primitive].vertex[k]].normal);
    sum += corner, blend += corner * point.weight[k];
  }
  if (dot3(sum, point.geometric) < 0) blend = -blend;
  return dot3(blend, blend) > 1e-6 ? normalize3(blend, point.geometric) : point.geometric;
}

// Toward the point's projections onto the tangent planes at the corners, blended (Hanika 2021, "Hacking the Shadow Terminator"),
// where it lies below them; kLiftShare of the way, as Phong tessellation goes (Boubekeur and Alexa 2008). Nothing for corners that agree, for what angles below 2^-16 would lift, and where the result is not above
// the triangle.
glm::dvec3 Surfaces::lift(const Point& point, uint32_t primitive, double clearance) const {
  if (!scene_.is_triangle(primitive)) return glm::dvec3(0);
  const Triangle& triangle = scene_.triangles[primitive];
  glm::dvec3 corner[3], sum(0), lift(0);
  for (int k = 0; k < 3; ++k) corner[k] = to_dvec(scene_.vertices[triangle.vertex[k]].normal), sum += corner[k];
  if (corner[0] == corner[1] && corner[0] == corner[2]) return lift;
  const double side = dot3(sum, point.geometric) < 0 ? -1 : 1;
  for (int k = 0; k < 3; ++k) {
    const glm::dvec3 from = point.position - point.v[k];
    const double below = -dot3(from, corner[k] * side);
    if (below > kLeastLiftAngle * (std::fabs(from.x) + std::fabs(from.y) + std::fabs(from.z)))
      lift += corner[k] * (side * below * point.weight[k] * kLiftShare);
  }
  return dot3(lift, point.geometric) > 8 * clearance ? lift : glm::dvec3(0);
}

// Height maps after Blinn 1978, then normal maps, whose 8-bit channel c means (c - 128) / 127. Tangents go along growing s and
// t.
glm::dvec3 Surfaces::bumped(const Point& p, const Material& m, glm::dvec3 n) const {
  if (p.du[0] * p.dv[1] - p.du[1] * p.dv[0] == 0) return n;
  const glm::dvec3 b1 = cross3(p.edge2, p.normal),
                   b2 = cross3(p.normal, p.edge1);  // gradients of the weights, but for |normal|^2
  const glm::dvec3 along_u = normalize3(b1 * p.du[0] + b2 * p.du[1], glm::dvec3(0)),
                   along_v = normalize3(b1 * p.dv[0] + b2 * p.dv[1], glm::dvec3(0));
  const auto perturb = [&](const TextureUse& map, double s, double t, double z) {
    const glm::dvec3 u = tangent(along_u, n, map.scale[0]), v = tangent(along_v, n, map.scale[1]);
    if ((s == 0 && t == 0 && z > 0) || dot3(u, u) == 0 || dot3(v, v) == 0) return;
    const glm::dvec3 bent = u * s + v * t + n * z;
    if (dot3(bent, bent) > 1e-12) n = normalize3(bent, n);
  };
  if (const TextureUse* heights = use(m.map_bump)) {
    const glm::dvec2 slope = textures_.slopes(*heights, p.uv);
    perturb(*heights, -std::clamp(slope.x, -0x1p20, 0x1p20), -std::clamp(slope.y, -0x1p20, 0x1p20), 1);
  }
  if (const TextureUse* normals = use(m.map_normal)) {
    const glm::dvec4 c = textures_.sample(*normals, p.uv);
    const auto decode = [](double v) { return std::clamp((v * 65535 - 128 * 257) / (127 * 257), -1.0, 1.0); };
    const double bm = normals->bump_multiplier;
    perturb(*normals, decode(c.x) * bm, decode(c.y) * bm, decode(c.z));
  }
  return n;
}

void Surfaces::apply_maps(const Point& p, const Material& m, Surface& s) const {
  const auto times = [&](glm::dvec3& color, int32_t map) {
    if (const TextureUse* u = use(map)) color *= textures_.color(*u, p.uv);
  };
  if (settings_.textures) {
    times(s.diffuse, m.map_diffuse), times(s.ambient, m.map_ambient >= 0 ? m.map_ambient : m.map_diffuse);
    times(s.specular, m.map_specular), times(s.mirror, m.map_specular), times(s.emission, m.map_emission);
    if (const TextureUse* u = use(m.map_shininess))
      s.shininess = std::clamp(s.shininess * textures_.scalar(*u, p.uv), 0.0, 1e4);
  }
  if (const TextureUse* u = use(m.map_opacity)) s.opacity = std::clamp(s.opacity * textures_.scalar(*u, p.uv), 0.0, 1.0);
}

Surface Surfaces::at(const Ray& ray, uint32_t primitive, const Nudge& nudge) const {
  const Material& m = material(primitive);
  const Point p = point_at(ray, primitive, nudge);
  Surface s;
  s.primitive = primitive;
  s.t = p.t, s.position = p.position, s.geometric = p.geometric, s.position_dx = p.position_dx, s.position_dy = p.position_dy;
  std::copy_n(p.weight, 3, s.weight);
  s.view = normalize3(ray.line.origin - p.position, -ray.line.direction);
  s.normal = settings_.shading == Shading::kFlat ? s.geometric : interpolated_normal(p, primitive);
  s.smooth = s.normal;
  if (settings_.bump && settings_.shading == Shading::kPhong) s.normal = bumped(p, m, s.normal);
  s.normal = above_horizon(s.normal, s.geometric);
  s.ambient = to_dvec(m.ambient), s.diffuse = to_dvec(m.diffuse), s.specular = to_dvec(m.specular), s.emission = to_dvec(m.emission);
  if (role(primitive) != Role::kBlended) s.mirror = to_dvec(m.mirror);
  s.shininess = m.shininess, s.opacity = m.opacity;
  apply_maps(p, m, s);
  // A generous bound on the rounding of position, in double: some thousand units in the last place of what it was made from.
  s.clearance = 0x1p-42 * (max_abs(p.v[0]) + max_abs(p.edge1) + max_abs(p.edge2) + max_abs(ray.line.origin));
  if (settings_.shadow_terminator == ShadowTerminator::kLifted && settings_.shading != Shading::kFlat)
    s.lift = lift(p, primitive, s.clearance);
  return s;
}

}  // namespace spanray::reference
