// What the transparency of a material means in one frame: the material's own wish, overridden by Settings::transparency.
#pragma once
#include "frame/frame.h"

namespace spanray {

// kMask: accept(hit) cuts out where map_d times opacity < 1/2. kScreenDoor: accept(hit) by a threshold pattern. kAlpha: blended.
//   kScene       as the material says
//   kNone        opaque, but cut-outs (map_d) stay: they are shape, not translucency
//   kAlpha       screen-door and partly opaque materials are blended; cut-outs of full opacity stay
//   kScreenDoor  likewise, with the pattern
// A material of full opacity without map_d is opaque under all of them.
inline MaterialTransparency effective_transparency(const Material& material, const Settings& settings) {
  const bool has_map = material.map_opacity >= 0, partial = material.opacity < 1.0f;
  if (!has_map && !partial) return MaterialTransparency::kOpaque;
  const auto own = static_cast<MaterialTransparency>(material.transparency);
  const bool translucent = own == MaterialTransparency::kAlpha || own == MaterialTransparency::kScreenDoor || partial;
  switch (settings.transparency) {
    case Transparency::kNone: return has_map ? MaterialTransparency::kMask : MaterialTransparency::kOpaque;
    case Transparency::kAlpha: return translucent ? MaterialTransparency::kAlpha : own;
    case Transparency::kScreenDoor: return translucent ? MaterialTransparency::kScreenDoor : own;
    case Transparency::kScene: break;
  }
  return own;
}

// MaterialFlags of a material: what fills Frame::material_flags.
inline uint32_t material_flags(const Material& material, const Settings& settings) {
  uint32_t flags = material.map_bump >= 0 || material.map_normal >= 0 ? kMaterialMapped | kMaterialBumped : 0u;
  for (const int32_t map : {material.map_ambient, material.map_diffuse, material.map_specular, material.map_shininess,
                            material.map_emission, material.map_opacity})
    if (map >= 0) flags |= kMaterialMapped;
  switch (effective_transparency(material, settings)) {
    case MaterialTransparency::kOpaque: break;
    case MaterialTransparency::kMask:
    case MaterialTransparency::kScreenDoor: return flags | kMaterialMasked;
    case MaterialTransparency::kAlpha: return flags | kMaterialTranslucent;
  }
  return flags;
}

}  // namespace spanray
