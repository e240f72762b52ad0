// What the fuzz targets share. A finding is an abort: libFuzzer keeps the input.
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include "spanray/scene.h"
#include "support/scene_invariants.h"
#include "support/temp_folder.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);

namespace spanray {

inline std::string_view text_of(const uint8_t* data, size_t size) { return {reinterpret_cast<const char*>(data), size}; }

inline void must(bool holds, const char* what, const std::string& more = "") {
  if (holds) return;
  std::fprintf(stderr, "broken: %s %s\n", what, more.c_str());
  std::abort();
}

// Loads a scene file: either a sound scene or an error that names file and cause; no flood of messages in either case.
inline void must_load_or_say_why(const std::string& path) {
  const Result<LoadedScene> loaded = load_scene(path);
  if (!loaded) {
    must(!loaded.error().file.empty() && !loaded.error().message.empty(), "an error without file or cause");
    must(loaded.error().message.size() < 4096, "an endless message");
    return;
  }
  const std::string broken = broken_promise(loaded.value().scene.data());
  must(broken.empty(), "a promise of scene_data.h:", broken);
  must(loaded.value().messages.size() < 300, "a flood of messages");
  for (const std::string& message : loaded.value().messages) must(message.size() < 4096, "an endless message");
}

inline constexpr std::string_view kQuadObj =
    "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 1\nvn 0 0 1\nusemtl m\nf 1/1/1 2/2/1 3/1/1 4/2/1\n";
inline constexpr std::string_view kPlainMtl = "newmtl m\nKd 0.5 0.5 0.5\nnewmtl n\nillum 3\nKs 1 1 1\n";

// A picture that textures may name: 2 x 1 pixels, RGBA.
inline constexpr unsigned char kTinyPng[] = {
    137, 80, 78, 71, 13, 10, 26, 10, 0, 0, 0, 13, 73, 72, 68, 82, 0, 0, 0, 2, 0, 0, 0, 1, 8, 6, 0, 0, 0, 244, 34, 127, 138,
    0, 0, 0, 17, 73, 68, 65, 84, 120, 218, 99, 248, 207, 192, 240, 159, 225, 127, 131, 3, 0, 17, 57, 3, 190, 234, 237, 23, 224,
    0, 0, 0, 0, 73, 69, 78, 68, 174, 66, 96, 130};

// A folder with a small sound scene, for targets that replace one of its files.
class FuzzFolder {
 public:
  FuzzFolder() {
    write("a.obj", kQuadObj), write("a.mtl", kPlainMtl);
    write("t.png", {reinterpret_cast<const char*>(kTinyPng), sizeof kTinyPng});
  }
  std::string write(const std::string& name, std::string_view text) const { return folder_.write(name, text); }
  std::string file(const std::string& name) const { return folder_.file(name); }

 private:
  TempFolder folder_;
};

}  // namespace spanray
