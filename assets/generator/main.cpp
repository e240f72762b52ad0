// spanray_make_assets: writes the shipped scenes. The bytes are the same on every machine.
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "scenes.h"

namespace {

const char* const kUsage =
    "usage: spanray_make_assets FOLDER                  all shipped scenes and their textures\n"
    "       spanray_make_assets --detail N hall FOLDER  the gallery hall with about N triangles (within 20 %), 10000 to 10000000\n"
    "FOLDER is made if it is not there. The same N gives the same bytes on every machine; ten million triangles take about\n"
    "a minute, 2 GB of memory and 600 MB on disk.\n";

int usage_error(const char* why) {
  std::fprintf(stderr, "spanray_make_assets: %s\n%s", why, kUsage);
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 2 && (std::strcmp(argv[1], "--help") == 0 || std::strcmp(argv[1], "-h") == 0)) return std::fputs(kUsage, stdout), 0;
  spanray::Result<void> written;
  if (argc == 5 && std::strcmp(argv[1], "--detail") == 0) {
    char* end = nullptr;
    const long triangles = std::strtol(argv[2], &end, 10);
    if (end == argv[2] || *end != '\0' || triangles < 10000 || triangles > 10000000) return usage_error("--detail wants a number from 10000 to 10000000");
    if (std::strcmp(argv[3], "hall") != 0) return usage_error("only the scene 'hall' has levels of detail");
    written = spanray::assets::write_hall(argv[4], static_cast<double>(triangles));
  } else if (argc == 2 && argv[1][0] != '-') {
    written = spanray::assets::write_assets(argv[1]);
  } else {
    return usage_error("wrong arguments");
  }
  if (!written) std::fprintf(stderr, "spanray_make_assets: %s\n", written.error().to_string().c_str());
  return written ? 0 : 1;
}
