#include "reference/pixels.h"

#include <algorithm>
#include <mutex>

#include "core/parallel.h"
#include "reference/world.h"

namespace spanray::reference {

Result<void> check_request(const SceneData& scene, const Settings& settings, int grid) {
  constexpr int kMaxGrid = 64;
  if (!sample_count_ok(settings.samples) || grid < 0 || grid > kMaxGrid)
    return Error{"reference: that number of samples is not possible"};
  return check_model(scene, settings);
}

void for_each_pixel(const Settings& settings, const ReferenceOptions& options, const std::function<void(int x, int y)>& body) {
  constexpr int kBlock = 32;  // pixels a side: what a task renders
  const int columns = (settings.width + kBlock - 1) / kBlock, rows = (settings.height + kBlock - 1) / kBlock;
  std::mutex mutex;
  int done = 0;
  Parallel parallel(options.threads);
  parallel.for_each(static_cast<size_t>(columns) * static_cast<size_t>(rows), [&](size_t block, int) {
    const int x0 = static_cast<int>(block) % columns * kBlock, y0 = static_cast<int>(block) / columns * kBlock;
    for (int y = y0; y < std::min(y0 + kBlock, settings.height); ++y)
      for (int x = x0; x < std::min(x0 + kBlock, settings.width); ++x) body(x, y);
    const std::lock_guard lock(mutex);
    ++done;
    if (options.progress) options.progress(static_cast<double>(done) / (static_cast<double>(columns) * rows));
  });
}

}  // namespace spanray::reference
