#include "render/plan.h"

#include <algorithm>

#include "core/counted.h"
#include "frame/transparency.h"

namespace spanray {
namespace {

// How many used materials ask for what, settings not yet considered.
struct Wants {
  int masked = 0, translucent = 0, mirror = 0, textured = 0, bumped = 0, emissive = 0, ambient = 0, specular = 0;
  uint32_t maps = 0;
};

bool nonzero(const float* rgb) { return rgb[0] > 0 || rgb[1] > 0 || rgb[2] > 0; }

uint32_t maps_of(const Material& m) {
  const auto bit = [](bool has, MaterialMaps map) { return has ? uint32_t{map} : 0u; };
  return bit(m.map_ambient >= 0, kMapAmbient) | bit(m.map_diffuse >= 0, kMapDiffuse) |
         bit(m.map_specular >= 0, kMapSpecular) | bit(m.map_shininess >= 0, kMapShininess) | bit(m.map_emission >= 0, kMapEmission) |
         bit(m.map_opacity >= 0, kMapOpacity);
}

Wants find_wants(const SceneData& scene, const SceneUse& use, const std::vector<uint32_t>& material_flags) {
  Wants w;
  for (size_t i = 0; i < scene.materials.size(); ++i) {
    if (!use.material_used[i]) continue;
    const Material& m = scene.materials[i];
    w.masked += (material_flags[i] & kMaterialMasked) != 0;
    w.translucent += (material_flags[i] & kMaterialTranslucent) != 0;
    // Translucent surfaces start no mirror rays (docs/decisions/0003-transparency.md).
    w.mirror += nonzero(m.mirror) && (material_flags[i] & kMaterialTranslucent) == 0;
    w.maps |= maps_of(m);
    w.textured += maps_of(m) != 0;
    w.bumped += m.map_bump >= 0 || m.map_normal >= 0;
    w.emissive += nonzero(m.emission);
    w.ambient += nonzero(m.ambient);
    w.specular += nonzero(m.specular);
  }
  return w;
}

std::string materials_text(int n, const std::string& what) {
  return counted(static_cast<uint64_t>(n), "material ", "materials ") + what;
}

class Lines {
 public:
  explicit Lines(std::vector<PlanLine>& lines) : lines_(lines) {}
  // needed = enabled by the settings and wanted by the scene; the reason names whichever decides.
  bool add(const char* stage, bool enabled, const char* disabled_reason, int wanted, const std::string& yes, const char* no) {
    const bool needed = enabled && wanted > 0;
    lines_.push_back({stage, needed, !enabled ? disabled_reason : wanted > 0 ? yes : no});
    return needed;
  }

