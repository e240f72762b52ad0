#include "shapes.h"

#include <cmath>

#include "math/elementary.h"

namespace spanray::assets {
namespace {

constexpr double kDegree = kPi / 180;

glm::dvec2 unit2(glm::dvec2 v) {
  const double length = std::sqrt(v.x * v.x + v.y * v.y);
  return length > 0 ? glm::dvec2{v.x / length, v.y / length} : glm::dvec2{0, 0};
}

// A profile ready to be swept: each piece with the normals of its points and the running length.
struct ProfilePoint { glm::dvec2 at, normal; double length; };
std::vector<std::vector<ProfilePoint>> with_normals(const Profile& profile) {
  std::vector<std::vector<ProfilePoint>> pieces;
  double length = 0;
  for (const auto& piece : profile) {
    std::vector<ProfilePoint> out;
    for (size_t i = 0; i < piece.size(); ++i) {
      glm::dvec2 tangent{0, 0};
      if (i > 0) tangent = tangent + unit2(piece[i] - piece[i - 1]);
      if (i + 1 < piece.size()) tangent = tangent + unit2(piece[i + 1] - piece[i]);
      tangent = unit2(tangent);
      if (i > 0) length += std::sqrt((piece[i].x - piece[i - 1].x) * (piece[i].x - piece[i - 1].x) + (piece[i].y - piece[i - 1].y) * (piece[i].y - piece[i - 1].y));
      out.push_back({piece[i], {tangent.y, -tangent.x}, length});  // the outside is to the right
    }
    pieces.push_back(out);
  }
  return pieces;
}

// Sweeps along stations: at station k the profile point (a, b) stands at origin + a * x + b * y (of that placement).
void sweep(ObjMesh& mesh, const Profile& profile, int stations, const std::function<Placement(int)>& station,
           const std::function<double(int)>& u_of, double texture_size) {
  std::vector<Placement> at;
  for (int k = 0; k <= stations; ++k) at.push_back(station(k));
  for (const auto& piece : with_normals(profile)) {
    patch(mesh, stations, static_cast<int>(piece.size()) - 1, [&](double s, double t) {
      const int k = static_cast<int>(s * stations + 0.5);
      const ProfilePoint& p = piece[static_cast<size_t>(t * static_cast<double>(piece.size() - 1) + 0.5)];
      const Placement& frame = at[static_cast<size_t>(k)];
      return Corner{frame.origin + p.at.x * frame.x + p.at.y * frame.y, frame.direction({p.normal.x, p.normal.y, 0}),
                    {u_of(k), p.length / texture_size}};
    });
  }
}

}  // namespace

Placement placed(const Point& origin, double degrees) {
  double s, c;
  sin_cos(degrees * kDegree, &s, &c);
  return {origin, {c, 0, -s}, {0, 1, 0}, {s, 0, c}};
}

void patch(ObjMesh& mesh, int columns, int rows, const std::function<Corner(double, double)>& at) {
  std::vector<Corner> below, above;
  for (int j = 0; j <= rows; ++j) {
    above.clear();
    for (int i = 0; i <= columns; ++i) above.push_back(at(static_cast<double>(i) / columns, static_cast<double>(j) / rows));
    for (size_t i = 0; j > 0 && i < static_cast<size_t>(columns); ++i) mesh.face({below[i], below[i + 1], above[i + 1], above[i]});
    below.swap(above);
  }
}

void smooth_patch(ObjMesh& mesh, int columns, int rows, const std::function<Point(double, double)>& at,
                  const std::function<glm::dvec2(double, double)>& uv, double h, const Point& fallback) {
  patch(mesh, columns, rows, [&](double s, double t) {
    const Point ds = at(s + h, t) - at(s - h, t), dt = at(s, t + h) - at(s, t - h);
    return Corner{at(s, t), normalize3(cross3(ds, dt), fallback), uv(s, t)};
  });
}

void rectangle(ObjMesh& mesh, const Point& corner, const Point& along_u, const Point& along_v, int columns, int rows,
               double texture_size, glm::dvec2 uv_start) {
  const Point normal = normalize3(cross3(along_u, along_v), Point{0, 1, 0});
  const double width = length3(along_u) / texture_size, height = length3(along_v) / texture_size;
  patch(mesh, columns, rows, [&](double s, double t) {
    return Corner{corner + s * along_u + t * along_v, normal, {uv_start.x + s * width, uv_start.y + t * height}};
  });
}

void box(ObjMesh& mesh, const Placement& at, const Point& size, double chamfer, double division, double texture_size) {
  const Point half = 0.5 * size, inner = half - Point{chamfer, chamfer, chamfer};
  const auto axis = [](int k, double length) { Point p{0, 0, 0}; p[k] = length; return p; };
  const auto corner = [&](const Point& p, const Point& n, glm::dvec2 uv) { return Corner{at.point(p), at.direction(n), uv}; };
  const auto divisions = [&](double length) { return division > 0 ? static_cast<int>(std::floor(length / division)) + 1 : 1; };
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    // Texture v goes up on upright faces.
    const bool turned = i == 1;
    for (int side = -1; side <= 1; side += 2) {
      const Point du = axis(i, 2 * inner[i] * side), dv = axis(j, 2 * inner[j]);
      const Point start = axis(k, half[k] * side) - 0.5 * du - 0.5 * dv;
      patch(mesh, divisions(size[i]), divisions(size[j]), [&](double s, double t) {
        const double a = (s - 0.5) * 2 * inner[i] / texture_size, b = t * 2 * inner[j] / texture_size;
        return corner(start + s * du + t * dv, axis(k, side), turned ? glm::dvec2{b, a * side + inner[i] / texture_size} : glm::dvec2{a, b});
      });
    }
    // The four edges along axis k, and with k = 0 the eight corners.
    for (int si = -1; si <= 1; si += 2) {
      for (int sj = -1; sj <= 1 && chamfer > 0; sj += 2) {
        const double r = std::sqrt(0.5);
        const Point n = axis(i, si * r) + axis(j, sj * r);
        const Point a = axis(i, half[i] * si) + axis(j, inner[j] * sj), b = axis(i, inner[i] * si) + axis(j, half[j] * sj);
        const Point along = axis(k, inner[k]), first = si * sj > 0 ? a : b, second = si * sj > 0 ? b : a;
        const double v = 2 * inner[k] / texture_size, w = chamfer / texture_size;
        patch(mesh, 1, divisions(size[k]), [&](double s, double t) {
          return corner((s > 0 ? second : first) + (2 * t - 1) * along, n, {w * s, v * t});
        });
        for (int sk = -1; k == 0 && sk <= 1; sk += 2) {
          const double q = std::sqrt(1.0 / 3);
          const Point m = axis(k, sk * q) + axis(i, si * q) + axis(j, sj * q);
          const Corner pk = corner(axis(k, half[k] * sk) + axis(i, inner[i] * si) + axis(j, inner[j] * sj), m, {0, 0});
          const Corner pi = corner(axis(k, inner[k] * sk) + a, m, {w, 0}), pj = corner(axis(k, inner[k] * sk) + b, m, {0, w});
          if (sk * si * sj > 0) mesh.face({pk, pi, pj});
          else mesh.face({pk, pj, pi});
        }
      }
    }
  }
}

