// The shipped scenes, each a mesh with its materials, lights and cameras.
#pragma once
#include <map>
#include <string>

#include "obj_mesh.h"
#include "picture.h"

namespace spanray::assets {

struct SceneFiles {
  ObjMesh mesh;
  std::string mtl, toml;
};

SceneFiles make_cornell();
SceneFiles make_spheres();
SceneFiles make_columns();
SceneFiles make_gauze();
SceneFiles make_glass();
SceneFiles make_molecule();
SceneFiles make_orrery();
SceneFiles make_dahlia();
SceneFiles make_henge();

// The gallery hall with about `triangles` (within 20 %; 10 thousand to 10 million).
inline constexpr double kHallTriangles = 80e3;  // as shipped
SceneFiles make_hall(double triangles = kHallTriangles);

// By name, without extension; and the textures by path, relative to the folder of the scenes.
std::map<std::string, SceneFiles> make_scenes();
std::map<std::string, Picture> make_textures();

// Writes NAME.obj, NAME.mtl, NAME.toml and textures/ into a folder, made if need be: all scenes, or the hall alone with about
// this many triangles.
Result<void> write_assets(const std::string& folder);
Result<void> write_hall(const std::string& folder, double triangles);

}  // namespace spanray::assets
