#include "frame/samples.h"

#include <algorithm>
#include <cmath>

namespace spanray {
namespace {

struct Offset { int8_t x, y; };  // in 1/16 pixel from the center

constexpr Offset kFour[] = {{-2, -6}, {6, -2}, {-6, 2}, {2, 6}};
constexpr Offset kEight[] = {{1, -3}, {-1, 3}, {5, 1}, {-3, -5}, {-5, 5}, {-7, -1}, {3, 7}, {7, -7}};
constexpr Offset kSixteen[] = {{1, 1},  {-1, -3}, {-3, 2}, {4, -1},  {-5, -2}, {2, 5},  {5, 3}, {3, -5},
                               {-2, 6}, {0, -7},  {-4, -6}, {-6, 4}, {-8, 0},  {7, -4}, {6, 7}, {-7, -8}};

}  // namespace

SamplePlaces make_sample_places(int count) {
  SamplePlaces places;
  if (count == 1) return places;
  const Offset* const offset = count == 4 ? kFour : count == 8 ? kEight : kSixteen;
  places.count = count;
  places.spacing = std::sqrt(1.0 / count);
  for (int s = 0; s < count; ++s) {
    const int place = places.first() + s;
    places.offset_x_24_8[place] = 16 * offset[s].x, places.offset_y_24_8[place] = 16 * offset[s].y;
    places.x[place] = 0.5 + offset[s].x / 16.0, places.y[place] = 0.5 + offset[s].y / 16.0;
    places.left = std::min(places.left, places.offset_x_24_8[place]), places.right = std::max(places.right, places.offset_x_24_8[place]);
    places.top = std::min(places.top, places.offset_y_24_8[place]), places.bottom = std::max(places.bottom, places.offset_y_24_8[place]);
  }
  return places;
}

}  // namespace spanray
