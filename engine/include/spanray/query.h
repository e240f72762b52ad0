// Questions about a scene outside of frames: what does a ray meet, how far can a sphere go, what does it touch?
#pragma once
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "spanray/camera.h"
#include "spanray/scene.h"

namespace spanray {

// A ray as frames trace them: in floats. t counts in lengths of the direction, which need not be 1.
struct Ray {
  float origin[3] = {0, 0, 0};
  float direction[3] = {0, 0, -1};
  float t_min = 0, t_max = std::numeric_limits<float>::infinity();  // hits at exactly these count; none at t = 0
};

// Which triangle, sphere or plane. Names are those of the files, "" where they give none; they live as long as the scene.
struct TriangleName {
  uint32_t triangle = 0;  // index, as in Framebuffer::primitive: spheres come after all triangles, planes after all spheres
  bool sphere = false;    // it is one
  bool plane = false;     // it is one
  uint32_t material_index = 0;
  std::string_view material, object, group;  // of MTL; of the OBJ's `o` and `g`
};

struct RayHit {
  TriangleName name;
  double t = 0;                 // in lengths of the ray's direction
  double distance = 0;          // world units from the ray's origin
  double position[3] = {0, 0, 0};
  double normal[3] = {0, 0, 0};  // unit; of the triangle's plane, on its front side (counter-clockwise in the file), outward, or the plane's
  bool front = true;            // the ray comes from that side
};

// A sphere moved along a straight line. Coordinates and radius at most 1e30, the way at least 1e-30.
struct SphereSweep {
  double start[3] = {0, 0, 0}, end[3] = {0, 0, 0};  // of the center
  double radius = 0;                                // >= 0
};

struct SweepHit {
  TriangleName name;
  double time = 0;               // part of the way until the first contact, 0 to 1
  double distance = 0;           // world units that the center has gone until then
  double center[3] = {0, 0, 0};  // of the sphere then
  double position[3] = {0, 0, 0};  // of the contact, on the surface
  double normal[3] = {0, 0, 0};  // unit, from the contact to the center
};

struct SphereTouch {
  TriangleName name;
  double distance = 0;           // from the center to the surface, 0 to the radius
  double position[3] = {0, 0, 0};  // of its nearest point
  double normal[3] = {0, 0, 0};  // unit, from there to the center; 0 if the center lies on the triangle or plane
};

// The tree by which a scene is asked.
struct QueryTree {
  int levels = 1;          // 2: copies of instances share the trees of their parts, where they are many
  uint64_t instances = 0;  // that do
  uint64_t bytes = 0;
};

struct QueryOptions {
  bool cutouts = true;      // alpha masks (map_d) let rays through, as in frames; false: they are solid
  bool translucent = true;  // rays meet surfaces that frames blend by alpha; false: they pass through
  Transparency transparency = Transparency::kScene;  // as Settings has them
  Filter filter = Filter::kTrilinear;
  Isa isa = Isa::kAuto;     // changes no answer
};

// Asks one scene. Copies share its tree. All questions may be asked from several threads at once. Answers come from the tracer of
// frames: watertight, ties to the lowest primitive, the same bits on every machine. Nothing is culled by its facing but by pixel().
// Errors of all questions: no scene, numbers that are not finite or out of range, an instruction set that this machine lacks, out of
// memory for the tree. A question that cannot be answered is never a miss.
class SceneQuery {
 public:
  // Takes no time: the tree is built by the first question, or by prepare().
  explicit SceneQuery(Scene scene, const QueryOptions& options = {});

  Result<void> prepare() const;  // builds the tree now, on all processors
  Result<QueryTree> tree() const;  // builds it, too, if it is not there yet

  // The first triangle that a ray meets, if any. Masks are read at their finest level; screen-door surfaces are solid.
  // Errors: a direction that is zero or not finite, an origin that is not finite, t_min or t_max negative or NaN, t_min > t_max.
  Result<std::optional<RayHit>> closest(const Ray& ray) const;
  // Of many rays at once: faster, and the same answers. An error names the ray by its number, from 0.
  Result<std::vector<std::optional<RayHit>>> closest(std::span<const Ray> rays) const;
  // Whether a ray meets anything.
  Result<bool> any(const Ray& ray) const;

  // What pixel (x, y) of the frame shows that these settings ask for, x from 0 at the left, y from 0 at the top: the hit of that very
  // frame's primary ray with Visibility::kRay; masks, screen-doors, culling and filter are the frame's. t is the view depth less the near plane.
  // The scene stands as at rest, whatever the time.
  Result<std::optional<RayHit>> pixel(const Camera& camera, const Settings& frame, int x, int y) const;

  // The first contact of a moving sphere with any triangle, sphere (a surface, too: it holds what is within) or plane of the scene;
  // cut-outs, screen-doors and panes are solid. Never later than the true contact: the sphere passes through nothing, however fast. A triangle that it touches at the start stops it only if it moves
  // towards it, so it can get out of walls; to slide along a wall of many triangles it must keep a hair's breadth (2^-30 of the
  // radius) away. A radius of 0 asks for the closest hit of the ray from start to end.
  // Errors: start and end coincide (ask touching()).
  Result<std::optional<SweepHit>> sweep(const SphereSweep& sphere) const;
  // All triangles, spheres and planes at most `radius` away from a point, nearest first.
  Result<std::vector<SphereTouch>> touching(const double (&center)[3], double radius) const;

 private:
  struct Impl;
  std::shared_ptr<Impl> impl_;
};

}  // namespace spanray
