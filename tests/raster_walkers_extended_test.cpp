// Ten million random triangles; SPANRAY_FUZZ_SEED=N repeats a run.
#include <cstdlib>
#include <random>

#include "support/walker_fuzz.h"

namespace spanray {
namespace {

uint32_t fuzz_seed() {
  const char* const given = std::getenv("SPANRAY_FUZZ_SEED");
  return given != nullptr ? static_cast<uint32_t>(std::strtoul(given, nullptr, 10)) : std::random_device()();
}

TEST(RasterWalkers, R9_CoverageOfTenMillionTrianglesIsTheOracles) { fuzz_walkers(fuzz_seed(), 9000000, 1); }
TEST(RasterWalkers, R9_CoverageOfAMillionTrianglesAtSamplesIsTheOracles) { fuzz_walkers(fuzz_seed(), 1000000, 16); }

}  // namespace
}  // namespace spanray
