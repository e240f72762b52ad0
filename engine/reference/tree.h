// Which triangles, spheres and planes does a ray meet? In double, one ray at a time.
#pragma once
#include <cstdint>
#include <limits>
#include <vector>

#include "math/vec.h"
#include "scene/scene_data.h"

namespace spanray::reference {

struct Line {
  glm::dvec3 origin{0}, direction{0};
};  // origin + t * direction; the direction has any length

// Does the line meet the triangle, and at which t (of any sign)?
// Source:   Woop, Benthin, Wald 2013, "Watertight Ray/Triangle Intersection": vertices sheared so that the line is an axis, then a
//           test in the plane, whose signs are never wrong. Edges and vertices count as inside, for every triangle that has them.
// Contract: no line slips between triangles that share vertices. t lies within the range of the corners.
bool meets(const Line& line, const glm::dvec3 (&v)[3], double& t);

// Does it meet the sphere, and at which two t, in order?
// Source:   from the point of the line that is nearest to the center, to both sides: half a chord is the root of
//           (r - distance) (r + distance). In long double.
bool meets(const Line& line, const glm::dvec3& center, double radius, double (&t)[2]);

// Does it meet the plane, and at which t (of any sign, and as far away as planes reach: 1e30)? In long double.
bool meets(const Line& line, const Plane& plane, double& t);

// Of a line that meets the triangle: still, if it is moved sideways by as little as one likes, in a direction that is the same for all
// triangles? Of those that share the edge or corner that it runs through, one says yes, if it crosses their surface there.
bool keeps(const Line& line, const glm::dvec3 (&v)[3]);

struct Met {
  double t = std::numeric_limits<double>::infinity();
  uint32_t primitive = kNoPrimitive;
};

// A bounding volume hierarchy over some primitives of a scene: binned surface area heuristic (Wald 2007), at most 4 triangles a
// leaf. It only saves work: everything is decided by meets(), so the answers are those of asking every primitive. Planes stand
// beside it.
class Tree {
 public:
  Tree(const SceneData& scene, const std::vector<uint32_t>& primitives);  // keeps the scene

  // The least t in (t_min, t_max] that accept(primitive, t) takes; of equal ones the lowest id. Triangles that lie in a plane
  // hide it, however t is rounded. accept is asked for candidates only.
  template <class Accept>
  Met closest(const Line& line, double t_min, double t_max, const Accept& accept) const {
    Met best;
    walk(line, t_max, [&](const Item& item, double t, double& limit) {
      const uint32_t primitive = item.primitive;
      if (!(t > t_min) || t > best.t || (t == best.t && primitive > best.primitive) || !accept(primitive, t)) return false;
      best = {t, primitive}, limit = t;
      return false;
    });
    for_each_plane(line, t_max, [&](uint32_t primitive, double t) {
      if (!(t > t_min) || t >= best.t || shows_triangle(best, primitive, t) || !accept(primitive, t)) return false;
      best = {t, primitive};
      return false;
    });
    return best;
  }
  // Whether accept takes any hit in (t_min, t_max].
  template <class Accept>
  bool any(const Line& line, double t_min, double t_max, const Accept& accept) const {
    bool found = false;
    walk(line, t_max, [&](const Item& item, double t, double&) { return found = t > t_min && accept(item.primitive, t); });
    if (!found) for_each_plane(line, t_max, [&](uint32_t primitive, double t) { return found = t > t_min && accept(primitive, t); });
    return found;
  }
  // All hits in (t_min, t_max] that accept takes, in no order: layers, so that a hit on an edge counts once.
  template <class Accept>
  std::vector<Met> all(const Line& line, double t_min, double t_max, const Accept& accept) const {
    std::vector<Met> found;
    walk(line, t_max, [&](const Item& item, double t, double&) {
      if (t > t_min && keeps(line, item.v) && accept(item.primitive, t)) found.push_back({t, item.primitive});
      return false;
    });
    return found;
  }
  // visit(primitive, v) for every triangle in a box that the region does not miss: misses(low, high). True ends the walk. Not
  // for scenes with spheres or planes.
  template <class Misses, class Visit>
  void visit_region(const Misses& misses, const Visit& visit) const {
    descend([&](const Box& box) { return !misses(box.low, box.high); }, [&](const Item& item) { return visit(item.primitive, item.v); });
  }
  bool empty() const { return item_.empty() && plane_.empty(); }

 private:
  struct Box {
    glm::dvec3 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};
    void add(const glm::dvec3& p);
    void add(const Box& b) { add(b.low), add(b.high); }
    double half_area() const;
  };
  struct Node {
    Box box;
    uint32_t first = 0, count = 0;  // items of a leaf; else the right child is `first`, the left one the next node
  };
  struct Item {
    uint32_t primitive;
    glm::dvec3 v[3];
    double radius = 0;  // > 0: a sphere around v[0]
  };
  struct Reference {
    Box box;
    glm::dvec3 center;
    uint32_t primitive;
  };

  void build(std::vector<Reference>& list, size_t begin, size_t end);
  static size_t split(std::vector<Reference>& list, size_t begin, size_t end);
  static bool enters(const Box& box, const Line& line, double t_max);

  // visit(item) for every item of the boxes that are entered, from the root on: enters(box). True ends it.
  template <class Enters, class Visit>
  void descend(const Enters& enters_box, const Visit& visit) const {
    if (node_.empty()) return;
    uint32_t stack[128];
    int depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
      const uint32_t at = stack[--depth];
      const Node& node = node_[at];
      if (!enters_box(node.box)) continue;
      for (uint32_t i = node.first; i < node.first + node.count; ++i)
        if (visit(item_[i])) return;
      if (node.count == 0) stack[depth++] = node.first, stack[depth++] = at + 1;
    }
  }

  // visit(item, t, limit) for every hit with t <= limit, limit being t_max or less; true ends the walk.
  template <class Visit>
  void walk(const Line& line, double t_max, const Visit& visit) const {
    descend([&](const Box& box) { return enters(box, line, t_max); },
            [&](const Item& item) {
              if (item.radius > 0) {  // met twice, where it is met
                double t[2];
                return meets(line, item.v[0], item.radius, t) &&
                       ((t[0] <= t_max && visit(item, t[0], t_max)) || (t[1] <= t_max && visit(item, t[1], t_max)));
              }
              double t;
              return meets(line, item.v, t) && t <= t_max && visit(item, t, t_max);
            });
  }

  // visit(primitive, t) for every plane that is met at t <= t_max; true ends it.
  template <class Visit>
  void for_each_plane(const Line& line, double t_max, const Visit& visit) const {
    double t;
    for (const uint32_t primitive : plane_)
      if (meets(line, scene_.plane(primitive), t) && t <= t_max && visit(primitive, t)) return;
  }
  // Of a hit and one of a plane that is nearer: is that of a triangle which lies in the plane?
  bool shows_triangle(const Met& best, uint32_t plane, double t) const;

  const SceneData& scene_;
  std::vector<uint32_t> plane_;  // primitives
  std::vector<Node> node_;
  std::vector<Item> item_;
};

}  // namespace spanray::reference
