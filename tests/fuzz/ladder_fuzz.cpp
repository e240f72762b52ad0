// What `compare` reads besides pictures: hash ladders (JSON) and float maps.
#include "frame/ladder.h"
#include "fuzz.h"
#include "image/pfm.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace spanray;
  static const FuzzFolder folder;
  const std::string path = folder.write("x", text_of(data, size));
  const Result<Ladder> ladder = Ladder::read_json(path);
  if (ladder) must(!Ladder::first_difference(ladder.value(), ladder.value()).found, "a ladder that differs from itself");
  else must(ladder.error().file == path && !ladder.error().message.empty(), "an error without file or cause");
  const Result<FloatImage> map = read_pfm(path);
  if (map)
    must(map.value().rgb.size() == 3 * static_cast<size_t>(map.value().width) * static_cast<size_t>(map.value().height), "floats");
  else
    must(map.error().file == path && !map.error().message.empty(), "an error without file or cause");
  return 0;
}
