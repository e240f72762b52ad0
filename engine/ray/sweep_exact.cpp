#include "ray/sweep_exact.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "frame/exact_hit.h"

namespace spanray {
namespace {

constexpr double kRounding = 0x1p-48;  // of distances, in units of what they are made from

// When a sphere of radius r, moved from the origin, first touches a surface of radius `still` around c; infinity if never.
// Contract: as first_contact() (ray/sphere_triangle.h): never later than the true contact, earlier by 2^-46 (|c| + |motion| +
//           both radii) at most, but where it grazes: there it may stop what passes by as much. At the start it stops only
//           motion towards the surface.
double first_touch(const glm::dvec3& c, const glm::dvec3& motion, double r, double still) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const double distance = length3(c), length = length3(motion), error = kRounding * (distance + length + r + still);
  const glm::dvec3 from = -c;
  const double outward = dot3(from, motion);  // the sign: away from the center
  const auto before = [&](double t) { return std::max(t - error / length, 0.0); };
  SphereCrossing cross;
  if (distance >= still) {
    if (distance - still - r <= 4 * error) return outward < 0 ? 0 : kNever;
    if (!cross_sphere(from, motion, still + r + error, cross) || !(cross.leave > 0)) return kNever;
    return before(cross.enter);
  }
  // From within.
  if (still - distance - r <= 4 * error && outward > 0) return 0;
  if (still - r > error && cross_sphere(from, motion, still - r - error, cross)) return before(cross.leave);
  return before(-outward / (length * length));  // it touches, and may move on until it would come nearer again
}

// The contact when the moved sphere's center stands at `center`, all as seen from its first center.
SphereContact contact_at(double time, const glm::dvec3& center, const glm::dvec3& c, double still) {
  const glm::dvec3 from = center - c, outward = normalize3(from, glm::dvec3(0, 1, 0));
  return {time, c + outward * still, length3(from) < still ? -outward : outward};
}

// A plane as seen from a place: its unit normal, turned to the side of the place (the front, of places on it), and the
// distance.
struct PlaneFrom {
  glm::dvec3 normal;
  double distance;
};
PlaneFrom plane_from(const Plane& plane, const glm::dvec3& place) {
  const glm::dvec3 normal = normal_of(plane);
  const double length = length3(normal), height = height_over(normal, point_of(plane), place) / length;
  return {normal * ((height < 0 ? -1 : 1) / length), std::fabs(height)};
}

// When a sphere of radius r, moved along `motion`, first touches a plane that is at first this far away; infinity if never.
// Contract: as first_touch(). At the start a plane that it touches stops it only if it moves towards it; on the plane nothing is
//           towards it.
double first_touch(const PlaneFrom& plane, const glm::dvec3& motion, double r) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const double length = length3(motion), error = kRounding * (plane.distance + length + r);
  const double approach = -dot3(plane.normal, motion), gap = plane.distance - r;
  if (gap <= 4 * error) return plane.distance > 0 && approach > kRounding * length ? 0 : kNever;
  // What moves along the plane, up to rounding, never comes near: gap > 4 error.
  return approach > 0 ? std::max((gap - error) / (approach + kRounding * length), 0.0) : kNever;
}

// Of the nearest point of the plane, when the moved sphere's center has gone `way`.
SphereContact contact_at(double time, const glm::dvec3& way, const PlaneFrom& plane) {
  return {time, way - plane.normal * (plane.distance + dot3(plane.normal, way)), plane.normal};
}

// The earlier of two contacts, of equal ones that with the lowest primitive.
bool improves(double time, uint32_t primitive, const SphereHit& best) {
  return best.primitive == kNoPrimitive || time < best.contact.time ||
         (time == best.contact.time && primitive < best.primitive);
}

}  // namespace

void sweep_exact(const ExactSet& set, const glm::dvec3& start, const glm::dvec3& motion, double radius, SphereHit& best) {
  for (const TreeSphere& s : set.spheres.spheres) {
    const glm::dvec3 c = center_of(s) - start;
    const double still = static_cast<double>(s.radius), time = first_touch(c, motion, radius, still);
    if (!(time <= 1) || !improves(time, s.primitive, best)) continue;
    best.primitive = s.primitive, best.contact = contact_at(time, motion * time, c, still);
  }
  for (const PlaneItem& item : set.planes) {
    const PlaneFrom plane = plane_from(item.plane, start);
    const double time = first_touch(plane, motion, radius);
    if (!(time <= 1) || !improves(time, item.primitive, best)) continue;
    best.primitive = item.primitive, best.contact = contact_at(time, motion * time, plane);
  }
}

void touch_exact(const ExactSet& set, const glm::dvec3& center, double radius, std::vector<SphereHit>& hits) {
  for (const TreeSphere& s : set.spheres.spheres) {
    const glm::dvec3 c = center_of(s) - center;
    const double still = static_cast<double>(s.radius), distance = std::fabs(length3(c) - still);
    if (distance <= radius) hits.push_back({s.primitive, contact_at(0, glm::dvec3(0), c, still), distance});
  }
  for (const PlaneItem& item : set.planes) {
    const PlaneFrom plane = plane_from(item.plane, center);
    if (!(plane.distance <= radius)) continue;
    hits.push_back({item.primitive, contact_at(0, glm::dvec3(0), plane), plane.distance});
    if (plane.distance == 0) hits.back().contact.normal = glm::dvec3(0);
  }
}

}  // namespace spanray
