// Walls with arched openings, columns, vessels: what the scenes are built of.
#pragma once
#include "shapes.h"

namespace spanray::assets {

// A wall in the plane z = 0 of the placement, |z| <= depth / 2, |x| <= width / 2, with one arched opening centered on x = 0:
// half circle of `radius` over `spring`, straight jambs below it down to `bottom`. Closed but for its two ends and top.
// `rows` up each face, `columns` across each jamb, `deep` through the wall. uv is in meters from uv_start (of the placement's x, y).
struct ArchWall {
  double width, radius, bottom, spring, top, depth, texture_size;
  int segments = 24, rows = 3, columns = 1, deep = 2;
  glm::dvec2 uv_start = {0, 0};
};
void arch_wall(ObjMesh& mesh, const Placement& at, const ArchWall& wall);

// The molded ring around such an opening, on the side z > 0, standing out from the wall.
void archivolt(ObjMesh& mesh, const Placement& at, const ArchWall& wall, double wide, double proud, int segments = 24);

// A Tuscan column, 2.66 high, standing on y = 0 of the placement: base and capital, and the shaft between.
void column_base_and_capital(ObjMesh& mesh, const Placement& at, double texture_size);
void column_shaft(ObjMesh& mesh, const Placement& at, double repeat_u, double texture_size);

// Vessels turned on a wheel, standing on y = 0; heights 0.62, 0.55 and 0.34. Open at the top, with an inside: closed.
void urn(ObjMesh& mesh, const Placement& at, int segments);
void vase(ObjMesh& mesh, const Placement& at, int segments);
void flower_pot(ObjMesh& mesh, const Placement& at, int segments);

// An iron lantern, 0.42 high, with its top at y = 0; and its glass.
void lantern_iron(ObjMesh& mesh, const Placement& at, double chain);
void lantern_glass(ObjMesh& mesh, const Placement& at);

}  // namespace spanray::assets
