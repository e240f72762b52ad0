// Scenes of instances without files: parts by number, placed by maps.
#pragma once
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "scene/instance_list.h"
#include "scene/scene_builder.h"
#include "support/random_map.h"

namespace spanray {

class InstanceScene {
 public:
  // Part 0 stands where it is; the others are templates.
  void add_part(const std::vector<SoupTriangle>& triangles) {
    for (SoupTriangle t : triangles) t.object = static_cast<uint32_t>(names_.size()), soup_.push_back(t);
    names_.push_back("part " + std::to_string(names_.size() - 1));
    if (names_.size() > 2) list_.templates.push_back({names_.back(), 0});
  }
  void place(size_t part, const AffineMap& map) {
    const double (&m)[3][3] = map.linear;
    const double det = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                       m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
    list_.instances.push_back({"part " + std::to_string(part), 0, map, det < 0});
  }
  SceneData build(const std::vector<Material>& materials = {Material()}) const {
    SceneData scene = make_test_scene({}, materials);
    const auto built = build_instanced_geometry(soup_, list_, names_, scene);
    EXPECT_TRUE(built) << built.error().to_string();
    scene.part_names = names_;
    hash_scene(scene);
    return scene;
  }

 private:
  std::vector<std::string> names_ = {""};
  std::vector<SoupTriangle> soup_;
  InstanceList list_;
};

}  // namespace spanray
