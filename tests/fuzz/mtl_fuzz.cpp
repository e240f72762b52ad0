// An MTL file under a sound OBJ: nothing in it may keep the mesh from loading.
#include "fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const spanray::FuzzFolder folder;
  folder.write("a.mtl", spanray::text_of(data, size));
  const auto loaded = spanray::load_scene(folder.file("a.obj"));
  spanray::must(bool(loaded), "a material library stopped a mesh");
  spanray::must(loaded.value().scene.triangle_count() == 2, "triangles were lost");
  spanray::must_load_or_say_why(folder.file("a.obj"));
  return 0;
}
