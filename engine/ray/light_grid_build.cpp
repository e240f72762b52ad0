// Grids of lights. Triangles are put into cells in tasks of a face, or of a part of its rows, that share nothing.
#include <algorithm>
#include <bit>
#include <cmath>

#include "ray/bvh_data.h"
#include "ray/light_grid.h"
#include "ray/light_grid_triangle.h"
#include "ray/sphere_triangle.h"

namespace spanray {
namespace {

using light_grid::FaceTriangle;
using light_grid::Span;

// Cells along a side of a face. Finer ones have fewer triangles each, but rays of a packet are in more of them: from half to four
// times as many cells cost up to a tenth more time (docs/decisions/0018-light-grids.md).
constexpr int kPointSide = 64, kDirectionalSide = 256;
constexpr int kBands = 8;               // of a directional light's rows
// All grids of a scene: so much, and so many times the tree. Lights for which nothing is left ask the tree.
constexpr size_t kMostBytes = size_t{64} << 20, kMostOfTree = 8;
constexpr size_t kEntryBytes = 3 * sizeof(uint32_t);
// While one grid is made: cells that are looked at for triangles of a part, so that layers of large triangles do not take forever, and entries of
// all parts together, hidden ones included.
constexpr size_t kMostVisits = size_t{1} << 24, kMostVisitsOfTriangle = 16, kMostEntries = size_t{1} << 25;
constexpr size_t kMostLights = 8;       // all grids of a scene together look at no more cells than so many lights may
constexpr float kLargest = 1e12f, kSmallest = 1e-12f;  // sizes of scenes
constexpr size_t kMostTouching = 4;
constexpr double kTouching = 0x1p-11;   // of the reach of a light

struct GridTriangle {
  uint32_t place;
  bool hides;  // not masked
};

// Each triangle of the tree once, in its order.
std::vector<GridTriangle> list_triangles(const SceneData& scene, const uint32_t* material_flags, const Bvh::Data& data) {
  std::vector<GridTriangle> list;
  std::vector<bool> seen(data.references > data.primitives ? scene.triangles.size() : 0);
  for (const BvhNode& node : data.nodes)
    for (int c = 0; c < kBvhWidth; ++c) {
      if (!(node.bounds[0][c] <= node.bounds[3][c]) || (node.child[c] & kLeafBit) == 0) continue;
      const uint32_t block = leaf_block(node.child[c]);
      for (uint32_t j = 0; (leaf_lanes(node.child[c]) >> j & 1u) != 0; ++j) {
        const uint32_t primitive = data.blocks[block].primitive[j];
        if (!seen.empty() && seen[primitive]) continue;
        if (!seen.empty()) seen[primitive] = true;
        list.push_back({block * kBvhWidth + j, (material_flags[material_of(scene.triangles[primitive])] & kMaterialMasked) == 0});
      }
    }
  return list;
}

glm::dvec3 corner_of(const TriangleBlock& block, uint32_t lane, int v) {
  return {block.vertex[v][0][lane], block.vertex[v][1][lane], block.vertex[v][2][lane]};
}

// An entry of a cell of a part (LightGrid::words).
struct Item {
  uint32_t cell;
  float nearness;
  uint32_t box, seen;  // seen: of the part
};

// Rows [row0, row1) of a face.
struct Part {
  int face, row0, row1;
  size_t visits = 0;
  std::vector<Item> items;
  std::vector<LightGrid::Seen> seen;
  std::vector<float> cover;  // by cell: what is less near is hidden
  std::vector<uint32_t> counts;
};

class PartMaker {
 public:
  PartMaker(const LightGrid& grid, const Bvh::Data& data, Part& part) : grid_(grid), data_(data), part_(part), side_(grid.side) {
    part.cover.assign(static_cast<size_t>(side_) * static_cast<size_t>(part.row1 - part.row0), -INFINITY);
  }

