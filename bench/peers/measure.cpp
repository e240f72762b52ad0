#include "measure.h"

#include <ctime>

namespace spanray::peers {
namespace {

double read_clock(clockid_t clock) {
  timespec t = {};
  clock_gettime(clock, &t);
  return static_cast<double>(t.tv_sec) * 1e3 + static_cast<double>(t.tv_nsec) * 1e-6;
}

}  // namespace

double wall_ms() { return read_clock(CLOCK_MONOTONIC); }
double cpu_ms() { return read_clock(CLOCK_PROCESS_CPUTIME_ID); }

}  // namespace spanray::peers
