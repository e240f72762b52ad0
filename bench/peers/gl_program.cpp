#include "gl_program.h"

#include <string>

namespace spanray::peers {
namespace {

// Blinn-Phong as in catalog/reflectance/blinn_phong.inl and catalog/lights; 1/pi stands in uIntensity. ALL_LIGHTS is a line
// ADD_LIGHT(index, direction to the light, falloff) for each light; what it does with them depends on where it stands.
// Without branches: masked ones cost llvmpipe more.
const char* const kLighting = R"(
uniform vec3 uEye, uPosition[LIGHTS], uDirection[LIGHTS], uFalloff[LIGHTS], uIntensity[LIGHTS];
uniform float uShininess;
float highlight(vec3 n, vec3 l, vec3 v) { return HIGHLIGHT ? pow(max(dot(n, normalize(l + v)), 0.0), uShininess) : 0.0; }
// Sums over the lights, to be multiplied by Kd and Ks. reach: a bit a light, set where the face is turned to it.
#define ADD_LIGHT(i, l, falloff) { float nl = dot(n, l), e = nl > 0.0 && REACHES(i) ? falloff : 0.0; \
  diffuse += uIntensity[i] * (nl * e); specular += uIntensity[i] * (highlight(n, l, v) * e); }
#if HORIZON
#define REACHES(i) ((reach & (1u << i)) != 0u)
#else
#define REACHES(i) true
#endif
void light(vec3 p, vec3 n, uint reach, out vec3 diffuse, out vec3 specular) {
  diffuse = vec3(0.0); specular = vec3(0.0);
  vec3 v = normalize(uEye - p);
  ALL_LIGHTS
}
#undef ADD_LIGHT
)";

const char* const kVertexShader = R"(
layout(location = 0) in vec3 aPosition; layout(location = 1) in vec3 aNormal; layout(location = 2) in vec2 aUv;
layout(location = 3) in vec3 aFaceNormal; layout(location = 4) in vec3 aCentroid;
layout(location = 5) in vec3 aTangentU; layout(location = 6) in vec3 aTangentV;
uniform mat4 uClipFromWorld;
uniform float uNearer;
#if WITH_UV
out vec2 vUv;
#endif
#if BUMPED
flat out vec3 vTangentU, vTangentV, vFaceNormal;
#endif
#if HORIZON
// What lies on a face is turned to a light as its centroid is: of the front, and of the back.
flat out uvec2 vReach;
#define ADD_LIGHT(i, l, falloff) { float side = dot(n, l); if (side > 0.0) reach.x |= 1u << i; else if (side < 0.0) reach.y |= 1u << i; }
uvec2 find_reach(vec3 p, vec3 n) { uvec2 reach = uvec2(0u); ALL_LIGHTS return reach; }
#undef ADD_LIGHT
#endif
#if PHONG
out vec3 vPosition, vNormal;
#elif PER_LIGHT
out vec4 vLight[LIGHTS];  // diffuse and specular factor of the front, of the back
#define ADD_LIGHT(i, l, falloff) { float side = dot(aNormal, l); vec3 n = side < 0.0 ? -aNormal : aNormal; \
  vec2 f = vec2(abs(side), highlight(n, l, v)) * (falloff); vLight[i] = side > 0.0 ? vec4(f, 0.0, 0.0) : vec4(0.0, 0.0, f); }
void light_corner(vec3 p, vec3 v) { ALL_LIGHTS }
#undef ADD_LIGHT
#else
INTERPOLATION out vec3 vDiffuse, vSpecular, vDiffuseBack, vSpecularBack;
#endif
void main() {
  gl_Position = uClipFromWorld * vec4(aPosition, 1.0);
#if OFFSET
  gl_Position.z *= uNearer;  // depth is near / view depth: a relative step, unlike glPolygonOffset, whose step grows with the triangle
#endif
#if WITH_UV
  vUv = vec2(aUv.x, 1.0 - aUv.y);
#endif
#if BUMPED
  vTangentU = aTangentU; vTangentV = aTangentV; vFaceNormal = aFaceNormal;
#endif
#if HORIZON
  vReach = find_reach(aCentroid, aFaceNormal);
#endif
#if PHONG
  vPosition = aPosition; vNormal = aNormal;
#elif PER_LIGHT
  light_corner(aPosition, normalize(uEye - aPosition));
#else
#if FLAT
  vec3 p = aCentroid, n = aFaceNormal;
#else
  vec3 p = aPosition, n = aNormal;
#endif
  light(p, n, ~0u, vDiffuse, vSpecular);
#if TWO_SIDED
  light(p, -n, ~0u, vDiffuseBack, vSpecularBack);
#endif
#endif
}
)";

