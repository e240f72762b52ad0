// spanray_make_assets FOLDER: writes the shipped scenes. The bytes are the same on every machine.
#include <cstdio>

#include "scenes.h"

int main(int argc, char** argv) {
  if (argc != 2 || argv[1][0] == '-') {
    std::fprintf(stderr, "usage: spanray_make_assets FOLDER\n");
    return 2;
  }
  const auto written = spanray::assets::write_assets(argv[1]);
  if (!written) std::fprintf(stderr, "spanray_make_assets: %s\n", written.error().to_string().c_str());
  return written ? 0 : 1;
}
