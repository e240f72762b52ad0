// A room with all that paths can meet, for tests of how they are traced.
#pragma once
#include <cmath>
#include <vector>

#include "support/mesh_scene.h"

namespace spanray {

// A lamp in a room with a glossy block and a mirror, a layer before it, glowing and pointlike: all ways must agree.
inline constexpr const char* kRoomMaterials =
    "newmtl shiny\nKd 0.3 0.3 0.3\nKs 0.5 0.5 0.5\nNs 60\nillum 2\nnewmtl mirror\nKd 0.05 0.05 0.05\nKs 0.8 0.8 0.8\nNs "
    "300\nillum 3\n"
    "newmtl pane\nKd 0.5 0.5 0.5\nd 0.4\nillum 1\n";
class ReferencePathsRoom : public ::testing::Test {
 protected:
  Scene room() const {
    const std::string mtl = gray("wall", 0.7, 0) + gray("lamp", 0.1, 4) + kRoomMaterials;
    const std::string obj = box("wall", 1) +
                            quad("lamp", {-0.3, 0.95, -0.3}, {0.3, 0.95, -0.3}, {0.3, 0.95, 0.3}, {-0.3, 0.95, 0.3}) +
                            quad("shiny", {-0.8, -0.6, -0.5}, {-0.8, -0.6, 0.5}, {0.2, -0.7, 0.5}, {0.2, -0.7, -0.5}) +
                            quad("mirror", {0.9, -0.5, -0.5}, {0.9, -0.5, 0.5}, {0.8, 0.5, 0.5}, {0.8, 0.5, -0.5}) +
                            quad("pane", {-0.5, 0.5, -0.5}, {0.5, 0.5, -0.5}, {0.5, 0.45, 0.5}, {-0.5, 0.45, 0.5});
    return mesh_scene(folder_, mtl, obj,
                      "ambient = [0.0, 0.0, 0.0]\nbackground = [0.2, 0.2, 0.2]\n[[light]]\nkind = \"point\"\nposition = [-0.6, "
                      "0.3, 0.6]\nintensity = [0.3, 0.3, 0.3]\n");
  }
  TempFolder folder_;
  const Vec eye_{0.1, -0.1, 0.9};
  const std::vector<Vec> targets_ = {{-0.3, -0.65, 0}, {0.9, 0, 0}, {0.1, 0.5, 0}, {-0.2, -1, -0.8}};

  // Every way to trace agrees with the first within 3 standard errors, and none is too uncertain to tell anything.
  void expect_agreement(uint32_t paths, double most_uncertain) const {
    const Scene scene = room();
    for (const Vec& target : targets_) {
      std::vector<Estimate> all;
      for (const bool next_event : {true, false})
        for (const bool roulette : {true, false})
          for (const int branching : {1, 4}) {
            PathOptions options;
            options.next_event = next_event, options.russian_roulette = roulette, options.branching = branching,
            options.depth = 24;
            options.seed = all.size();
            all.push_back(estimate(scene, camera_at(eye_, target, 1), options,
                                   (next_event ? 1 : 2) * paths / static_cast<uint32_t>(branching)));
          }
      for (const Estimate& e : all) {
        EXPECT_LE(std::fabs(e.mean - all[0].mean), 3 * std::hypot(e.error, all[0].error))
            << e.mean << " +- " << e.error << " and " << all[0].mean << " +- " << all[0].error;
        EXPECT_LT(e.error, most_uncertain * e.mean);
      }
      EXPECT_LT(all[0].error * std::sqrt(0.5), all[4].error) << "next event is worth it, path for path";
    }
  }
};

}  // namespace spanray
