#include "image/flip.h"

#include <algorithm>
#include <cmath>

namespace spanray {
namespace flip {
namespace {

constexpr double kPi = 3.14159265358979323846;

Kernel gaussian(int radius, double pixels_per_degree, double b) {
  Kernel k;
  k.radius = radius;
  double sum = 0;
  for (int i = -radius; i <= radius; ++i) {
    const double x = i / pixels_per_degree;
    k.weight.push_back(std::exp(-kPi * kPi * x * x / b));
    sum += k.weight.back();
  }
  for (double& w : k.weight) w /= sum;
  return k;
}

}  // namespace

// Table 1 of the paper. In the picture's plane a term is a sqrt(pi / b) exp(-pi^2 r^2 / b); all kernels have the radius of the
// widest.
Sensitivity contrast_sensitivity(Channel channel, double pixels_per_degree) {
  struct Term {
    double a, b;
  };
  constexpr Term kTerms[3][2] = {{{1, 0.0047}, {0, 1e-5}}, {{1, 0.0053}, {0, 1e-5}}, {{34.1, 0.04}, {13.5, 0.025}}};
  const int radius = static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * kPi * kPi)) * pixels_per_degree));
  const Term* const terms = kTerms[static_cast<int>(channel)];
  Sensitivity s;
  s.terms = channel == Channel::kBlueYellow ? 2 : 1;
  double whole = 0;
  for (int i = 0; i < s.terms; ++i) {
    s.kernel[i] = gaussian(radius, pixels_per_degree, terms[i].b);
    double sum = 0;
    for (int j = -radius; j <= radius; ++j)
      sum += std::exp(-kPi * kPi * j * j / (pixels_per_degree * pixels_per_degree * terms[i].b));
    s.share[i] = terms[i].a * std::sqrt(kPi / terms[i].b) * sum * sum;
    whole += s.share[i];
  }
  for (double& share : s.share) share /= whole;
  if (s.terms == 1) s.share[1] = 0;
  return s;
}

Features feature_kernels(double pixels_per_degree) {
  constexpr double kWidth = 0.082;  // degrees: of the features that people see best
  const double deviation = 0.5 * kWidth * pixels_per_degree;
  const int radius = static_cast<int>(std::ceil(3 * deviation));
  Features f;
  double sum = 0;
  for (Kernel* k : {&f.smooth, &f.edge, &f.point}) k->radius = radius;
  for (int i = -radius; i <= radius; ++i) {
    const double x = i / deviation, g = std::exp(-0.5 * x * x);
    sum += g;
    f.smooth.weight.push_back(g), f.edge.weight.push_back(-i * g), f.point.weight.push_back((x * x - 1) * g);
  }
  for (double& w : f.smooth.weight) w /= sum;
  for (Kernel* k : {&f.edge, &f.point}) {
    double positive = 0, negative = 0;
    for (const double w : k->weight) (w > 0 ? positive : negative) += std::fabs(w);
    for (double& w : k->weight) w /= w > 0 ? positive : negative;
  }
  return f;
}

Color3 hunt_lab(const Color3& linear_rgb) {
  const Color3 lab = lab_from_xyz(xyz_from_rgb(linear_rgb));
  return {lab.x, 0.01 * lab.x * lab.y, 0.01 * lab.x * lab.z};
}

double hyab(const Color3& p, const Color3& q) { return std::fabs(p.x - q.x) + std::hypot(p.y - q.y, p.z - q.z); }

double color_error(double hyab_distance) {
  constexpr double kPower = 0.7, kBend = 0.4, kAtBend = 0.95;
  static const double most = std::pow(hyab(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1})), kPower);
  const double error = std::pow(hyab_distance, kPower), bend = kBend * most;
  const double value = error < bend ? kAtBend / bend * error : kAtBend + (error - bend) / (most - bend) * (1 - kAtBend);
  return std::min(value, 1.0);
}

