// Surfaces of the shipped scenes, each added to the current object of a mesh. Solids are closed; where two meet they are sunk
// into each other, so that no faces lie in one plane.
#pragma once
#include <functional>
#include <vector>

#include "obj_mesh.h"

namespace spanray::assets {

using Point = glm::dvec3;

// A right-handed local frame: world = origin + a * x + b * y + c * z.
struct Placement {
  Point origin{0, 0, 0}, x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  Point point(const Point& p) const { return origin + p.x * x + p.y * y + p.z * z; }
  Point direction(const Point& d) const { return d.x * x + d.y * y + d.z * z; }
};
// Turned by `degrees` about the vertical (counter-clockwise seen from above), then moved to origin.
Placement placed(const Point& origin, double degrees = 0);

// columns x rows quads over s, t in [0, 1]; the front is where (d/ds) x (d/dt) points.
void patch(ObjMesh& mesh, int columns, int rows, const std::function<Corner(double s, double t)>& at);

// The same from points alone: normals by central differences of `step` in s and t. `at` must be smooth a step beyond its edges.
void smooth_patch(ObjMesh& mesh, int columns, int rows, const std::function<Point(double s, double t)>& at,
                  const std::function<glm::dvec2(double s, double t)>& uv, double step = 1e-3, const Point& fallback = {0, 0, 1});

// A rectangle from `corner` along two perpendicular edges; front along cross(along_u, along_v).
// Texture coordinates are meters / texture_size, starting at uv_start.
void rectangle(ObjMesh& mesh, const Point& corner, const Point& along_u, const Point& along_v, int columns, int rows,
               double texture_size = 1, glm::dvec2 uv_start = {0, 0});

// A closed box centered on the placement's origin, `size` its full extents, edges cut by `chamfer` meters, faces divided into
// squares of about `division` meters (0: not at all).
void box(ObjMesh& mesh, const Placement& at, const Point& size, double chamfer = 0.01, double division = 0, double texture_size = 1);

// A sphere; u once around, v from pole to pole, both times uv_repeat.
void sphere(ObjMesh& mesh, const Point& center, double radius, int segments, glm::dvec2 uv_repeat = {1, 1});

// A curve in the plane of a profile: (a, b) points in order; smooth between its ends.
using Profile = std::vector<std::vector<glm::dvec2>>;  // smooth pieces, one after the other, hard edges between them
// Points on a circular arc from angle `from` to `to` (degrees), ends included.
std::vector<glm::dvec2> arc(glm::dvec2 center, double radius_a, double radius_b, double from, double to, int segments);

// The same line with steps of at most `longest`.
Profile refined(const Profile& profile, double longest);

// A profile drawn like a pen line: each piece begins where the last one ended, so that nothing gapes.
class Outline {
 public:
  Outline(double a, double b) : at_(a, b) {}
  Outline& line(double a, double b);                          // straight, with hard edges at both ends
  Outline& smooth(const std::vector<glm::dvec2>& points);     // through these points
  Profile done() const { return pieces_; }

 private:
  glm::dvec2 at_;
  Profile pieces_;
};

// A profile (a: radius, b: height) turned about the placement's y axis. The solid lies to the left of the profile when
// going along it (go upward along the outside). u goes repeat_u times around, v is length / texture_size.
void lathe(ObjMesh& mesh, const Placement& at, const Profile& profile, int segments, double repeat_u = 1, double texture_size = 1);

// A closed profile swept along half a circle (an arch ring) in the plane z = 0 of the placement, from +x over +y to -x:
// a: radius, b: along z. Ends are left open: sink them into something.
void arch(ObjMesh& mesh, const Placement& at, const Profile& profile, int segments, double texture_size = 1);

// A straight bar of closed profile (a: local x, b: local y) along the placement's z, from 0 to length, with end caps. All of
// the profile must be seen from its first point.
void bar(ObjMesh& mesh, const Placement& at, const Profile& profile, double length, int divisions = 1, double texture_size = 1);

// A mitred rectangular frame in the plane z = 0 of the placement, opening width x height centered on its origin; the section is
// `wide` outward and `deep` along z (from -deep/2 to deep/2), with chamfered edges.
void picture_frame(ObjMesh& mesh, const Placement& at, double width, double height, double wide, double deep, double texture_size = 1);

}  // namespace spanray::assets
