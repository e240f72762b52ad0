// What a written picture says about itself, and hashes of what it shows.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "core/hash.h"
#include "job.h"
#include "spanray/image.h"
#include "spanray/stats.h"
#include "view.h"

namespace spanray::demo {

// Keys of the tEXt chunks; `compare` looks at the contract and the scene.
inline constexpr const char* kTextVersion = "spanray";
inline constexpr const char* kTextContract = "numeric_contract";
inline constexpr const char* kTextScene = "scene_hash";
inline constexpr const char* kTextCamera = "camera";
inline constexpr const char* kTextSettings = "settings";
inline constexpr const char* kTextView = "view";

inline std::vector<std::pair<std::string, std::string>> picture_text(const Job& job, View view = View::kColor) {
  std::string settings;
  for (const auto& [key, value] : settings_words(job.settings)) settings += (settings.empty() ? "" : " ") + key + "=" + value;
  return {{kTextVersion, SPANRAY_VERSION},
          {kTextContract, std::to_string(kNumericContract)},
          {kTextScene, hash_text(job.scene.hash())},
          {kTextCamera, camera_text(job.camera)},
          {kTextSettings, settings},
          {kTextView, view_text(view)}};
}

// Of width, height and the primitive of every pixel.
inline uint64_t hash_ids(const Framebuffer& picture) {
  Hash hash;
  hash.add_word(static_cast<uint64_t>(picture.color.width)).add_word(static_cast<uint64_t>(picture.color.height));
  return hash.add(picture.primitive.data(), picture.primitive.size() * sizeof(uint32_t)).value();
}

}  // namespace spanray::demo
