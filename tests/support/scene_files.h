// Scenes written by a test into a temporary folder, and what came of loading them.
#pragma once
#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

#include "scene/scene_data.h"
#include "spanray/scene.h"
#include "support/temp_folder.h"

namespace spanray {

struct Loaded {
  LoadedScene loaded;
  const SceneData& scene() const { return loaded.scene.data(); }
  // The number of messages that contain all of these texts.
  int count(std::initializer_list<const char*> parts) const {
    int n = 0;
    for (const std::string& m : loaded.messages) {
      bool all = true;
      for (const char* part : parts) all = all && m.find(part) != std::string::npos;
      n += all ? 1 : 0;
    }
    return n;
  }
  std::string all_messages() const {
    std::string text;
    for (const std::string& m : loaded.messages) text += m + "\n";
    return text;
  }
};

// Loads a scene that must load; the test fails with the error otherwise.
inline Loaded must_load(const std::string& path, const LoadOptions& options = {}) {
  Result<LoadedScene> result = load_scene(path, options);
  if (result) return {result.value()};
  ADD_FAILURE() << result.error().to_string();
  return {LoadedScene{Scene(std::make_shared<SceneData>()), {}}};
}

// The error of a scene that must not load; empty, with a failed test, otherwise.
inline Error must_fail(const std::string& path, const LoadOptions& options = {}) {
  Result<LoadedScene> result = load_scene(path, options);
  if (!result) return result.error();
  ADD_FAILURE() << path << " loaded";
  return {};
}

// Position of corner `which` (0 to 2) of a triangle in the file's winding, starting at the canonical first vertex.
inline const Vertex& corner(const SceneData& scene, size_t triangle, int which) {
  const Triangle& t = scene.triangles[triangle];
  const bool flipped = (t.bits & kTriangleFlipped) != 0;
  return scene.vertices[t.vertex[flipped && which > 0 ? 3 - which : which]];
}

}  // namespace spanray