 private:
  std::vector<PlanLine>& lines_;
};

bool is_smooth(const SceneData& scene, const Triangle& t) {
  const auto normal = [&](int corner) { return scene.vertices[t.vertex[corner]].normal; };
  return !std::equal(normal(0), normal(0) + 3, normal(1)) || !std::equal(normal(0), normal(0) + 3, normal(2));
}

}  // namespace

SceneUse find_scene_use(const SceneData& scene) {
  SceneUse use;
  use.material_used.assign(scene.materials.size(), false);
  use.any_surface = !scene.triangles.empty() || scene.has_exact();
  for (const Sphere& s : scene.spheres) use.material_used[s.material] = true;
  for (const Plane& p : scene.planes) use.material_used[p.material] = true;
  for (const Triangle& t : scene.triangles) use.material_used[material_of(t)] = true;
  use.any_smooth = std::any_of(scene.triangles.begin(), scene.triangles.end(),
                               [&](const Triangle& t) { return is_smooth(scene, t); });
  return use;
}

Plan make_plan(const SceneData& scene, const SceneUse& use, const Settings& s) {
  Plan plan;
  plan.material_flags.reserve(scene.materials.size());
  for (const Material& m : scene.materials) plan.material_flags.push_back(material_flags(m, s));
  const Wants w = find_wants(scene, use, plan.material_flags);
  const int lights = static_cast<int>(scene.lights.size());
  const bool lit = lights > 0 && use.any_surface;
  const bool raster = s.visibility == Visibility::kRaster;
  PlanFlags& f = plan.flags;
  Lines lines(plan.lines);

  uint64_t moving = 0;
  for (const MovingRun& run : scene.moving_triangles) moving += run.count;
  const int parts = static_cast<int>(scene.motions.size());
  f.motion = lines.add("pose", true, "", parts, counted(static_cast<uint64_t>(parts), "moving part", "moving parts") + " with " + counted(moving, "triangle", "triangles"),
                       "nothing moves");
  if (!scene.spheres.empty())
    lines.add("spheres", true, "", 1,
              counted(scene.spheres.size(), "sphere", "spheres") + ": exact rays within bounds on the screen", "");
  if (!scene.planes.empty())
    lines.add("planes", true, "", 1, counted(scene.planes.size(), "plane", "planes") + ": exact rays up to the horizon", "");
  f.raster = lines.add("transform, clip, bin, raster", raster, "visibility is by rays", use.any_surface,
                       "visibility is by rasterization", "the scene has no triangle");
  f.primary_rays = lines.add("primary rays", !raster, "visibility is by rasterization", use.any_surface, "visibility is by rays",
                             "the scene has no triangle");
  const std::string shaded_once = s.antialiasing == Antialiasing::kSupersample ? ", each shaded" : ", shaded once a surface";
  f.samples = lines.add("anti-aliasing", s.samples > 1, "one sample a pixel", use.any_surface,
                        std::to_string(s.samples) + " samples a pixel" + shaded_once, "the scene has no triangle");
  const bool each_shaded = s.samples > 1 && s.antialiasing == Antialiasing::kSupersample;
  f.coarse_quads = lines.add("shading rate 2x2", s.shading_rate == ShadingRate::k2x2 && !each_shaded,
                             each_shaded ? "every sample is shaded" : "every pixel is shaded", use.any_surface,
                             "squares of 2 x 2 pixels that see one surface are shaded once", "the scene has no triangle");
  f.masks = lines.add("accept masks", true, "", w.masked, materials_text(w.masked, "masked: alpha mask or screen-door"),
                      "no material is masked");
  f.lit_vertices = lines.add("lit vertices", s.shading == Shading::kGouraud, "shading is not Gouraud", lit,
                             "Gouraud shading: corners of visible triangles are lit, whatever the number of pixels", "nothing is lit");
  f.maps = w.maps;
  f.raw_normals = lines.add("normals as interpolated", s.normals == Normals::kInterpolated && s.shading == Shading::kPhong,
                            s.shading == Shading::kPhong ? "normals are made unit vectors"
                                                         : "only Phong shading interpolates normals",
                            use.any_smooth, "normals between corners are shorter than 1", "each triangle has one normal");
  f.textures = lines.add("textures", s.textures, "switched off", w.textured, materials_text(w.textured, "with color or value maps"),
                         "no material has one");
  f.bump = lines.add("bump", s.bump && s.shading == Shading::kPhong, s.bump ? "only Phong shading bends normals" : "switched off",
                     w.bumped, materials_text(w.bumped, "with a height or normal map"), "no material has one");
  f.ambient = lines.add("ambient", true, "", nonzero(scene.ambient_radiance) ? w.ambient : 0, "the scene has ambient light",
                        "no ambient light, or no material that reflects it");
  f.emission = lines.add("emission", true, "", w.emissive, materials_text(w.emissive, w.emissive == 1 ? "that emits" : "that emit"), "no material emits");
  lines.add("direct light", true, "", lit ? lights : 0, counted(static_cast<uint64_t>(lights), "light", "lights"),
            lights == 0 ? "the scene has no light" : "the scene has no triangle");
  f.specular = lines.add("specular", true, "", lit ? w.specular : 0, materials_text(w.specular, "with a highlight"),
                         "no lit material has a highlight");
  lines.add("fast powers", s.powers == Powers::kFast, "powers are exact", lit ? w.specular : 0,
            "highlights take powers of 9 bits", "no lit material has a highlight");
  f.shadow_rays = lines.add("shadow rays", s.shadows == Shadows::kRay, "switched off", lit,
                            "every light casts ray-traced shadows", "nothing is lit");
  const bool fixed = parts == 0 && !scene.light_follows_eye;
  f.light_grids = lines.add("light grids", f.shadow_rays && s.light_grids != LightGridUse::kNever, f.shadow_rays ? "switched off" : "no shadow ray is traced", fixed,
                            std::string("shadow rays meet only what stands between a part of the scene and a light, if trees have one level") +
                                (s.light_grids == LightGridUse::kAuto ? "; from the second frame on" : ""),
                            parts > 0 ? "something moves" : "the light follows the eye");
  const bool lifted = s.shadow_terminator == ShadowTerminator::kLifted;
  f.lifted_rays = lines.add("lifted shadow rays", lifted && s.shading != Shading::kFlat,
                            lifted ? "flat shading interpolates no normals" : "switched off", lit && use.any_smooth,
                            "where coarse triangles have interpolated normals, light is looked for from above them as well",
                            lit ? "each triangle has one normal" : "nothing is lit");
  f.bounces = lines.add("bounce rays", s.reflections == Reflections::kRay && s.max_bounces > 0, "switched off", w.mirror,
                        materials_text(w.mirror, "mirrored, up to " + counted(static_cast<uint64_t>(s.max_bounces), "bounce", "bounces")),
                        "no material mirrors");
  f.translucents = lines.add("composite", true, "", w.translucent, materials_text(w.translucent, "blended by alpha"),
                             "no material is translucent");
  f.bvh = lines.add("BVH", f.shadow_rays || f.bounces || f.primary_rays, "no ray is traced", use.any_surface, "rays are traced",
                    "the scene has no triangle");
  lines.add("BVH refit", f.bvh, "no ray is traced", parts, "trees follow the moving parts: boxes anew each frame, built anew where that grew too costly",
            "nothing moves");
  f.translucent_bvh = lines.add("translucent BVH", f.translucents, "no material is translucent", f.bounces || f.primary_rays,
                                "rays see translucent surfaces", "only the rasterizer sees translucent surfaces");
  return plan;
}

void leave_out_unread(const FrameRequest& request, const SceneData& scene, Shading shading, PlanFlags& plan) {
  const bool all = request.ladder != nullptr;
  plan.depths = all || plan.translucents || request.depth;
  plan.weights = all || (plan.lit_vertices && plan.bounces) || plan.lifted_rays || request.uv;
  plan.views = all || plan.bounces || shading == Shading::kPhong || scene.has_exact();
  plan.normals = plan.views || request.normal;
  plan.surfaces = all || request.normal || request.uv;
}

}  // namespace spanray
