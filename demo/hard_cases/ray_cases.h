// What the families of ray cases and the sweeps share.
#pragma once
#include <memory>

#include "hard_case.h"
#include "ray/bvh.h"
#include "shade/surface.h"
#include "support/bvh_oracle.h"

namespace spanray::hard {

enum class Aim { kVertex, kEdge, kInterior };
inline constexpr Aim kAims[] = {Aim::kVertex, Aim::kEdge, Aim::kInterior};

Bvh build_all(const TestFrame& t);
std::unique_ptr<TestFrame> mesh_frame(const IndexedMesh& mesh, double scale, const glm::dvec3& move);
// From within half a radius of the center; every other one from the very center, so that directions to vertices are exact.
RayBatch rays_inside(const TestFrame& frame, Aim aim, int n, uint32_t seed, double scale, const glm::dvec3& center);
// Each ray must hit something, for "closest" and for "any".
void check_hits(TestFrame& t, const Bvh& bvh, const RayBatch& rays, Isa isa, Tally& tally);
// Geometric normal of a surface.
glm::dvec3 normal_at(const SurfaceBatch& surfaces, uint32_t i);
// One directional light, from where `toward` points (any length but 0).
void light_from(SceneData& scene, const glm::dvec3& toward);

}  // namespace spanray::hard
