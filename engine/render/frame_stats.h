// From what the tasks counted and timed to what the caller reads.
#pragma once
#include <memory>
#include <vector>

#include "render/tile.h"

namespace spanray {

// Sizes the arrays of `out` that were asked for and empties the others.
void resize_output(const Settings& settings, const FrameRequest& request, Framebuffer& out);
// Sums the workers' counts; stage seconds become milliseconds divided by the number of threads.
void add_worker_stats(const std::vector<std::unique_ptr<TileWorker>>& workers, int threads, FrameCounts& counts, FrameStats& stats);
// Names the counts, and warns of what was dropped.
void add_counts(const FrameCounts& counts, FrameStats& stats);

}  // namespace spanray
