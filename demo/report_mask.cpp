#include "report_mask.h"

#include <chrono>

#include "core/counted.h"
#include "image/false_color.h"
#include "image/mask.h"
#include "reference/ambiguity.h"
#include "report_html.h"

namespace spanray::demo {
namespace {

constexpr double kWidest = 64;  // of the map, codes

}  // namespace

Result<ReportMask> measure_mask(const Job& job, const Settings& settings, const Image& picture, const TruthProgress& progress) {
  const auto begin = std::chrono::steady_clock::now();
  ReferenceOptions options;
  options.threads = job.settings.threads, options.progress = progress;
  AmbiguityMask mask;
  if (auto made = make_ambiguity_mask(job.scene, job.camera, settings, options, {}, mask); !made) return made.error();
  const Result<MaskDifference> own = compare_with_mask(picture, mask);
  if (!own) return own.error();
  ReportMask result;
  result.widths = false_color(mask_widths(mask), mask.width, mask.height, kWidest);
  result.over_3 = share_wider(mask, 3), result.over_8 = share_wider(mask, 8);
  result.open = mask.open, result.outside = own.value().outside;
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

std::string mask_section(const ReportMask& m, const std::string& png) {
  return "<h2 id=\"ambiguity\">What errors within published bounds leave open</h2>\n<p>Vertices that move by 1/256 pixel, "
         "textures read within 1/256 texel, "
         "undecided depths and what they do to shadows and mirrors give each pixel a least and a greatest color. <b>" +
         short_number(100 * m.over_8) + " %</b> of the pixels are left open by more than 8 of 255, " +
         short_number(100 * m.over_3) + " % by more than 3; 2 is the least. " + counted(m.open, "pixel has", "pixels have") +
         " mirrors that show too much to be enumerated. Of the plain setting's picture " +
         counted(m.outside, "pixel is", "pixels are") +
         " outside. To judge another renderer by it: <code>spanray reference SCENE --out G.png --mask M.pfm</code>, "
         "<code>spanray compare OTHER.png --golden G.png --mask M.pfm</code>.</p>\n<figure><img alt=\"width of the ambiguity "
         "mask\" src=\"data:image/png;base64," +
         base64(png) + "\"><figcaption>the widest channel of each pixel: black 0, pale yellow " + short_number(kWidest) +
         " of 255 or more</figcaption></figure>\n";
}

nlohmann::ordered_json mask_json(const ReportMask& m) {
  return {{"share_over_3", m.over_3},
          {"share_over_8", m.over_8},
          {"mirrors_not_enumerated", m.open},
          {"outside", m.outside},
          {"seconds", m.seconds}};
}

}  // namespace spanray::demo
