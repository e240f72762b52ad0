// GLM's vectors as storage, and the few operations on them that reach pixels, written out so that their order of
// operations is ours (docs/decisions/0001-lanes.md). GLM's trigonometry and normalize are not used in the engine.
#pragma once
#define GLM_FORCE_PURE
#define GLM_FORCE_XYZW_ONLY
#include <cmath>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace spanray {

template <class T> T dot3(const glm::vec<3, T>& a, const glm::vec<3, T>& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
template <class T> glm::vec<3, T> cross3(const glm::vec<3, T>& a, const glm::vec<3, T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T> T length3(const glm::vec<3, T>& a) { return std::sqrt(dot3(a, a)); }
// Unit vector along a, or `fallback` where a is zero or not finite.
template <class T> glm::vec<3, T> normalize3(const glm::vec<3, T>& a, const glm::vec<3, T>& fallback) {
  const T length = length3(a);
  if (!(length > T(0)) || !std::isfinite(length)) return fallback;
  return {a.x / length, a.y / length, a.z / length};
}

}  // namespace spanray
