// A table of kernels, tried on every instruction set that this machine has.
#pragma once
#include <gtest/gtest.h>

#include "simd/isa.h"

namespace spanray {

// body(index into a table of SPANRAY_KERNEL_TABLE); what fails in it names the instruction set.
template <class Body> void on_every_isa(const Body& body) {
  for (int isa = 0; isa < kIsaCount; ++isa)
    if (isa_supported(static_cast<Isa>(isa + 1))) {
      SCOPED_TRACE(isa_name(static_cast<Isa>(isa + 1)));
      body(isa);
    }
}

}  // namespace spanray
