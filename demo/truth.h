// The ground truth that `report` and `tune` judge by, and how far it can be trusted itself.
#pragma once
#include <functional>

#include "image/metrics.h"
#include "job.h"
#include "spanray/image.h"

namespace spanray::demo {

using TruthProgress = std::function<void(double fraction)>;

// The reference renderer's picture; grid as in ReferenceOptions. Errors: of the request and of the reference.
Result<Framebuffer> render_truth(const Job& job, const Camera& camera, const Settings& settings, int grid,
                                 const TruthProgress& progress);

struct Truth {
  Image picture;
  // Between the truth and a second one, with second_grid() squared samples a pixel at other places: somewhat more than the
  // truth itself errs by having finitely many samples, since the second one errs, too. Errors of settings that are as small are
  // not known.
  Metrics error;
};

// Of the second truth: the next larger grid (the next smaller where there is none), whose places have nothing in common with
// the first's.
int second_grid(int grid);

Result<Truth> make_truth(const Job& job, const Camera& camera, const Settings& settings, int grid,
                         const TruthProgress& progress);

}  // namespace spanray::demo
