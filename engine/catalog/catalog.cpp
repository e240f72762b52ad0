#include "catalog/catalog.h"

#include <iterator>

#include "scene/scene_data.h"

namespace spanray {
namespace {

#define SPANRAY_CATALOG_ENTRY(index, name) #name,
constexpr std::string_view kReflectanceNames[] = {
#include "catalog_reflectance_list.inc"
};
constexpr std::string_view kLightNames[] = {
#include "catalog_lights_list.inc"
};
constexpr std::string_view kShadingNames[] = {
#include "catalog_shading_list.inc"
};
constexpr std::string_view kTransparencyNames[] = {
#include "catalog_transparency_list.inc"
};
#undef SPANRAY_CATALOG_ENTRY

static_assert(kReflectanceNames[0] == "blinn_phong", "the default of Material::reflectance");
static_assert(kLightNames[static_cast<int>(LightKind::kPoint)] == "point");
static_assert(kLightNames[static_cast<int>(LightKind::kDirectional)] == "directional");

struct Names { const std::string_view* first; int count; };
Names names_of(CatalogKind kind) {
  switch (kind) {
    case CatalogKind::kReflectance: return {kReflectanceNames, static_cast<int>(std::size(kReflectanceNames))};
    case CatalogKind::kLights: return {kLightNames, static_cast<int>(std::size(kLightNames))};
    case CatalogKind::kShading: return {kShadingNames, static_cast<int>(std::size(kShadingNames))};
    case CatalogKind::kTransparency: return {kTransparencyNames, static_cast<int>(std::size(kTransparencyNames))};
  }
  return {nullptr, 0};
}

}  // namespace

int catalog_count(CatalogKind kind) { return names_of(kind).count; }

std::string_view catalog_name(CatalogKind kind, int index) {
  const Names names = names_of(kind);
  return index >= 0 && index < names.count ? names.first[index] : std::string_view();
}

int catalog_index(CatalogKind kind, std::string_view name) {
  const Names names = names_of(kind);
  for (int i = 0; i < names.count; ++i)
    if (names.first[i] == name) return i;
  return -1;
}

}  // namespace spanray
