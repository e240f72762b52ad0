// Do two tracers answer the same rays alike?
#pragma once
#include "frame/rays.h"
#include "scene/scene_data.h"

namespace spanray::peers {

inline constexpr double kSameDistance = 1e-6;  // relative: hits at such distances are a tie
inline constexpr double kEnoughRays = 0.999;   // share of the rays that must be answered alike

// Of closest hits: how many of the rays hit different triangles at different distances. their_t in units of the direction.
uint64_t different_hits(const SceneData& scene, const RayBatch& rays, const uint32_t* ours, const uint32_t* theirs, const float* their_t);

// Of any hits: how many of the first `count` bits, 32 a word, differ.
uint64_t different_bits(int count, const uint32_t* ours, const uint32_t* theirs);

}  // namespace spanray::peers