  void add(const GridTriangle& triangle) {
    if (std::find(grid_.touching.begin(), grid_.touching.end(), triangle.place) != grid_.touching.end()) return;
    const TriangleBlock& block = data_.blocks[triangle.place / kBvhWidth];
    glm::dvec3 corner[3];
    double value[3];
    for (int v = 0; v < 3; ++v) seen_from(corner_of(block, triangle.place % kBvhWidth, v), corner[v], value[v]);
    const FaceTriangle seen(corner, grid_.directional ? value : nullptr);
    ++part_.visits;
    if (!seen.seen) return;
    const double half = side_ / 2.0;
    int from = part_.row0, to = part_.row1 - 1;
    if (!seen.crosses) {
      from = std::max(from, static_cast<int>(std::floor((std::max(seen.low[1], -1.5) - light_grid::kMargin + 1) * half)));
      to = std::min(to, static_cast<int>(std::floor((std::min(seen.high[1], 1.5) + light_grid::kMargin + 1) * half)));
    }
    const bool may_cover = triangle.hides && seen.sound && !seen.crosses && seen.high[0] - seen.low[0] > 1 / half && seen.high[1] - seen.low[1] > 1 / half;
    const size_t before = part_.items.size();
    const uint32_t number = static_cast<uint32_t>(part_.seen.size());
    for (int row = from; row <= to; ++row) {
      const double v0 = row / half - 1, v1 = (row + 1) / half - 1;
      const Span span = seen.touched(v0, v1, side_), inner = may_cover ? seen.covered(v0, v1, side_) : Span{1, 0, 0, 0};
      part_.visits += static_cast<size_t>(span.last - span.first + 2);
      const double low_v = seen.crosses ? 0 : (seen.low[1] - light_grid::kMargin - v0) * half, high_v = seen.crosses ? 1 : (seen.high[1] + light_grid::kMargin - v0) * half;
      for (int column = span.first; column <= span.last; ++column) {
        const double u0 = column / half - 1, u1 = (column + 1) / half - 1;
        const size_t cell = static_cast<size_t>(((row - part_.row0) / 8 * (side_ / 8) + column / 8) * 64 + row % 8 * 8 + column % 8);
        const double nearest = seen.nearest_in(u0, u1, v0, v1);
        if (!grid_.directional && !(nearest > 0)) continue;
        const float nearness = static_cast<float>(with_slack(nearest, light_grid::kNearnessSlack));
        float& cover = part_.cover[cell];
        if (nearness < cover) continue;
        part_.items.push_back({static_cast<uint32_t>(cell), nearness, box_of((span.from - u0) * half, low_v, (span.to - u0) * half, high_v), number});
        if (column >= inner.first && column <= inner.last)
          cover = std::max(cover, static_cast<float>(with_slack(seen.farthest_in(u0, u1, v0, v1), -light_grid::kCoverSlack)));
      }
    }
    if (part_.items.size() == before) return;
    LightGrid::Seen record = record_of(seen, corner, triangle.hides);
    record.place = triangle.place, record.primitive = block.primitive[triangle.place % kBvhWidth];
    part_.seen.push_back(record);
  }

  // Items by cell, the nearest first, without those that are hidden.
  void sort() {
    const auto hidden = [&](const Item& i) { return i.nearness < part_.cover[i.cell]; };
    part_.items.erase(std::remove_if(part_.items.begin(), part_.items.end(), hidden), part_.items.end());
    part_.counts.assign(part_.cover.size() + 1, 0);
    for (const Item& i : part_.items) ++part_.counts[i.cell + 1];
    for (size_t c = 0; c < part_.cover.size(); ++c) part_.counts[c + 1] += part_.counts[c];
    std::vector<Item> sorted(part_.items.size());
    std::vector<uint32_t> at(part_.counts.begin(), part_.counts.end() - 1);
    for (const Item& i : part_.items) sorted[at[i.cell]++] = i;
    for (size_t c = 0; c < part_.cover.size(); ++c)
      std::sort(sorted.begin() + part_.counts[c], sorted.begin() + part_.counts[c + 1], [](const Item& a, const Item& b) {
        return a.nearness != b.nearness ? a.nearness > b.nearness : a.seen < b.seen;
      });
    part_.items.swap(sorted);
    part_.cover = {};
  }

 private:
  // Of a part of a cell, in cells; a byte more on all sides for what places in a cell are rounded by.
  static uint32_t box_of(double low_u, double low_v, double high_u, double high_v) {
    const auto byte = [](double x) { return static_cast<uint32_t>(std::clamp(std::floor(x * 255) - 1, 0.0, 255.0)); };
    return byte(low_u) | byte(low_v) << 8 | byte(1 - high_u) << 16 | byte(1 - high_v) << 24;
  }

