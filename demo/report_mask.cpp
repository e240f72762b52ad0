#include "report_mask.h"

#include <algorithm>
#include <chrono>
#include <iterator>

#include "core/counted.h"
#include "core/number_text.h"
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
  result.worst = *std::max_element(std::begin(own.value().worst), std::end(own.value().worst));
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

std::string mask_section(const ReportMask& m, const std::string& png) {
  std::string text =
      "<h2 id=\"ambiguity\">What errors within published bounds leave open</h2>\n<p>Renderers that keep the bounds of the "
      "Direct3D 11.3 specification and of this renderer's contract may differ: vertices move by up to 1/256 pixel, textures are "
      "read within 1/256 texel, near depths are decided either way, shading and the step to bytes err by 1 of 255. That, and "
      "what it does to shadows, mirrors and translucent layers, leaves each pixel a range of colors from a least to a greatest. "
      "It is wider than 8 of 255 in <b>" +
      short_number(100 * m.over_8) + " %</b> of the pixels, wider than 3 in " + short_number(100 * m.over_3) +
      " %, and 2 wide (less only at black and white) where nothing but shading errs.";
  if (m.open > 0)
    text += " In " + counted(m.open, "pixel", "pixels") +
            " mirrors show too much to be enumerated: no greatest color is known, and the range goes up to white.";
  if (m.outside == 0)
    text += " All pixels of the plain setting's picture are within.";
  else
    text += " <b>" + counted(m.outside, "pixel", "pixels") + "</b> of the plain setting's picture " +
            (m.outside == 1 ? "is" : "are") + " outside, by " + short_number(m.worst) +
            " of 255 at most: light and what mirrors show are sampled, so the range can be a little too narrow.";
  return text +
         "</p>\n<p>To judge another renderer's picture by it, with this report's size, camera and other options: "
         "<code>spanray reference SCENE --out G.png --mask M.pfm</code>, then "
         "<code>spanray compare OTHER.png --golden G.png --mask M.pfm</code>.</p>\n<figure class=\"map\"><img "
         "alt=\"width of the ambiguity mask\" src=\"data:image/png;base64," +
         base64(png) +
         "\"><figcaption>how wide the range is, of each pixel's widest channel: black 0, pale yellow " + number_text(kWidest) +
         " of 255 or more</figcaption></figure>\n";
}

nlohmann::ordered_json mask_json(const ReportMask& m) {
  return {{"share_over_3", m.over_3},
          {"share_over_8", m.over_8},
          {"mirrors_not_enumerated", m.open},
          {"outside", m.outside},
          {"outside_by", m.worst},
          {"seconds", m.seconds}};
}

}  // namespace spanray::demo
