// The least and the greatest color that each pixel may have, when vertices, texture reads, levels of detail, depths and
// positions err by no more than is published (docs/decisions/0013-ambiguity-mask.md). In double, by the reference renderer's
// own surfaces, lights and tree.
#pragma once
#include "frame/ambiguity_mask.h"
#include "reference/reference.h"

namespace spanray {

// Samples as in render_reference: each shaded on its own (a mask of more than one is for supersampled pictures).
// What is enumerated, not sampled: every surface that can be seen when each vertex moves by up to bounds.pixels, those included
// whose order in depth is undecided; every light that a moved edge may let through or stop. What is sampled: light on each such
// surface, at the corners and the middle of what can be seen of it. Errors: those of render_reference.
Result<void> make_ambiguity_mask(const Scene& scene, const Camera& camera, const Settings& settings,
                                 const ReferenceOptions& options, const AmbiguityBounds& bounds, AmbiguityMask& out);

}  // namespace spanray
