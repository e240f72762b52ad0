// Our scene as OpenGL wants it: the same vertices, one index list, a batch for each run of triangles of one material.
#pragma once
#include <cstdint>
#include <vector>

#include "scene/scene_data.h"

namespace spanray::peers {

// Of the triangle that a vertex provokes (OpenGL's `flat`: its last vertex).
struct GlFace { float normal[3], centroid[3], tangent_u[3], tangent_v[3]; };  // tangents: unit, along growing u and v, else 0

struct GlBatch { uint32_t first, count, material; };  // of indices

struct GlMesh {
  std::vector<Vertex> vertices;
  std::vector<GlFace> faces;  // one a vertex where asked for, else empty
  std::vector<uint32_t> indices;
  std::vector<GlBatch> batches;
};

// Triangles keep their order where they can: of coplanar surfaces the first drawn is seen, as with us. by_normals: triangles wind counter-clockwise about the sum of their corner
// normals whatever the file says, so that gl_FrontFacing is the side to which our engine turns normals; else as in the file,
// as culling wants it. with_faces: each triangle gets a last vertex of its own (duplicated where none is free) that knows its face.
GlMesh make_gl_mesh(const SceneData& scene, bool by_normals, bool with_faces);

}  // namespace spanray::peers
