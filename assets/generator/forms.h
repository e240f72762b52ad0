// Smooth forms for sculptures: superquadrics, subdivided cages, implicit surfaces. All closed; no texture coordinates.
#pragma once
#include <array>
#include <functional>
#include <vector>

#include "shapes.h"

namespace spanray::assets {

// x = size * (sign |cos v|^e1 |cos u|^e2, ...): a box with round edges below 1, an ellipsoid at 1, pinched above. 0.2 <= e <= 1.9.
// Source: Barr 1981, "Superquadrics and Angle-Preserving Transformations".
void superellipsoid(ObjMesh& mesh, const Placement& at, const Point& size, double e1, double e2, int segments);
// A ring of radius `size.x + size.z` about the placement's y, its section with exponent e1 and half axes size.z (out) and size.y,
// its plan with exponent e2.
void supertoroid(ObjMesh& mesh, const Placement& at, const Point& size, double e1, double e2, int segments);

// A closed polyhedron of quads, counter-clockwise seen from outside; each edge belongs to two of them.
struct Cage {
  std::vector<Point> points;
  std::vector<std::array<int, 4>> quads;
};
// The skin of a set of unit cubes, whose cells (x, y, z) touch along whole faces only.
Cage cage_of_cells(const std::vector<std::array<int, 3>>& cells);
// Source: Catmull and Clark 1978, "Recursively generated B-spline surfaces on arbitrary topological meshes".
Cage subdivided(const Cage& cage);
void add_cage(ObjMesh& mesh, const Placement& at, const Cage& cage);

// A scalar field, positive inside, with its gradient.
struct FieldValue { double value; Point gradient; };
using Field = std::function<FieldValue(const Point&)>;
// The surface value = 0 within the box low..high (which it must not touch), on cubes of about `cell` meters; normals from the
// gradient; vertices are shared, then evened out along the surface.
// Source: Doi and Koide 1991, "An Efficient Method of Triangulating Equi-Valued Surfaces by Using Tetrahedral Cells".
void implicit_surface(ObjMesh& mesh, const Placement& at, const Field& field, const Point& low, const Point& high, double cell);

}  // namespace spanray::assets
