// An OBJ file beside an MTL and a PNG file: parsed, cut into triangles, given normals, built, checked.
#include "fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const spanray::FuzzFolder folder;
  spanray::must_load_or_say_why(folder.write("s.obj", spanray::text_of(data, size)));
  return 0;
}
