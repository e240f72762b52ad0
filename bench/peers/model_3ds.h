// The one mesh of a 3D Studio file, as glmark2 ships its models.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "spanray/result.h"

namespace spanray::peers {

struct Model3ds {
  std::vector<std::array<float, 3>> positions, normals;  // normals: unit, mean of the faces around a vertex, weighted by area
  std::vector<std::array<uint16_t, 3>> faces;
};

// Reads vertices and faces of the first mesh; all else is passed over.
// Source:   the chunks of 3DS: 16 bits kind, 32 bits length with these six bytes, little endian; 4D4D > 3D3D > 4000 > 4100 > 4110, 4120.
// Errors:   a file that cannot be read, ends early, or has no such mesh; a face that names a vertex that is not there.
Result<Model3ds> read_3ds(const std::string& path);

}  // namespace spanray::peers
