// The page of a report: one HTML file that needs no other, no network and no library.
#pragma once
#include <string>

#include "report_data.h"

namespace spanray::demo {

// Pictures of the page by id ("truth" is the ground truth), as PNG bytes; mask_png: the widths of the ambiguity mask.
struct PageImage { std::string id, name, picture_png, flip_png; };

std::string report_page(const Report& report, const std::vector<PageImage>& images, const std::string& mask_png);

}  // namespace spanray::demo
