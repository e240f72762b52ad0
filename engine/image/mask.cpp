#include "image/mask.h"

#include <algorithm>

#include "spanray/settings.h"

namespace spanray {
namespace {

size_t values_of(const AmbiguityMask& mask) { return 3 * static_cast<size_t>(mask.width) * static_cast<size_t>(mask.height); }

std::string place_of(size_t value, int width) {
  const size_t pixel = value / 3, columns = static_cast<size_t>(width);
  return std::to_string(pixel % columns) + "," + std::to_string(pixel / columns);
}

std::string size_text(int width, int height) { return std::to_string(width) + "x" + std::to_string(height); }

}  // namespace

Result<void> write_mask(const std::string& path, const AmbiguityMask& mask) {
  if (mask.width < 1 || mask.height < 1 || mask.least.size() != values_of(mask) || mask.greatest.size() != values_of(mask))
    return Error{"cannot write an ambiguity mask whose size and values disagree", path};
  if (mask.height > kMaxImageSide / 2)
    return Error{"an ambiguity mask has at most " + std::to_string(kMaxImageSide / 2) + " rows, this one has " +
                     std::to_string(mask.height),
                 path};
  FloatImage both{mask.width, 2 * mask.height, mask.least};
  both.rgb.insert(both.rgb.end(), mask.greatest.begin(), mask.greatest.end());
  return write_pfm(path, both);
}

Result<AmbiguityMask> read_mask(const std::string& path) {
  Result<FloatImage> read = read_pfm(path);
  if (!read) return read.error();
  const FloatImage& both = read.value();
  if (both.height % 2 != 0)
    return Error{"not an ambiguity mask: " + std::to_string(both.height) +
                     " rows, where the least colors stand above as many rows of the greatest",
                 path};
  AmbiguityMask mask;
  mask.width = both.width, mask.height = both.height / 2;
  const auto middle = both.rgb.begin() + static_cast<std::ptrdiff_t>(values_of(mask));
  mask.least.assign(both.rgb.begin(), middle), mask.greatest.assign(middle, both.rgb.end());
  for (size_t i = 0; i < mask.least.size(); ++i) {
    const bool codes = mask.least[i] >= 0 && mask.least[i] <= 255 && mask.greatest[i] >= 0 && mask.greatest[i] <= 255;
    if (!codes)
      return Error{
          "not an ambiguity mask: at pixel " + place_of(i, mask.width) + " stands a value that is no code from 0 to 255", path};
    if (mask.least[i] > mask.greatest[i])
      return Error{"not an ambiguity mask: at pixel " + place_of(i, mask.width) + " the least color is above the greatest",
                   path};
  }
  return mask;
}

Result<MaskDifference> compare_with_mask(const PictureView& picture, const AmbiguityMask& mask) {
  if (picture.width != mask.width || picture.height != mask.height)
    return Error{"the picture is " + size_text(picture.width, picture.height) + ", the mask " +
                 size_text(mask.width, mask.height)};
  MaskDifference difference;
  difference.excess.reserve(mask.least.size() / 3);
  for (int y = 0; y < mask.height; ++y)
    for (int x = 0; x < mask.width; ++x) {
      const size_t at = 3 * difference.excess.size();
      const Color3 color = picture.code(x, y);
      const double codes[3] = {color.x, color.y, color.z};
      MaskDifference::Pixel pixel{x, y, 0, 0, 0, 0};
      double most = 0;
      for (int c = 0; c < 3; ++c) {
        const double least = mask.least[at + static_cast<size_t>(c)], greatest = mask.greatest[at + static_cast<size_t>(c)];
        // What is not a number is outside.
        double excess = 255;
        if (codes[c] >= least && codes[c] <= greatest)
          excess = 0;
        else if (codes[c] < least)
          excess = least - codes[c];
        else if (codes[c] > greatest)
          excess = codes[c] - greatest;
        difference.worst[c] = std::max(difference.worst[c], excess);
        if (excess > most)
          most = excess, pixel.channel = c, pixel.code = codes[c], pixel.least = least, pixel.greatest = greatest;
      }
      difference.excess.push_back(static_cast<float>(most));
      if (most == 0) continue;
      ++difference.outside;
      if (difference.first.size() < MaskDifference::kMostListed) difference.first.push_back(pixel);
    }
  return difference;
}

std::vector<float> mask_widths(const AmbiguityMask& mask) {
  std::vector<float> widths(mask.least.size() / 3, 0.0f);
  for (size_t i = 0; i < mask.least.size(); ++i) widths[i / 3] = std::max(widths[i / 3], mask.greatest[i] - mask.least[i]);
  return widths;
}

double share_wider(const AmbiguityMask& mask, double codes) {
  const std::vector<float> widths = mask_widths(mask);
  const auto wider = std::count_if(widths.begin(), widths.end(), [&](float width) { return double{width} > codes; });
  return widths.empty() ? 0 : static_cast<double>(wider) / static_cast<double>(widths.size());
}

}  // namespace spanray
