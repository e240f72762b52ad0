// A little mesh with materials that ask for most stages: floor, mirror, a pane of glass, a textured-free box corner.
#pragma once
#include <string>

#include "support/temp_folder.h"

namespace spanray {

// Writes room.obj and room.mtl; returns the path of the mesh.
inline std::string write_small_scene(const TempFolder& folder) {
  folder.write("room.mtl",
               "newmtl floor\nKd 0.7 0.6 0.5\nillum 1\n"
               "newmtl mirror\nKd 0.1 0.1 0.1\nKs 0.8 0.8 0.8\nNs 50\nillum 3\n"
               "newmtl glass\nKd 0.2 0.8 0.3\nd 0.4\nillum 2\n"
               "newmtl red\nKd 0.8 0.1 0.1\nKs 0.3 0.3 0.3\nNs 20\nillum 2\n");
  return folder.write("room.obj",
                      "mtllib room.mtl\n"
                      "v -2 0 -2\nv 2 0 -2\nv 2 0 2\nv -2 0 2\n"              // floor
                      "v -2 0 -2\nv 2 0 -2\nv 2 2 -2\nv -2 2 -2\n"            // mirror
                      "v -1.5 0 1\nv 0 0 1\nv 0 1.2 1\nv -1.5 1.2 1\n"        // glass
                      "v 0.3 0 -0.5\nv 1.2 0 -0.2\nv 0.7 1.4 -0.4\nv 0.6 0.2 0.6\n"  // red tetrahedron
                      "usemtl floor\nf 1 4 3 2\n"
                      "usemtl mirror\nf 5 6 7 8\n"
                      "usemtl glass\nf 9 10 11 12\n"
                      "usemtl red\nf 13 15 14\nf 13 14 16\nf 14 15 16\nf 15 13 16\n");
}

inline constexpr const char* kSmallSceneCamera = "0.5,1.5,4.5,0,0.6,0,50";

}  // namespace spanray
