// A scene of instances gives the picture of the same scene written out as one mesh, whatever tree rays go through.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "image/metrics.h"
#include "math/vec.h"
#include "scene/scene_data.h"
#include "spanray/render.h"
#include "support/bvh_oracle.h"
#include "support/scene_files.h"

namespace spanray {
namespace {

constexpr const char* kMtl = "newmtl floor\nKd 0.7 0.6 0.5\nillum 1\n"
                             "newmtl red\nKd 0.8 0.2 0.1\nKs 0.4 0.4 0.4\nNs 30\nillum 2\n"
                             "newmtl glass\nKd 0.2 0.7 0.5\nd 0.4\nillum 2\n"
                             "newmtl mirror\nKd 0.1 0.1 0.1\nKs 0.8 0.8 0.8\nNs 50\nillum 3\n";
constexpr const char* kView = "ambient = [0.1, 0.1, 0.12]\n[[camera]]\neye = [0.4, 2.6, 5.2]\ntarget = [0, 0.5, 0]\nfov_y = 55\nnear = 0.01\n"
                              "[[light]]\nkind = \"point\"\nposition = [1.5, 4, 2]\nintensity = [20, 18, 16]\n"
                              "[[light]]\nkind = \"directional\"\ndirection = [0.6, -1, -0.4]\nintensity = [1, 1, 1.2]\n";
constexpr const char* kFloor = "o room\nusemtl floor\nv -4 0 -4\nv -4 0 4\nv 4 0 4\nv 4 0 -4\nvn 0 1 0\nf -4//-1 -3//-1 -2//-1 -1//-1\n"
                               "usemtl mirror\nv -4 0 -4\nv 4 0 -4\nv 4 3 -4.2\nv -4 3 -4.2\nvn 0 0.0665190 0.997785\nf -4//-1 -3//-1 -2//-1 -1//-1\n";

struct Part {
  IndexedMesh mesh;  // of a unit sphere: a vertex is its own normal
  std::vector<const char*> material;  // of each triangle
};
Part make_part() {
  Part part{make_sphere(2), {}};
  for (size_t i = 0; i < part.mesh.triangles.size(); ++i) part.material.push_back(i % 40 < 20 ? "red" : i % 40 < 30 ? "glass" : "mirror");
  return part;
}

std::string line(const char* word, const glm::dvec3& v) {
  char text[96];
  std::snprintf(text, sizeof text, "%s %.9g %.9g %.9g\n", word, v.x, v.y, v.z);
  return text;
}
// Not inlined: GCC 12 vectorises such a round trip away (bug of its SLP pass at -O2 and -O3).
[[gnu::noinline]] float to_float(double x) { return static_cast<float>(x); }
glm::dvec3 rounded(const glm::dvec3& v) { return {to_float(v.x), to_float(v.y), to_float(v.z)}; }

// The part through a map, as an OBJ's text.
std::string written(const Part& part, const AffineMap& map) {
  const glm::dvec3 row[3] = {{map.linear[0][0], map.linear[0][1], map.linear[0][2]}, {map.linear[1][0], map.linear[1][1], map.linear[1][2]},
                             {map.linear[2][0], map.linear[2][1], map.linear[2][2]}};
  const double det = dot3(row[0], cross3(row[1], row[2]));
  std::string text;
  for (const glm::dvec3& v : part.mesh.vertices) {
    const glm::dvec3 p = rounded(v), n = normalize3(p, p);
    glm::dvec3 at, normal;
    for (int k = 0; k < 3; ++k) {
      at[k] = (row[k].x * p.x + row[k].y * p.y + row[k].z * p.z) + map.offset[k];
      normal[k] = dot3(cross3(row[(k + 1) % 3], row[(k + 2) % 3]), rounded(n)) / det;
    }
    text += line("v", rounded(at)) + line("vn", rounded(normalize3(normal, normal)));
  }
  const int count = static_cast<int>(part.mesh.vertices.size());
  for (size_t i = 0; i < part.mesh.triangles.size(); ++i) {
    glm::ivec3 t = part.mesh.triangles[i] - count;
    if (det < 0) std::swap(t.y, t.z);
    char face[96];
    std::snprintf(face, sizeof face, "usemtl %s\nf %d//%d %d//%d %d//%d\n", part.material[i], t.x, t.x, t.y, t.y, t.z, t.z);
    text += face;
  }
  return text;
}

std::string instances_toml() {
  std::string text = "[[template]]\npart = \"ball\"\n";
  for (int i = 0; i < 9; ++i) {
    char one[300];
    std::snprintf(one, sizeof one, "[[instance]]\npart = \"ball\"\ntranslate = [%g, %g, %g]\naxis = [%d, 1, %d]\ndegrees = %d\nscale = %s\n", (i % 3 - 1) * 1.7, 0.5 + 0.2 * i,
                  (i / 3 - 1) * 1.5, i, i % 2, 50 * i, i % 3 == 0 ? "[0.5, 0.7, -0.4]" : i % 3 == 1 ? "0.6" : "-0.5");
    text += one;
  }
  return text;
}

struct Picture {
  Framebuffer frame;
  FrameStats stats;
};
Picture render(const Scene& scene, const Settings& settings) {
  Renderer renderer;
  FrameRequest request;
  request.depth = request.primitive = request.radiance = request.normal = true;
  Picture p;
  const auto stats = renderer.render(scene, scene.cameras()[0], settings, p.frame, request);
  EXPECT_TRUE(stats) << stats.error().to_string();
  if (stats) p.stats = stats.value();
  return p;
}

class RenderInstance : public testing::Test {
 protected:
  RenderInstance() {
    folder_.write("a.mtl", kMtl);
    const std::string head = std::string("mtllib a.mtl\n") + kFloor;
    folder_.write("a.obj", head + "o ball\n" + written(part_, AffineMap()));
    instanced_ = must_load(folder_.write("a.toml", std::string("obj = \"a.obj\"\n") + kView + instances_toml()));
    std::string plain = head;
    for (const Instance& i : instanced_.scene().instances) plain += "o ball\n" + written(part_, i.world_from_part);
    folder_.write("b.obj", plain);
    plain_ = must_load(folder_.write("b.toml", std::string("obj = \"b.obj\"\n") + kView));
  }
  TempFolder folder_;
  Part part_ = make_part();
  Loaded instanced_, plain_;
};

TEST_F(RenderInstance, TheSceneIsThatOfTheMeshWrittenOut) {
  const SceneData &a = instanced_.scene(), &b = plain_.scene();
  ASSERT_EQ(a.instances.size(), 9u);
  ASSERT_EQ(a.triangles.size(), b.triangles.size());
  for (size_t t = 0; t < a.triangles.size(); ++t) {
    EXPECT_EQ(a.triangles[t].bits, b.triangles[t].bits) << t;
    for (int v = 0; v < 3; ++v) {
      const Vertex &x = a.vertices[a.triangles[t].vertex[v]], &y = b.vertices[b.triangles[t].vertex[v]];
      for (int k = 0; k < 3; ++k) EXPECT_EQ(x.position[k], y.position[k]) << t;
      for (int k = 0; k < 3; ++k) EXPECT_EQ(x.normal[k], y.normal[k]) << t;
    }
  }
}

TEST_F(RenderInstance, OnePictureByEither) {
  for (const Visibility visibility : {Visibility::kRaster, Visibility::kRay})
    for (const Shading shading : {Shading::kPhong, Shading::kGouraud})
      for (const Culling culling : {Culling::kNone, Culling::kBack}) {
        Settings s;
        s.width = 160, s.height = 120, s.threads = 2, s.visibility = visibility, s.shading = shading, s.culling = culling, s.shadows = Shadows::kRay;
        const Picture a = render(instanced_.loaded.scene, s), b = render(plain_.loaded.scene, s);
        EXPECT_EQ(a.frame.color.rgba, b.frame.color.rgba);
        EXPECT_EQ(a.frame.depth, b.frame.depth);
        EXPECT_EQ(a.frame.radiance, b.frame.radiance);
        EXPECT_EQ(a.frame.primitive, b.frame.primitive);
      }
}

// Enough copies that rays go down a tree of two levels (InstanceUse::kAuto), and the same scene whose instances nobody told of.
TEST(RenderInstances, OnePictureByATreeOfTwoLevelsAndByOne) {
  TempFolder folder;
  Part part{make_sphere(5), {}};
  for (size_t i = 0; i < part.mesh.triangles.size(); ++i) part.material.push_back(i % 40 < 30 ? "red" : "mirror");
  folder.write("a.mtl", kMtl);
  folder.write("a.obj", std::string("mtllib a.mtl\n") + kFloor + "o ball\n" + written(part, AffineMap()));
  std::string toml = std::string("obj = \"a.obj\"\n") + kView + "[[template]]\npart = \"ball\"\n";
  for (int i = 0; i < 216; ++i) {
    char one[200];
    std::snprintf(one, sizeof one, "[[instance]]\npart = \"ball\"\ntranslate = [%g, %g, %g]\naxis = [%d, 1, 2]\ndegrees = %d\nscale = %s\n", (i % 6 - 2.5) * 0.7,
                  0.3 + 0.5 * (i / 36), (i / 6 % 6 - 3.5) * 0.7, i % 5, 50 * i, i % 2 == 0 ? "0.3" : "[-0.25, 0.2, 0.3]");
    toml += one;
  }
  const std::string path = folder.write("a.toml", toml);
  const Loaded instanced = must_load(path), flat = must_load(path);
  const_cast<SceneData&>(flat.scene()).instances.clear();
  Settings s;
  s.width = 160, s.height = 120, s.threads = 2, s.visibility = Visibility::kRay, s.shadows = Shadows::kRay, s.reflections = Reflections::kRay;
  const Picture a = render(instanced.loaded.scene, s), b = render(flat.loaded.scene, s);
  EXPECT_EQ(a.frame.color.rgba, b.frame.color.rgba);
  EXPECT_EQ(a.frame.depth, b.frame.depth);
  EXPECT_EQ(a.frame.radiance, b.frame.radiance);
  EXPECT_EQ(a.frame.primitive, b.frame.primitive);
  EXPECT_LT(a.stats.memory_bytes + (100u << 20), b.stats.memory_bytes) << "one of them has a tree of two levels";
}

}  // namespace
}  // namespace spanray
