// Surfaces of spheres: one hit at a time, in plain doubles, beside the kernels of triangles.
#pragma once
#include <vector>

#include "shade/surface.h"

namespace spanray {

// resolve_surfaces() (shade/surface.h) of a scene with spheres; out has its size.
// Contract: as resolve(): an entry is a function of its own ray, primitive and the frame alone. Weights and lift of spheres are
//           0; their shading normal is the sphere's own, whatever Settings::shading says.
void resolve_with_spheres(const Frame& frame, const HitBatch& hits, SurfaceBatch& out);

// While it lives, a batch holds its spheres only, or all but these; then it is what it was. For shade_light(): light on spheres
// is always that at the pixel.
class OnlyKind {
 public:
  OnlyKind(const SceneData& scene, const SurfaceBatch& surfaces, bool spheres);
  ~OnlyKind();
  OnlyKind(const OnlyKind&) = delete;
  OnlyKind& operator=(const OnlyKind&) = delete;
  bool none() const { return kept_ == 0; }

 private:
  const SurfaceBatch& surfaces_;
  std::vector<int> left_out_;
  int kept_ = 0;
};

}  // namespace spanray
