#include "raster/exact.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "frame/exact_hit.h"
#include "raster/depth_plane.h"

namespace spanray {
namespace {

// However far, a surface lies in front of the background, whose depth is 0.
float depth_of(const Frame& frame, double t) {
  return std::max(static_cast<float>(frame.primary.near_plane / t), std::numeric_limits<float>::denorm_min());
}

struct Interval {
  double low, high;
};

// Where the outline of a sphere lies along one axis of the picture, in tangents of the angle to the view direction: a circle of
// radius r around (side, depth), seen from the origin.
// Source:   Mara and McGuire 2013, "2D Polyhedral Bounds of a Clipped, Perspective-Projected 3D Sphere".
// Input:    depth > r > 0.
Interval outline(double side, double depth, double r) {
  const double square = side * side + depth * depth, tangent = std::sqrt(square - r * r);
  return {(side * tangent - depth * r) / (depth * tangent + side * r),
          (side * tangent + depth * r) / (depth * tangent - side * r)};
}

// Pixels of [0, size) whose samples may lie in an interval of picture positions. What is not a number bounds nothing.
void clip_pixels(const Interval& at, int size, int& begin, int& end) {
  constexpr double kMargin = 0x1p-6;  // far more than rounding moves an outline within a picture
  begin = at.low - kMargin > 0 ? static_cast<int>(std::min(at.low - kMargin, static_cast<double>(size))) : 0;
  end = at.high + kMargin < size ? static_cast<int>(std::max(at.high + kMargin + 1, 0.0)) : size;
}

PixelBox bounds_of(const Frame& frame, const Sphere& sphere) {
  const PrimaryRays& p = frame.primary;
  const glm::dvec3 from_eye = center_of(sphere) - p.eye;
  const double depth = dot3(from_eye, p.forward), r = static_cast<double>(sphere.radius), pixel = length3(p.step_x);
  constexpr double kMore = 1 + 0x1p-30;
  if (depth + r < 0.5 * p.near_plane - 0x1p-40 * (length3(from_eye) + r)) return {};
  // Seen from very near, or from within, it may be anywhere. Outlines that are nearly parallel to the picture lose their
  // digits.
  if (!(depth > 1.01 * r)) return {0, 0, p.width, p.height};
  const auto positions = [&](const glm::dvec3& step, double half) {
    const Interval tangents = outline(dot3(from_eye, step) / pixel, depth, r * kMore);
    return Interval{half + tangents.low / pixel, half + tangents.high / pixel};
  };
  PixelBox box;
  clip_pixels(positions(p.step_x, 0.5 * p.width), p.width, box.x0, box.x1);
  clip_pixels(positions(p.step_y, 0.5 * p.height), p.height, box.y0, box.y1);
  return box;
}

float most_depth(const Frame& frame, const Sphere& sphere) {
  const glm::dvec3 from_eye = center_of(sphere) - frame.primary.eye;
  const double size = length3(from_eye) + static_cast<double>(sphere.radius);
  const double nearest = dot3(from_eye, frame.primary.forward) - static_cast<double>(sphere.radius) - 0x1p-40 * size;
  return nearest > frame.primary.near_plane ? depth_of(frame, nearest) : 1.0f;
}

template <class Visit>
void for_each_tile(const TileGrid& grid, const PixelBox& box, const Visit& visit) {
  if (box.x0 >= box.x1 || box.y0 >= box.y1) return;
  for (int row = box.y0 / kTileSize; row <= (box.y1 - 1) / kTileSize; ++row)
    for (int column = box.x0 / kTileSize; column <= (box.x1 - 1) / kTileSize; ++column)
      visit(static_cast<size_t>(row * grid.columns + column));
}

}  // namespace

float depth_at(const Frame& frame, uint32_t primitive, double x, double y) {
  if (primitive == kNoPrimitive) return 0;
  if (!frame.scene->is_triangle(primitive))
    return depth_of(frame, first_hit(primary_exact_ray(frame, x, y), *frame.scene, primitive).t);
  const Triangle& t = frame.scene->triangles[primitive];
  double view_depth[3];
  for (int i = 0; i < 3; ++i) {
    const float* p = frame.scene->vertices[t.vertex[i]].position;
    view_depth[i] = dot3(glm::dvec3(p[0], p[1], p[2]) - frame.primary.eye, frame.primary.forward);
  }
  const DepthPlane plane = make_depth_plane(frame, t, view_depth);
  return std::clamp(static_cast<float>(plane.depth0 + y * plane.dy + x * plane.dx), plane.min, plane.max);
}

namespace {

PlaneOnScreen on_screen(const Frame& frame, const Plane& plane) {
  const PrimaryRays& p = frame.primary;
  const glm::dvec3 normal = normal_of(plane);
  PlaneOnScreen seen;
  seen.height = height_over(normal, point_of(plane), p.eye);
  if (frame.settings.culling == Culling::kBack && seen.height < 0) seen.height = 0;
  if (seen.height == 0) return seen;
  const double scale = -p.near_plane / seen.height;
  seen.depth0 = dot3(normal, p.corner) * scale, seen.dx = dot3(normal, p.step_x) * scale,
  seen.dy = dot3(normal, p.step_y) * scale;
  const double most = length3(p.corner) + length3(p.step_x) * p.width + length3(p.step_y) * p.height;
  seen.margin = length3(normal) * most * std::fabs(scale) * 0x1p-40;
  return seen;
}

// Shows a primitive at an entry of the target, if it is nearer than what is there. Returns how many samples passed.
uint64_t show(const Frame& frame, uint32_t primitive, float depth, double x, double y, uint32_t& shown, float& before) {
  constexpr float kClose = 1 - 0x1p-12f;  // depths of one place differ by far less
  if (std::isnan(before)) before = depth_at(frame, shown, x, y);
  if (depth < before || (depth == before && primitive > shown)) return 0;
  const SceneData& scene = *frame.scene;
  if (before > depth * kClose && scene.is_plane(primitive) && scene.is_triangle(shown) &&
      lies_in(scene, scene.triangles[shown], scene.plane(primitive)))
    return 0;
  shown = primitive, before = depth;
  return 1;
}

// Draws a primitive within a box. limit(x, y): no depth of it there is greater; not above 0: it is not seen there. hit(ray): its
// first.
template <class Limit, class Hit>
uint64_t draw_within(const Frame& frame, uint32_t primitive, const PixelBox& box, int place, const ExactTarget& target,
                     const Limit& limit, const Hit& hit) {
  const PixelBox& pixels = target.pixels;
  uint64_t passed = 0;
  for (int y = std::max(box.y0, pixels.y0); y < std::min(box.y1, pixels.y1); ++y)
    for (int x = std::max(box.x0, pixels.x0); x < std::min(box.x1, pixels.x1); ++x) {
      const int i = (y - pixels.y0) * target.stride + x - pixels.x0;
      const double at_x = x + frame.places.x[place], at_y = y + frame.places.y[place], most = limit(at_x, at_y);
      // Unknown depths are not greater than any.
      if (!(most > 0) || static_cast<double>(target.depth[i]) > most) continue;
      const double t = hit(primary_exact_ray(frame, at_x, at_y)).t;
      if (t != std::numeric_limits<double>::infinity())
        passed += show(frame, primitive, depth_of(frame, t), at_x, at_y, target.primitive[i], target.depth[i]);
    }
  return passed;
}

uint64_t draw_sphere(const Frame& frame, const ExactBins& bins, uint32_t index, int place, const ExactTarget& target) {
  const SceneData& scene = *frame.scene;
  const uint32_t primitive = static_cast<uint32_t>(scene.triangles.size()) + index;
  const auto most_depth = [&](double, double) { return static_cast<double>(bins.depth[index]); };
  return draw_within(frame, primitive, bins.box[index], place, target, most_depth,
                     [&](const ExactRay& ray) { return first_hit(ray, scene.spheres[index], primitive); });
}

uint64_t draw_plane(const Frame& frame, const PlaneOnScreen& seen, uint32_t index, int place, const ExactTarget& target) {
  const SceneData& scene = *frame.scene;
  const uint32_t primitive = static_cast<uint32_t>(scene.triangles.size() + scene.spheres.size()) + index;
  const PixelBox& pixels = target.pixels;
  const auto most_depth = [&](double x, double y) { return (seen.depth(x, y) + seen.margin) * (1 + 0x1p-23); };
  const double most_on_left = std::max(most_depth(pixels.x0, pixels.y0), most_depth(pixels.x0, pixels.y1)),
               most_on_right = std::max(most_depth(pixels.x1, pixels.y0), most_depth(pixels.x1, pixels.y1));
  if (seen.height == 0 || !(std::max(most_on_left, most_on_right) > 0)) return 0;  // all beyond the horizon
  return draw_within(frame, primitive, pixels, place, target, most_depth,
                     [&](const ExactRay& ray) { return first_hit(ray, scene.planes[index], seen.height); });
}

}  // namespace

void bin_exact(const Frame& frame, ExactBins& bins) {
  bins.plane.clear();
  for (const Plane& plane : frame.scene->planes) bins.plane.push_back(on_screen(frame, plane));
  const std::vector<Sphere>& spheres = frame.scene->spheres;
  bins.box.resize(spheres.size()), bins.depth.resize(spheres.size());
  bins.start.assign(static_cast<size_t>(frame.grid.count()) + 1, 0);
  for (size_t i = 0; i < spheres.size(); ++i) {
    bins.box[i] = bounds_of(frame, spheres[i]), bins.depth[i] = most_depth(frame, spheres[i]);
    for_each_tile(frame.grid, bins.box[i], [&](size_t tile) { ++bins.start[tile + 1]; });
  }
  for (size_t tile = 1; tile < bins.start.size(); ++tile) bins.start[tile] += bins.start[tile - 1];
  bins.sphere.resize(bins.start.back());
  std::vector<uint32_t> next(bins.start.begin(), bins.start.end() - 1);
  for (size_t i = 0; i < spheres.size(); ++i)
    for_each_tile(frame.grid, bins.box[i], [&](size_t tile) { bins.sphere[next[tile]++] = static_cast<uint32_t>(i); });
  for (size_t tile = 0; tile + 1 < bins.start.size(); ++tile)
    std::sort(bins.sphere.begin() + bins.start[tile], bins.sphere.begin() + bins.start[tile + 1],
              [&](uint32_t a, uint32_t b) { return bins.depth[a] != bins.depth[b] ? bins.depth[a] > bins.depth[b] : a < b; });
}

uint64_t draw_exact(const Frame& frame, const ExactBins& bins, int tile, int place, const ExactTarget& target) {
  uint64_t passed = 0;
  for (uint32_t k = bins.start[static_cast<size_t>(tile)]; k < bins.start[static_cast<size_t>(tile) + 1]; ++k)
    passed += draw_sphere(frame, bins, bins.sphere[k], place, target);
  for (size_t i = 0; i < bins.plane.size(); ++i)
    passed += draw_plane(frame, bins.plane[i], static_cast<uint32_t>(i), place, target);
  return passed;
}

}  // namespace spanray
