#include "agreement.h"

#include <algorithm>
#include <cstdlib>

namespace spanray::peers {
namespace {

int difference_at(const Image& a, const Image& b, size_t pixel) {
  int most = 0;
  for (size_t c = 0; c < 3; ++c) most = std::max(most, std::abs(int{a.rgba[4 * pixel + c]} - int{b.rgba[4 * pixel + c]}));
  return most;
}

}  // namespace

Agreement compare_pictures(const Image& ours, const std::vector<float>& our_depth, const Image& theirs,
                           const std::vector<float>& their_depth) {
  Agreement result;
  for (size_t i = 0; i < our_depth.size(); ++i) {
    const bool we = our_depth[i] > 0, they = their_depth[i] > 0;
    if (we != they) ++(we ? result.only_ours : result.only_theirs);
    if (!we || !they) continue;
    const int difference = difference_at(ours, theirs, i);
    ++result.both;
    ++result.by_difference[difference];
    if (difference <= Agreement::kTolerance) ++result.agreeing;
  }
  return result;
}

Image difference_picture(const Image& ours, const std::vector<float>& our_depth, const Image& theirs,
                         const std::vector<float>& their_depth) {
  Image out = ours;
  for (size_t i = 0; i < our_depth.size(); ++i) {
    uint8_t* p = out.rgba.data() + 4 * i;
    const auto gray = static_cast<uint8_t>((p[0] + p[1] + p[2]) / 6);
    const int difference = difference_at(ours, theirs, i);
    p[0] = p[1] = p[2] = gray;
    if ((our_depth[i] > 0) != (their_depth[i] > 0)) p[0] = p[1] = 0, p[2] = 255;
    else if (difference > Agreement::kTolerance) p[0] = static_cast<uint8_t>(std::min(255, 128 + 4 * difference)), p[1] = p[2] = 0;
  }
  return out;
}

}  // namespace spanray::peers