  // A plane that passes nearly through a point light says nothing, since rays end beside it; and rays are not known to hit a needle that passes
  // it closer than hit_triangle() can tell where they begin.
  LightGrid::Seen record_of(const FaceTriangle& seen, const glm::dvec3 (&corner)[3], bool hides) const {
    if (grid_.directional) return seen.record(light_grid::kEdgeError, hides, true);
    const double nearest = nearest_point(SphereTriangle(corner[0], corner[1], corner[2]), glm::dvec3(0)).distance;
    double longest = 0;
    for (int i = 0; i < 3; ++i) longest = std::max(longest, length3(corner[(i + 1) % 3] - corner[i]));
    const double reach = static_cast<double>(grid_.reach), slope = std::fabs(seen.nearness.x) + std::fabs(seen.nearness.y) + std::fabs(seen.nearness.z);
    const glm::dvec3 normal = cross3(corner[1] - corner[0], corner[2] - corner[0]);
    const double area = std::fabs(normal.x) + std::fabs(normal.y) + std::fabs(normal.z);
    return seen.record(light_grid::kEdgeError + light_grid::kDirectionError * reach / nearest, hides && area * nearest > 0x1p-22 * longest * longest * longest,
                       slope * reach < 0x1p20);
  }

  double with_slack(double nearness, double slack) const {
    return grid_.directional ? nearness + slack : nearness * (1 + slack);
  }

  void seen_from(const glm::dvec3& p, glm::dvec3& corner, double& value) const {
    const double y[3] = {p.x - static_cast<double>(grid_.center[0]), p.y - static_cast<double>(grid_.center[1]), p.z - static_cast<double>(grid_.center[2])};
    if (grid_.directional) {
      double at[3];
      for (int r = 0; r < 3; ++r)
        at[r] = static_cast<double>(grid_.axis[r][0]) * y[0] + static_cast<double>(grid_.axis[r][1]) * y[1] + static_cast<double>(grid_.axis[r][2]) * y[2];
      corner = {at[0], at[1], 1}, value = at[2];
      return;
    }
    const int k = part_.face / 2;
    corner = {y[(k + 1) % 3], y[(k + 2) % 3], part_.face % 2 == 0 ? y[k] : -y[k]}, value = 0;
  }

