// The GLSL program: the formulas of engine/catalog and engine/shade as a user of OpenGL would write them.
#pragma once
#include <cstdint>

#include "gl.h"
#include "scene/scene_data.h"
#include "spanray/result.h"

namespace spanray::peers {

// What a material needs: one program a combination, so that nobody pays for what it does not use.
enum GlFeature : uint32_t {
  kTextured = 1,    // map_Kd
  kMasked = 2,      // map_d: discard
  kHighlight = 4,   // Ks is not zero
  kMovedUv = 8,     // -o, -s or -mm
  kBumped = 16,     // map_bump, Phong only
};

// How near to our engine the program must be; each step costs time (docs/peers.md).
struct GlExactness {
  bool offset = false;       // later materials lie a hair behind earlier ones, so that coplanar surfaces do not fight
  bool horizon = false;      // light that does not reach the geometric normal is left out, as our engine does
  bool own_lod = false;      // our level-of-detail formula in the shader instead of the driver's
  bool shader_srgb = false;  // sRGB encoding in the shader instead of the driver's
};

struct GlStyle {
  Shading shading = Shading::kPhong;
  bool two_sided = true;
  bool blend_levels = true;  // height maps: of two levels, as trilinear filtering does
  GlExactness exactness;
};

// Compiles the program for materials with these features and the scene's lights. Errors: the compiler's log.
Result<GLuint> make_program(const SceneData& scene, const GlStyle& style, uint32_t features);

}  // namespace spanray::peers
