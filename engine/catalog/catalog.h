// The catalog: formulas for reflectance, lights, shading and transparency, one a file (catalog.cmake collects them), and their names.
// A reflectance model or a light is named by its index: Material::reflectance, Light::kind.
#pragma once
#include <limits>
#include <string_view>

#define SPANRAY_FORMULA inline __attribute__((always_inline))

namespace spanray {

inline constexpr float kInfinity = std::numeric_limits<float>::infinity();

enum class CatalogKind { kReflectance, kLights, kShading, kTransparency };

// Number of formulas of a kind; their indices are 0 to count - 1.
int catalog_count(CatalogKind kind);
// File name without extension, e.g. "blinn_phong"; empty if there is no such index.
std::string_view catalog_name(CatalogKind kind, int index);
// -1 if there is no such name.
int catalog_index(CatalogKind kind, std::string_view name);

}  // namespace spanray