  const LightGrid& grid_;
  const Bvh::Data& data_;
  Part& part_;
  const int side_;
};

// Center, axes and reach; false if the numbers do not allow a grid.
bool place_grid(const Light& light, const Bvh::Data& data, LightGrid& grid) {
  double middle[3], extent = 0;
  for (int k = 0; k < 3; ++k) {
    middle[k] = (static_cast<double>(data.bounds_min[k]) + static_cast<double>(data.bounds_max[k])) / 2;
    extent += std::pow(static_cast<double>(data.bounds_max[k]) - static_cast<double>(data.bounds_min[k]), 2);
  }
  extent = std::sqrt(extent) / 2;  // of a sphere around the scene
  grid.directional = light.kind == static_cast<int32_t>(LightKind::kDirectional);
  if (!grid.directional && light.kind != static_cast<int32_t>(LightKind::kPoint)) return false;
  grid.side = grid.directional ? kDirectionalSide : kPointSide;
  double aside2 = 0;  // of the center
  for (int k = 0; k < 3; ++k) {
    grid.center[k] = grid.directional ? static_cast<float>(middle[k]) : light.position[k];
    aside2 += std::pow(middle[k] - static_cast<double>(grid.center[k]), 2);
  }
  const double radius = extent + std::sqrt(aside2);  // around the center
  grid.reach = static_cast<float>(2 * radius);
  if (!(extent > static_cast<double>(kSmallest) && radius < static_cast<double>(kLargest))) return false;  // or not finite
  if (!grid.directional) return true;
  glm::dvec3 axis[3];
  axis[2] = -normalize3({light.direction[0], light.direction[1], light.direction[2]}, glm::dvec3(0));
  const glm::dvec3 aside = std::fabs(axis[2].x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  axis[0] = normalize3(cross3(aside, axis[2]), glm::dvec3(0));
  axis[1] = cross3(axis[2], axis[0]);
  for (int r = 0; r < 3; ++r)
    for (int k = 0; k < 3; ++k) grid.axis[r][k] = static_cast<float>(axis[r][k] / (radius * 1.01));
  return dot3(axis[2], axis[2]) > 0.5;
}

bool find_touching(const Bvh::Data& data, const std::vector<GridTriangle>& triangles, LightGrid& grid) {
  if (grid.directional) return true;
  const glm::dvec3 light(grid.center[0], grid.center[1], grid.center[2]);
  const double near = kTouching * static_cast<double>(grid.reach);
  for (const GridTriangle& t : triangles) {
    const TriangleBlock& block = data.blocks[t.place / kBvhWidth];
    const auto corner = [&](int v) { return corner_of(block, t.place % kBvhWidth, v) - light; };
    const glm::dvec3 a = corner(0), b = corner(1), c = corner(2);
    bool far = false;
    for (int k = 0; k < 3; ++k) far = far || std::min({a[k], b[k], c[k]}) > near || std::max({a[k], b[k], c[k]}) < -near;
    if (far || nearest_point(SphereTriangle(a, b, c), glm::dvec3(0)).distance > near) continue;
    grid.touching.push_back(t.place);
    if (grid.touching.size() > kMostTouching) return false;
  }
  return true;
}

void join(const std::vector<Part>& parts, size_t entries, size_t seen, LightGrid& grid) {
  grid.words.resize(3 * entries), grid.seen.resize(seen);
  const size_t cells = static_cast<size_t>(grid.faces()) * static_cast<size_t>(grid.side) * static_cast<size_t>(grid.side);
  grid.first.resize(cells + 1);
  size_t cell = 0, at = 0, first_seen = 0;
  for (const Part& p : parts) {
    for (size_t c = 0; c + 1 < p.counts.size(); ++c) {
      const size_t n = p.counts[c + 1] - p.counts[c];
      grid.first[cell++] = static_cast<uint32_t>(at);
      for (size_t i = 0; i < n; ++i) {
        const Item& e = p.items[p.counts[c] + i];
        uint32_t* const word = grid.words.data() + 3 * at + i;
        word[0] = std::bit_cast<uint32_t>(e.nearness), word[n] = e.box, word[2 * n] = static_cast<uint32_t>(first_seen) + e.seen;
      }
      at += n;
    }
    for (const LightGrid::Seen& t : p.seen) grid.seen[first_seen++] = t;
  }
  grid.first[cell] = static_cast<uint32_t>(at);
}

size_t most_visits(size_t triangles) { return kMostVisits + kMostVisitsOfTriangle * triangles; }

// What may still be spent on grids.
struct Budget { size_t bytes, visits; };

// False if it takes more than that. Takes off what it took.
bool build_grid(const Bvh::Data& data, const std::vector<GridTriangle>& triangles, Budget& budget, Parallel& parallel, LightGrid& grid) {
  std::vector<Part> parts;
  const int bands = grid.directional ? kBands : 1;
  for (int face = 0; face < grid.faces(); ++face)
    for (int b = 0; b < bands; ++b) parts.push_back({face, grid.side * b / bands, grid.side * (b + 1) / bands, 0, {}, {}, {}, {}});
  const size_t most_items = 2 * kMostEntries / parts.size(), visits_of_part = most_visits(triangles.size());
  const auto within = [&](const Part& part) { return part.items.size() <= most_items && part.visits <= visits_of_part; };
  parallel.for_each(parts.size(), [&](size_t p, int) {
    PartMaker maker(grid, data, parts[p]);
    for (size_t i = 0; i < triangles.size() && within(parts[p]); ++i) maker.add(triangles[i]);
    if (within(parts[p])) maker.sort();
  });
  size_t entries = 0, seen = 0, visits = 0;
  for (const Part& p : parts) entries += p.items.size(), seen += p.seen.size(), visits += p.visits;
  budget.visits -= std::min(budget.visits, visits);
  if (!std::all_of(parts.begin(), parts.end(), within) || entries * kEntryBytes + seen * sizeof(LightGrid::Seen) > budget.bytes) return false;
  join(parts, entries, seen, grid);
  budget.bytes -= std::min(budget.bytes, grid.memory_bytes());
  return true;
}

}  // namespace

LightGrids::LightGrids(const SceneData& scene, const uint32_t* material_flags, const Bvh& bvh, Parallel& parallel) {
  const Bvh::Data& data = bvh.data();
  if (data.nodes.empty() || data.instances || scene.light_follows_eye) return;
  const std::vector<GridTriangle> triangles = list_triangles(scene, material_flags, data);
  Budget budget = {kMostBytes + kMostOfTree * bvh.memory_bytes(), kMostLights * most_visits(triangles.size())};
  for (const Light& light : scene.lights) {
    LightGrid grid;
    if (budget.bytes == 0 || budget.visits == 0 || !place_grid(light, data, grid) || !find_touching(data, triangles, grid) ||
        !build_grid(data, triangles, budget, parallel, grid))
      grid = LightGrid();
    grids_.push_back(std::move(grid));
  }
}

size_t LightGrids::count() const {
  return static_cast<size_t>(std::count_if(grids_.begin(), grids_.end(), [](const LightGrid& g) { return g.side > 0; }));
}

size_t LightGrids::memory_bytes() const {
  size_t bytes = 0;
  for (const LightGrid& g : grids_) bytes += g.memory_bytes();
  return bytes;
}

}  // namespace spanray