const char* const kFragmentShader = R"(
#if PHONG
in vec3 vPosition, vNormal;
#elif PER_LIGHT
in vec4 vLight[LIGHTS];
#else
INTERPOLATION in vec3 vDiffuse, vSpecular, vDiffuseBack, vSpecularBack;
#endif
#if WITH_UV
in vec2 vUv;
#endif
#if BUMPED
flat in vec3 vTangentU, vTangentV, vFaceNormal;
#endif
#if HORIZON
flat in uvec2 vReach;
#endif
uniform vec3 uConstant, uKd, uKs;  // uConstant: Ka times the scene's ambient light
uniform vec3 uEmission;
uniform sampler2D uColor, uOpacity, uHeight;
uniform vec4 uColorUv, uOpacityUv, uHeightUv;  // scale, offset
uniform float uHeightScale;
uniform vec2 uColorRange, uOpacityRange;  // base, gain
out vec4 oColor;

// Level of detail of engine/shade/texture_use-inl.h, the measure of OpenGL 4.6, 8.14.1: the longer side of a pixel, as a length.
float own_level(sampler2D map, vec2 uv) {
  vec2 size = vec2(textureSize(map, 0)), dx = dFdx(uv) * size, dy = dFdy(uv) * size;
  return 0.5 * log2(max(dot(dx, dx), dot(dy, dy)));
}
#if OWN_LOD
vec4 fetch(sampler2D map, vec2 uv) { return textureLod(map, uv, own_level(map, uv)); }
#else
vec4 fetch(sampler2D map, vec2 uv) { return texture(map, uv); }
#endif
#if MOVED_UV
vec2 moved(vec2 uv, vec4 by) { return vec2(uv.x * by.x + by.z, 1.0 - ((1.0 - uv.y) * by.y + by.w)); }
#define COLOR max(uColorRange.x + uColorRange.y * fetch(uColor, moved(vUv, uColorUv)).rgb, vec3(0.0))
#define OPACITY (uOpacityRange.x + uOpacityRange.y * fetch(uOpacity, moved(vUv, uOpacityUv)).r)
#define HEIGHT_UV moved(vUv, uHeightUv)
#define HEIGHT_SIDE sign(uHeightUv.xy)
#else
#define COLOR fetch(uColor, vUv).rgb
#define OPACITY fetch(uOpacity, vUv).r
#define HEIGHT_UV vUv
#define HEIGHT_SIDE vec2(1.0)
#endif

#if BUMPED
// Blinn's bump mapping as in engine/shade/bump-inl.h: slopes by bilinear samples half a texel to either side, on the levels of the footprint.
vec2 slope(vec2 uv, float level) {
  vec2 a = 0.5 / vec2(textureSize(uHeight, int(level)));
  vec2 low = vec2(textureLod(uHeight, vec2(uv.x - a.x, uv.y), level).r, textureLod(uHeight, vec2(uv.x, uv.y + a.y), level).r);
  vec2 high = vec2(textureLod(uHeight, vec2(uv.x + a.x, uv.y), level).r, textureLod(uHeight, vec2(uv.x, uv.y - a.y), level).r);
  return (high - low) * exp2(-level);
}
vec3 tangent(vec3 along, vec3 n) {
  vec3 t = along - n * dot(along, n);
  return t * inversesqrt(max(dot(t, t), 1e-20));
}
vec3 bumped(vec3 n) {
  vec2 uv = HEIGHT_UV;
  float last = float(textureQueryLevels(uHeight) - 1), level = clamp(own_level(uHeight, uv), 0.0, last);
#if BLEND_LEVELS
  float first = floor(level);
  vec2 s = mix(slope(uv, first), slope(uv, min(first + 1.0, last)), level - first);
#else
  vec2 s = slope(uv, floor(level + 0.5));
#endif
  s *= uHeightScale * HEIGHT_SIDE;
  n = normalize(n - tangent(vTangentU, n) * s.x - tangent(vTangentV, n) * s.y);
#if HORIZON
  vec3 g = gl_FrontFacing ? vFaceNormal : -vFaceNormal;
  n = normalize(n + g * max(1.0 / 1024.0 - dot(n, g), 0.0));
#endif
  return n;
}
#else
vec3 bumped(vec3 n) { return n; }
#endif

