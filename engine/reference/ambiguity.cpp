#include "reference/ambiguity.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "reference/pixels.h"
#include "reference/rays.h"
#include "reference/shade_range.h"
#include "scene/pose.h"

namespace spanray {
namespace reference {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

// Something translucent before, or behind, an opaque surface.
struct Layer {
  double near = 0, far = 0;
  ColorRange color;
  Range alpha;
};

// From curved mirror to curved mirror a bundle spreads until it sees half the scene; then its color is left open, from black to
// anything.
struct Work {
  static constexpr int kMostBundles = 48;
  static constexpr size_t kMostPieces = 24,
                          kMostCandidates = 200;  // seen in a mirror by one of them, and before hidden ones are left out
  int bundles = 0;
  bool open = false;
};

class MaskRenderer {
 public:
  MaskRenderer(const SceneData& scene, const Camera& camera, const Settings& settings, const ReferenceOptions& options,
               const AmbiguityBounds& bounds)
      : settings_(settings),
        bounds_(bounds),
        view_(camera, settings.width, settings.height),
        places_(make_places(settings, options.grid)),
        world_(scene, camera, settings),
        shader_(world_, settings, bounds) {}

  // open: set where mirrors spread so far that what they show was not enumerated.
  ColorRange pixel(int x, int y, bool& open) const {
    ColorRange sum = ColorRange::of(glm::dvec3(0));
    for (size_t i = 0; i < places_.at.size(); ++i) {
      Work work;
      sum = sum + radiance(primary_bundle(view_, primary_ray(view_, places_, i, x, y), bounds_.pixels), 0, work);
      open |= work.open;
    }
    return sum * (1 / static_cast<double>(places_.at.size()));
  }

 private:
  // All pieces of a tree that may be seen; farthest: the greatest depth at which one can be that the center's ray meets for
  // certain. More than `most` candidates: some of them, all useless.
  std::vector<Piece> pieces_of(const Tree& tree, const Bundle& bundle, size_t most, double& farthest) const;
  std::vector<Layer> layers_of(const Bundle& bundle, double farthest) const;
  ColorRange radiance(const Bundle& bundle, int bounce, Work& work) const;
  ColorRange mirrored(const Seen& seen, int bounce, Work& work) const;

