// What light does on a piece of a surface, as ranges: over all its points, all errors of reading textures, and shadows that may
// or may not be.
#pragma once
#include "frame/ambiguity_mask.h"
#include "reference/beam.h"
#include "reference/color_range.h"
#include "reference/world.h"

namespace spanray::reference {

// A piece of a surface as a bundle of rays sees it.
struct Seen {
  ColorRange color;           // of the light that it gives back and emits, mirrors aside
  ColorRange mirror;          // weight of mirrored radiance
  Range alpha;                // opacity
  std::vector<Ray> mirrored;  // the first: of the piece's middle; empty where nothing is mirrored
  glm::dvec3 normal{0};       // geometric, toward the viewer
  double error = 0;           // of positions on it, in the scene's units
};

class RangeShader {
 public:
  RangeShader(const World& world, const Settings& settings, const AmbiguityBounds& bounds)
      : world_(world), settings_(settings), bounds_(bounds) {}

  Seen see(const Bundle& bundle, const Piece& piece) const;
  // Adds the part of a triangle that lies in the beam, if cut-outs, screen-door and (not for shadows) culling may let it stop
  // rays; false if nothing was added. ray_to: the ray through a point.
  enum class For { kSight, kShadow };
  template <class RayTo>
  bool gather(For what, const Beam& beam, uint32_t primitive, const glm::dvec3 (&v)[3], const RayTo& ray_to,
              std::vector<Piece>& pieces) const {
    Piece piece = clip(beam, primitive, v);
    if (piece.corner.empty()) return false;
    const Ray ray = ray_to(middle(piece.corner));
    if (what == For::kSight && world_.surfaces.culled(ray, primitive)) return false;
    const Role role = world_.surfaces.role(primitive);
    if (role == Role::kMask || role == Role::kScreenDoor) {
      const Range opacity = stop_opacity(piece, ray_to);
      if (!world_.surfaces.stops(ray, primitive, opacity.high)) return false;
      piece.certain = world_.surfaces.stops(ray, primitive, opacity.low);
    }
    pieces.push_back(std::move(piece));
    return true;
  }

 private:
  enum class Lit { kNo, kMaybe, kYes };
  struct Sums;
  Range stop_opacity(const Piece& piece, const std::function<Ray(const glm::dvec3&)>& ray_to) const;
  bool add(const Bundle& bundle, const Piece& piece, const glm::dvec3& at, const Nudge& nudge,
           void (Spread::*how)(const glm::dvec3&), Sums& sums) const;
  Lit lit(const Bundle& bundle, const Piece& piece, const Seen& seen, const Light& light) const;
  // How else textures may be read on a material; levels: how far the level of detail may be off beside bounds.levels.
  std::vector<Nudge> nudges(const Material& material, const Range& levels) const;
  Range moved_levels(const Bundle& bundle, const Piece& piece) const;

  const World& world_;
  const Settings settings_;
  const AmbiguityBounds bounds_;
};

}  // namespace spanray::reference