namespace {

constexpr int kBandRows = 32;

// Rows of a band with a margin all around, in which the nearest pixel of the picture stands.
struct Plane {
  int width = 0, rows = 0;  // margins included
  std::vector<double> value;
  Plane(int w, int r) : width(w), rows(r), value(static_cast<size_t>(w) * static_cast<size_t>(r)) {}
  double* row(int y) { return value.data() + static_cast<size_t>(y) * static_cast<size_t>(width); }
  const double* row(int y) const { return value.data() + static_cast<size_t>(y) * static_cast<size_t>(width); }
};

// Values of columns [margin, width - margin) along the row; other columns are left at 0.
Plane along_rows(const Plane& in, const Kernel& k, int margin) {
  Plane out(in.width, in.rows);
  for (int y = 0; y < in.rows; ++y)
    for (int j = -k.radius; j <= k.radius; ++j) {
      const double w = k.at(j);
      const double* const from = in.row(y) + j;
      double* const to = out.row(y);
      for (int x = margin; x < in.width - margin; ++x) to[x] += w * from[x];
    }
  return out;
}

// out[x] = sum of k over the rows around y, columns as above.
void down_columns(const Plane& in, const Kernel& k, int y, int margin, std::vector<double>& out) {
  out.assign(static_cast<size_t>(in.width), 0.0);
  for (int j = -k.radius; j <= k.radius; ++j) {
    const double w = k.at(j);
    const double* const from = in.row(y + j);
    for (int x = margin; x < in.width - margin; ++x) out[static_cast<size_t>(x)] += w * from[x];
  }
}

struct Kernels {
  Sensitivity csf[3];
  Features features;
  int margin;
  explicit Kernels(double ppd)
      : csf{contrast_sensitivity(Channel::kAchromatic, ppd), contrast_sensitivity(Channel::kRedGreen, ppd),
            contrast_sensitivity(Channel::kBlueYellow, ppd)},
        features(feature_kernels(ppd)),
        margin(std::max(csf[0].kernel[0].radius, features.smooth.radius)) {}
};

// What a band of one picture gives, row by row of the band: filtered colors, and the strength of edges and points.
struct Seen {
  std::vector<Color3> lab;  // hunt_lab after the sensitivity filters
  std::vector<double> edge, point;
};

Seen look_at(const PictureView& picture, int y0, int y1, const Kernels& kernels) {
  const int margin = kernels.margin, width = picture.width + 2 * margin, rows = y1 - y0 + 2 * margin;
  Plane channel[3] = {Plane(width, rows), Plane(width, rows), Plane(width, rows)};
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < width; ++x) {
      const Color3 c = ycxcz_from_xyz(xyz_from_rgb(
          picture.shown(std::clamp(x - margin, 0, picture.width - 1), std::clamp(y0 + y - margin, 0, picture.height - 1))));
      channel[0].row(y)[x] = c.x, channel[1].row(y)[x] = c.y, channel[2].row(y)[x] = c.z;
    }
  Plane luminance = channel[0];
  for (double& v : luminance.value) v = (v + 16) / 116;

  std::vector<Plane> across;  // of each channel and term
  for (int c = 0; c < 3; ++c)
    for (int i = 0; i < kernels.csf[c].terms; ++i) across.push_back(along_rows(channel[c], kernels.csf[c].kernel[i], margin));
  const Features& f = kernels.features;
  const Plane smooth = along_rows(luminance, f.smooth, margin), edge = along_rows(luminance, f.edge, margin),
              point = along_rows(luminance, f.point, margin);

  Seen seen;
  const size_t w = static_cast<size_t>(picture.width), first = static_cast<size_t>(margin);
  std::vector<double> sum[3], term, ex, ey, px, py;
  for (int y = margin; y < rows - margin; ++y) {
    size_t plane = 0;
    for (int c = 0; c < 3; ++c) {
      sum[c].assign(static_cast<size_t>(width), 0.0);
      for (int i = 0; i < kernels.csf[c].terms; ++i) {
        down_columns(across[plane++], kernels.csf[c].kernel[i], y, margin, term);
        for (size_t x = first; x < first + w; ++x) sum[c][x] += kernels.csf[c].share[i] * term[x];
      }
    }
    down_columns(edge, f.smooth, y, margin, ex), down_columns(smooth, f.edge, y, margin, ey);
    down_columns(point, f.smooth, y, margin, px), down_columns(smooth, f.point, y, margin, py);
    for (size_t x = first; x < first + w; ++x) {
      Color3 rgb = rgb_from_xyz(xyz_from_ycxcz({sum[0][x], sum[1][x], sum[2][x]}));
      for (double* v : {&rgb.x, &rgb.y, &rgb.z}) *v = std::clamp(*v, 0.0, 1.0);
      seen.lab.push_back(hunt_lab(rgb));
      seen.edge.push_back(std::hypot(ex[x], ey[x])), seen.point.push_back(std::hypot(px[x], py[x]));
    }
  }
  return seen;
}

}  // namespace
}  // namespace flip

std::vector<float> flip_map(const PictureView& a, const PictureView& b, Parallel& parallel, double pixels_per_degree) {
  const flip::Kernels kernels(pixels_per_degree);
  const size_t width = static_cast<size_t>(a.width);
  std::vector<float> map(width * static_cast<size_t>(a.height));
  const int bands = (a.height + flip::kBandRows - 1) / flip::kBandRows;
  parallel.for_each(static_cast<size_t>(bands), [&](size_t band, int) {
    const int y0 = static_cast<int>(band) * flip::kBandRows, y1 = std::min(y0 + flip::kBandRows, a.height);
    const flip::Seen p = flip::look_at(a, y0, y1, kernels), q = flip::look_at(b, y0, y1, kernels);
    for (size_t i = 0; i < p.lab.size(); ++i) {
      const double color = flip::color_error(flip::hyab(p.lab[i], q.lab[i]));
      // 4.2: half the power, so that a small difference of features counts.
      const double feature =
          std::sqrt(std::max(std::fabs(p.edge[i] - q.edge[i]), std::fabs(p.point[i] - q.point[i])) * std::sqrt(0.5));
      map[static_cast<size_t>(y0) * width + i] = static_cast<float>(std::pow(color, 1 - std::min(feature, 1.0)));  // 4.3
    }
  });
  return map;
}

}  // namespace spanray
