// Bundles of rays as thin as the errors that they stand for: a convex region of space, and which triangles touch it.
#pragma once
#include <functional>
#include <vector>

#include "reference/surface.h"
#include "reference/view.h"

namespace spanray::reference {

// Points x with dot(normal, x - origin) <= most, origin being that of the beam.
struct HalfSpace {
  glm::dvec3 normal{0};
  double most = 0;
};

struct Beam {
  glm::dvec3 origin{0};
  std::vector<HalfSpace> sides;                                      // all rays of the bundle run within these
  std::vector<HalfSpace> ends;                                       // and begin and end at these
  bool misses(const glm::dvec3& low, const glm::dvec3& high) const;  // a box that lies outside of one of them
};

// What a bundle of rays may do: start anywhere within +-start of the center's origin along u and v, and spread by +-spread for
// each unit along the axis.
struct Bundle {
  Ray center;  // its footprint is that of all
  glm::dvec3 axis{0}, u{0}, v{0};
  double start_u = 0, start_v = 0, spread_u = 0, spread_v = 0;
  Beam beam;

  bool bends() const { return start_u > 0 || start_v > 0; }  // it does not come from a point
  double depth(const glm::dvec3& x) const { return dot3(x - center.line.origin, axis); }
  // The ray of the bundle through a point of the beam; its direction goes one unit along the axis.
  Ray through(const glm::dvec3& x) const;
};

// Through the pixel position of a primary ray and all within +-reach pixels of it, in x and in y, from the near plane on.
Bundle primary_bundle(const View& view, const Ray& center, double reach);
// Mirrored rays (the first: the center), all of which start on a surface with this unit normal; `error`: of positions, in the
// scene's units.
Bundle mirrored_bundle(const std::vector<Ray>& rays, const glm::dvec3& normal, double error);
// From a convex polygon on a surface to a light. `error` as above.
Beam shadow_beam(const std::vector<glm::dvec3>& polygon, const glm::dvec3& normal, const Light& light, double error);

// The part of a triangle that lies in a beam.
struct Piece {
  uint32_t primitive = kNoPrimitive;
  glm::dvec3 v[3];
  std::vector<glm::dvec3> corner;  // convex; empty: it does not touch the beam
  bool cut = false;                // an end of the beam cuts it
  bool crosses[3] = {};            // edge k, from v[k] to v[k + 1], runs through the beam
  double near = 0, far = 0;        // depths, where the caller has a bundle
  bool certain = true;             // it stops every ray that meets it
};
Piece clip(const Beam& beam, uint32_t primitive, const glm::dvec3 (&v)[3]);
glm::dvec3 middle(const std::vector<glm::dvec3>& polygon);

// Pieces that hang together within a beam: over edges that run through it, and not folded there as the beam sees them.
struct Sheet {
  std::vector<size_t> pieces;
  // No border of it runs through the beam: whatever happens to its vertices, as long as no point moves by more than the beam is
  // wide and triangles that share an edge go on sharing it, the ray at the beam's center meets it.
  bool closed = true;
};
// direction: of the rays, at any point of the beam.
std::vector<Sheet> make_sheets(const std::vector<Piece>& pieces, const std::function<glm::dvec3(const glm::dvec3&)>& direction);

}  // namespace spanray::reference
