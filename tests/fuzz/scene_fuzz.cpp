// A TOML scene file beside a sound OBJ.
#include "fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const spanray::FuzzFolder folder;
  spanray::must_load_or_say_why(folder.write("s.toml", spanray::text_of(data, size)));
  return 0;
}
