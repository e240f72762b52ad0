// How much of a scene's picture is open at all: the report's section about its ambiguity mask.
#pragma once
#include <string>

#include <nlohmann/json.hpp>

#include "job.h"
#include "truth.h"

namespace spanray::demo {

struct ReportMask {
  Image widths;                   // in false color
  double over_3 = 0, over_8 = 0;  // shares of the pixels that are left open by more codes
  uint64_t open = 0;              // pixels whose mirrors could not be enumerated
  uint64_t outside = 0;           // pixels of the renderer's own picture that are outside
  double worst = 0;               // by how many codes at most
  double seconds = 0;             // that it took
};
// settings: with one sample a pixel; picture: made with them. Errors: those of make_ambiguity_mask.
Result<ReportMask> measure_mask(const Job& job, const Settings& settings, const Image& picture, const TruthProgress& progress);

// png: the file of `widths`.
std::string mask_section(const ReportMask& mask, const std::string& png);
nlohmann::ordered_json mask_json(const ReportMask& mask);

}  // namespace spanray::demo