vec3 encoded(vec3 c) {
  c = clamp(c, 0.0, 1.0);
  return mix(1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, 12.92 * c, lessThanEqual(c, vec3(0.0031308)));
}
void main() {
#if MASKED
  if (OPACITY < 0.5) discard;
#endif
  vec3 diffuse, specular;
  uint reach = ~0u;
#if HORIZON
  reach = gl_FrontFacing ? vReach.x : vReach.y;
#endif
#if PHONG
  light(vPosition, bumped(normalize(gl_FrontFacing ? vNormal : -vNormal)), reach, diffuse, specular);
#elif PER_LIGHT
  diffuse = specular = vec3(0.0);
  for (int i = 0; i < LIGHTS; ++i) {
    vec2 f = gl_FrontFacing ? vLight[i].xy : vLight[i].zw;
    if (!REACHES(i)) f = vec2(0.0);
    diffuse += uIntensity[i] * f.x;
    specular += uIntensity[i] * f.y;
  }
#elif TWO_SIDED
  diffuse = gl_FrontFacing ? vDiffuse : vDiffuseBack;
  specular = gl_FrontFacing ? vSpecular : vSpecularBack;
#else
  diffuse = vDiffuse; specular = vSpecular;
#endif
  vec3 radiance = uConstant + uKd * diffuse;
#if TEXTURED
  radiance *= COLOR;
#endif
  if (HIGHLIGHT) radiance += uKs * specular;
  radiance += uEmission;
#if SHADER_SRGB
  radiance = encoded(radiance);
#endif
  oColor = vec4(radiance, 1.0);
}
)";

std::string all_lights(const SceneData& scene) {
  std::string text;
  for (size_t i = 0; i < scene.lights.size(); ++i) {
    const std::string n = "[" + std::to_string(i) + "]", index = std::to_string(i);
    if (scene.lights[i].kind == static_cast<int32_t>(LightKind::kPoint)) {
      text += "{ vec3 to = uPosition" + n + " - p; float d2 = dot(to, to), inverse = inversesqrt(d2); vec3 l = to * inverse; " +
              "float falloff = 1.0 / max((uFalloff" + n + ".z * d2 + uFalloff" + n + ".y * (d2 * inverse)) + uFalloff" + n + ".x, 1e-4); " +
              "ADD_LIGHT(" + index + ", l, falloff) } ";
    } else {
      text += "{ vec3 l = -uDirection" + n + "; ADD_LIGHT(" + index + ", l, 1.0) } ";
    }
  }
  return text;
}

std::string header(const SceneData& scene, const GlStyle& style, uint32_t features) {
  std::string text = "#version 450 core\n";
  const auto define = [&](const char* name, const std::string& value) { text += std::string("#define ") + name + " " + value + "\n"; };
  const auto bit = [&](const char* name, bool on) { define(name, on ? "1" : "0"); };
  bit("PHONG", style.shading == Shading::kPhong);
  bit("FLAT", style.shading == Shading::kFlat);
  define("INTERPOLATION", style.shading == Shading::kFlat ? "flat" : "smooth");
  bit("TWO_SIDED", style.two_sided);
  bit("HORIZON", style.exactness.horizon && style.shading != Shading::kFlat);
  // Sums over the lights take twelve interpolated numbers, single lights four each.
  bit("PER_LIGHT", style.shading == Shading::kGouraud && (style.exactness.horizon || scene.lights.size() <= 3));
  bit("OFFSET", style.exactness.offset);
  bit("OWN_LOD", style.exactness.own_lod);
  bit("SHADER_SRGB", style.exactness.shader_srgb);
  bit("TEXTURED", (features & kTextured) != 0);
  bit("MASKED", (features & kMasked) != 0);
  bit("BUMPED", (features & kBumped) != 0);
  bit("WITH_UV", (features & (kTextured | kMasked | kBumped)) != 0);
  bit("BLEND_LEVELS", style.blend_levels);
  define("HIGHLIGHT", (features & kHighlight) != 0 ? "true" : "false");
  bit("MOVED_UV", (features & kMovedUv) != 0);
  define("LIGHTS", std::to_string(scene.lights.empty() ? 1 : scene.lights.size()));
  define("ALL_LIGHTS", all_lights(scene));
  return text;
}

Result<GLuint> compile(GLenum stage, const std::string& source) {
  const GLuint shader = glCreateShader(stage);
  const char* text = source.c_str();
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  GLint done = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &done);
  if (done != 0) return shader;
  char log[2048] = {};
  glGetShaderInfoLog(shader, sizeof log, nullptr, log);
  return Error{std::string("GLSL: ") + log};
}

}  // namespace

Result<GLuint> make_program(const SceneData& scene, const GlStyle& style, uint32_t features) {
  const std::string head = header(scene, style, features) + kLighting;
  const Result<GLuint> vertex = compile(GL_VERTEX_SHADER, head + kVertexShader);
  if (!vertex) return vertex.error();
  const Result<GLuint> fragment = compile(GL_FRAGMENT_SHADER, head + kFragmentShader);
  if (!fragment) return fragment.error();
  const GLuint program = glCreateProgram();
  glAttachShader(program, vertex.value());
  glAttachShader(program, fragment.value());
  glLinkProgram(program);
  glDeleteShader(vertex.value());
  glDeleteShader(fragment.value());
  GLint done = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &done);
  if (done != 0) return program;
  char log[2048] = {};
  glGetProgramInfoLog(program, sizeof log, nullptr, log);
  return Error{std::string("GLSL: ") + log};
}

}  // namespace spanray::peers