  const Settings settings_;
  const AmbiguityBounds bounds_;
  const View view_;
  const Places places_;
  const World world_;
  const RangeShader shader_;
};

std::vector<Piece> MaskRenderer::pieces_of(const Tree& tree, const Bundle& bundle, size_t most, double& farthest) const {
  std::vector<Piece> pieces;
  double limit = farthest;
  tree.visit_region([&](const glm::dvec3& low, const glm::dvec3& high) { return bundle.beam.misses(low, high); },
                    [&](uint32_t primitive, const glm::dvec3(&v)[3]) {
                      if (!shader_.gather(
                              RangeShader::For::kSight, bundle.beam, primitive, v,
                              [&](const glm::dvec3& x) { return bundle.through(x); }, pieces))
                        return false;
                      Piece& p = pieces.back();
                      p.near = kFar, p.far = 0;
                      for (const glm::dvec3& x : p.corner)
                        p.near = std::min(p.near, bundle.depth(x)), p.far = std::max(p.far, bundle.depth(x));
                      p.near *= 1 - bounds_.depth, p.far *= 1 + bounds_.depth;
                      if (&tree == &world_.opaque && p.certain && !p.cut && !p.crosses[0] && !p.crosses[1] && !p.crosses[2])
                        limit = std::min(limit, p.far);
                      if (p.near > limit) pieces.pop_back();
                      return pieces.size() > most;
                    });
  if (pieces.size() > most) return pieces;
  const auto hidden = [&](const Piece& p) { return p.near > limit; };
  pieces.erase(std::remove_if(pieces.begin(), pieces.end(), hidden), pieces.end());
  if (&tree != &world_.opaque) return pieces;
  for (const Sheet& sheet :
       make_sheets(pieces, [&](const glm::dvec3& x) { return bundle.bends() ? bundle.axis : x - bundle.beam.origin; })) {
    if (!sheet.closed) continue;
    double far = 0;
    for (const size_t i : sheet.pieces) far = std::max(far, pieces[i].far);
    limit = std::min(limit, far);
  }
  pieces.erase(std::remove_if(pieces.begin(), pieces.end(), hidden), pieces.end());
  farthest = limit;
  return pieces;
}

std::vector<Layer> MaskRenderer::layers_of(const Bundle& bundle, double farthest) const {
  std::vector<Layer> layers;
  if (world_.blended.empty()) return layers;
  const std::vector<Piece> pieces = pieces_of(world_.blended, bundle, SIZE_MAX, farthest);
  for (const Sheet& sheet :
       make_sheets(pieces, [&](const glm::dvec3& x) { return bundle.bends() ? bundle.axis : x - bundle.beam.origin; })) {
    Layer layer{kFar, 0, {}, {1, 0}};
    for (const size_t i : sheet.pieces) {
      const Seen seen = shader_.see(bundle, pieces[i]);
      layer.near = std::min(layer.near, pieces[i].near), layer.far = std::max(layer.far, pieces[i].far);
      layer.color.add(seen.color);
      layer.alpha = {std::min(layer.alpha.low, seen.alpha.low), std::max(layer.alpha.high, seen.alpha.high)};
    }
    if (!sheet.closed) layer.alpha.low = 0;
    layers.push_back(layer);
  }
  std::sort(layers.begin(), layers.end(), [](const Layer& a, const Layer& b) { return a.near + a.far > b.near + b.far; });
  return layers;
}

// Those of one depth, in any order, over what is behind: every result is a mixture of all their colors. begin != end.
ColorRange blend_alike(std::vector<Layer>::iterator begin, std::vector<Layer>::iterator end, const ColorRange& back) {
  constexpr std::ptrdiff_t kMostOrdered = 4;
  ColorRange result;
  if (end - begin > kMostOrdered) {
    result = back;
    for (auto layer = begin; layer != end; ++layer) result.add(layer->color);
    return result;
  }
  std::vector<Layer*> order;
  for (auto layer = begin; layer != end; ++layer) order.push_back(&*layer);
  do {
    ColorRange color = back;
    for (const Layer* layer : order) color = over(layer->color, layer->alpha, color);
    result.add(color);
  } while (std::next_permutation(order.begin(), order.end()));
  return result;
}

// The layers before depths from near to far over a color; what they let through.
ColorRange blend(std::vector<Layer> layers, double near, double far, ColorRange color, Range& through) {
  std::erase_if(layers, [&](const Layer& layer) { return layer.near > far; });
  through = {1, 1};
  for (Layer& layer : layers) {
    if (layer.far >= near) layer.alpha.low = 0;
    through = {through.low * (1 - layer.alpha.high), through.high * (1 - layer.alpha.low)};
  }
  for (auto begin = layers.begin(); begin != layers.end();) {
    auto end = begin + 1;
    for (double nearest = begin->near; end != layers.end() && end->far >= nearest; ++end)
      nearest = std::min(nearest, end->near);
    color = blend_alike(begin, end, color), begin = end;
  }
  return color;
}

ColorRange MaskRenderer::mirrored(const Seen& seen, int bounce, Work& work) const {
  if (++work.bundles <= Work::kMostBundles) {
    const ColorRange range = radiance(mirrored_bundle(seen.mirrored, seen.normal, seen.error), bounce, work);
    if (!range.empty()) return range;
  }
  work.open = true;
  return {glm::dvec3(0), glm::dvec3(kAnything)};
}

// Empty: a mirror shows more than can be enumerated.
ColorRange MaskRenderer::radiance(const Bundle& bundle, int bounce, Work& work) const {
  double farthest = kFar;
  const std::vector<Piece> pieces = pieces_of(world_.opaque, bundle, bounce > 0 ? Work::kMostCandidates : SIZE_MAX, farthest);
  if (bounce > 0 && pieces.size() > Work::kMostPieces) return {};
  const std::vector<Layer> layers = layers_of(bundle, farthest);
  ColorRange result;
  Range through;
  for (const Piece& piece : pieces) {
    const Seen seen = shader_.see(bundle, piece);
    ColorRange color = blend(layers, piece.near, piece.far, seen.color, through);
    if (!seen.mirrored.empty() && bounce < settings_.max_bounces) {
      const ColorRange weight{seen.mirror.low * through.low, seen.mirror.high * through.high};
      color = color + weight * mirrored(seen, bounce + 1, work);
    }
    result.add(color);
  }
  if (farthest == kFar) result.add(blend(layers, kFar, kFar, ColorRange::of(to_dvec(world_.scene.background)), through));
  return result;
}

}  // namespace
}  // namespace reference

Result<void> make_ambiguity_mask(const Scene& scene, const Camera& camera, const Settings& settings,
                                 const ReferenceOptions& options, const AmbiguityBounds& bounds, AmbiguityMask& out) {
  if (!scene.valid()) return Error{"ambiguity mask: there is no scene"};
  if (Result<void> checked = reference::check_request(scene.data(), settings, options.grid); !checked) return checked;
  if (scene.data().has_exact()) return Error{"ambiguity mask: spheres and planes are not modelled; only scenes of triangles have one"};
  const Scene standing = scene_at(scene, settings.time);
  const reference::MaskRenderer renderer(standing.data(), camera, settings, options, bounds);
  const size_t width = static_cast<size_t>(settings.width), pixels = width * static_cast<size_t>(settings.height);
  out.width = settings.width, out.height = settings.height;
  out.least.assign(3 * pixels, 0), out.greatest.assign(3 * pixels, 0);
  std::atomic<uint64_t> open = 0;
  reference::for_each_pixel(settings, options, [&](int x, int y) {
    bool any_open = false;
    const reference::ColorRange range = renderer.pixel(x, y, any_open);
    if (any_open) ++open;
    const size_t i = static_cast<size_t>(y) * width + static_cast<size_t>(x);
    for (size_t c = 0; c < 3; ++c) {
      const int channel = static_cast<int>(c);
      out.least[3 * i + c] = static_cast<float>(std::max(reference::srgb_code(range.low[channel]) - bounds.codes, 0.0));
      out.greatest[3 * i + c] = static_cast<float>(std::min(reference::srgb_code(range.high[channel]) + bounds.codes, 255.0));
    }
  });
  out.open = open;
  return {};
}

}  // namespace spanray