void sphere(ObjMesh& mesh, const Point& center, double radius, int segments, glm::dvec2 uv_repeat) {
  patch(mesh, segments, segments / 2, [&](double s, double t) {
    double sin_u, cos_u, sin_v, cos_v;
    sin_cos(s < 1 ? s * 2 * kPi : 0, &sin_u, &cos_u);
    sin_cos(t * kPi, &sin_v, &cos_v);
    if (t == 0 || t == 1) sin_v = 0;
    const Point n{sin_v * cos_u, -cos_v, -sin_v * sin_u};
    return Corner{center + radius * n, n, {s * uv_repeat.x, t * uv_repeat.y}};
  });
}

std::vector<glm::dvec2> arc(glm::dvec2 center, double radius_a, double radius_b, double from, double to, int segments) {
  std::vector<glm::dvec2> points;
  for (int k = 0; k <= segments; ++k) {
    double s, c;
    sin_cos((from + (to - from) * k / segments) * kDegree, &s, &c);
    points.push_back({center.x + radius_a * c, center.y + radius_b * s});
  }
  return points;
}

Profile refined(const Profile& profile, double longest) {
  Profile out;
  for (const auto& piece : profile) {
    std::vector<glm::dvec2> points = {piece.front()};
    for (size_t i = 1; i < piece.size(); ++i) {
      const glm::dvec2 step = piece[i] - piece[i - 1];
      const int n = 1 + static_cast<int>(std::floor(std::sqrt(step.x * step.x + step.y * step.y) / longest));
      for (int k = 1; k <= n; ++k) points.push_back(k < n ? piece[i - 1] + (static_cast<double>(k) / n) * step : piece[i]);
    }
    out.push_back(points);
  }
  return out;
}

Outline& Outline::line(double a, double b) { return smooth({{a, b}}); }

Outline& Outline::smooth(const std::vector<glm::dvec2>& points) {
  std::vector<glm::dvec2> piece = {at_};
  for (const glm::dvec2& p : points) {
    const double da = p.x - piece.back().x, db = p.y - piece.back().y;
    if (da * da + db * db > 1e-8) piece.push_back(p);
  }
  at_ = piece.back();
  pieces_.push_back(piece);
  return *this;
}

void lathe(ObjMesh& mesh, const Placement& at, const Profile& profile, int segments, double repeat_u, double texture_size) {
  const auto station = [&](int k) {
    double s, c;
    sin_cos(k < segments ? 2 * kPi * k / segments : 0, &s, &c);
    return Placement{at.origin, c * at.x - s * at.z, at.y, s * at.x + c * at.z};
  };
  sweep(mesh, profile, segments, station, [&](int k) { return repeat_u * k / segments; }, texture_size);
}

void arch(ObjMesh& mesh, const Placement& at, const Profile& profile, int segments, double texture_size) {
  const double middle = 0.5 * (profile.front().front().x + profile.front().back().x);
  const auto station = [&](int k) {
    double s, c;
    sin_cos(kPi * k / segments, &s, &c);
    return Placement{at.origin, c * at.x + s * at.y, at.z, -s * at.x + c * at.y};
  };
  sweep(mesh, profile, segments, station, [&](int k) { return kPi * middle * k / segments / texture_size; }, texture_size);
}

void bar(ObjMesh& mesh, const Placement& at, const Profile& profile, double length, int divisions, double texture_size) {
  // sweep() wants the profile's outside to the right seen with the path coming toward us: walk it from far to near.
  const auto station = [&](int k) {
    Placement p = at;
    p.origin = at.origin + (length * (divisions - k) / divisions) * at.z;
    return p;
  };
  sweep(mesh, profile, divisions, station, [&](int k) { return length * k / divisions / texture_size; }, texture_size);
  for (int end = 0; end < 2; ++end) {
    std::vector<Corner> cap;
    for (const auto& piece : profile) {
      for (size_t i = 0; i + 1 < piece.size(); ++i) {
        const Point p{piece[i].x, piece[i].y, end == 0 ? 0 : length};
        cap.push_back({at.point(p), at.direction({0, 0, end == 0 ? -1.0 : 1.0}), {p.x / texture_size, p.y / texture_size}});
      }
    }
    for (size_t i = 1; i + 1 < cap.size(); ++i) mesh.face({cap[0], cap[end == 0 ? i + 1 : i], cap[end == 0 ? i : i + 1]});
  }
}

void picture_frame(ObjMesh& mesh, const Placement& at, double width, double height, double wide, double deep, double texture_size) {
  const double c = 0.15 * (wide < deep ? wide : deep), z = 0.5 * deep;
  // Counter-clockwise seen along the side: a outward from the opening, b toward the front.
  const glm::dvec2 section[9] = {{0, -z + c}, {0, z - c}, {c, z}, {wide - c, z}, {wide, z - c}, {wide, -z + c}, {wide - c, -z}, {c, -z}, {0, -z + c}};
  const Point out[4] = {{0, -1, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}};
  const Point corners[4] = {{-width / 2, -height / 2, 0}, {width / 2, -height / 2, 0}, {width / 2, height / 2, 0}, {-width / 2, height / 2, 0}};
  for (int side = 0; side < 4; ++side) {
    const int next = (side + 1) & 3, previous = (side + 3) & 3;
    double v = 0;
    for (int i = 0; i < 8; ++i) {
      const glm::dvec2 p = section[i], q = section[i + 1], d = unit2(q - p);
      const Point normal = at.direction(-d.y * out[side] + d.x * Point{0, 0, 1});
      const double dv = std::sqrt((q.x - p.x) * (q.x - p.x) + (q.y - p.y) * (q.y - p.y)) / texture_size;
      const auto corner = [&](int end, glm::dvec2 a, double tv) {
        const Point diagonal = end == 0 ? out[side] + out[previous] : out[side] + out[next];
        const Point local = corners[end == 0 ? side : next] + a.x * diagonal + Point{0, 0, a.y};
        return Corner{at.point(local), normal, {dot3(local - corners[side], out[next]) / texture_size, tv}};
      };
      mesh.face({corner(0, p, v), corner(0, q, v + dv), corner(1, q, v + dv), corner(1, p, v)});
      v += dv;
    }
  }
}

}  // namespace spanray::assets
