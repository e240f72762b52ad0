#include "reference/paths.h"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "core/fp_env.h"
#include "core/parallel.h"
#include "reference/path_tracer.h"
#include "scene/pose.h"

namespace spanray {
namespace {

using reference::PathTracer;
using reference::srgb_byte;
using reference::to_dvec;

constexpr size_t kBlock = 1024;  // pixels of a task

double luminance_of(const glm::dvec3& c) { return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z; }

Result<void> check(const Scene& scene, const Settings& settings, const PathOptions& options, uint32_t paths,
                   const PathSums& sums) {
  if (!scene.valid()) return Error{"paths: there is no scene"};
  if (auto model = reference::check_model(scene.data(), settings); !model) return model;
  if (options.depth < 0 || options.depth > kMostDepth || options.branching < 1 || options.branching > kMostBranching ||
      paths > kMostPaths)
    return Error{"paths: depth, branching or number of paths is out of range"};
  const size_t pixels = static_cast<size_t>(settings.width) * static_cast<size_t>(settings.height);
  const bool fresh = sums.paths == 0 && sums.radiance.empty() && sums.square.empty();
  if (!fresh && (sums.width != settings.width || sums.height != settings.height || sums.radiance.size() != 3 * pixels ||
                 sums.square.size() != pixels))
    return Error{"paths: the sums so far belong to a picture of another size"};
  return {};
}

}  // namespace

double PathSums::luminance(size_t pixel) const {
  const double* sum = radiance.data() + 3 * pixel;
  return paths == 0 ? 0 : luminance_of({sum[0], sum[1], sum[2]}) / paths;
}

double PathSums::standard_error(size_t pixel) const {
  if (paths < 2) return std::numeric_limits<double>::infinity();
  const double n = paths, mean = luminance(pixel);
  return std::sqrt(std::max(0.0, square[pixel] / n - mean * mean) / (n - 1));
}

double PathSums::noise() const {
  double errors = 0, mean = 0;
  const size_t pixels = square.size();
  for (size_t i = 0; i < pixels; ++i) errors += standard_error(i) * standard_error(i), mean += luminance(i);
  const double n = static_cast<double>(pixels);
  return mean > 0 ? std::sqrt(errors / n) / (mean / n) : 0;
}

Result<void> trace_paths(const Scene& scene, const Camera& camera, const Settings& settings, const PathOptions& options,
                         uint32_t paths, PathSums& sums, const PathControl& control) {
  if (auto checked = check(scene, settings, options, paths, sums); !checked) return checked;
  const FpEnvGuard guard;
  const Scene standing = scene_at(scene, settings.time);
  const PathTracer tracer(standing.data(), camera, settings, options);
  const size_t width = static_cast<size_t>(settings.width), pixels = width * static_cast<size_t>(settings.height);
  const size_t blocks = (pixels + kBlock - 1) / kBlock;
  sums.width = settings.width, sums.height = settings.height;
  sums.radiance.resize(3 * pixels), sums.square.resize(pixels);
  const double work = static_cast<double>(blocks) * (paths - std::min(paths, sums.paths));
  std::mutex mutex;
  double done = 0;
  Parallel parallel(options.threads);
  while (sums.paths < paths) {
    parallel.for_each(blocks, [&](size_t block, int) {
      for (size_t i = block * kBlock; i < std::min(pixels, (block + 1) * kBlock); ++i) {
        const glm::dvec3 radiance = tracer.radiance(static_cast<int>(i % width), static_cast<int>(i / width), sums.paths);
        for (int c = 0; c < 3; ++c) sums.radiance[3 * i + static_cast<size_t>(c)] += radiance[c];
        sums.square[i] += luminance_of(radiance) * luminance_of(radiance);
      }
      const std::lock_guard lock(mutex);
      ++done;
      if (control.progress) control.progress(done / work);
    });
    ++sums.paths;
    if (control.go_on && !control.go_on(sums)) break;
  }
  return {};
}

void path_picture(const PathSums& sums, Framebuffer& out) {
  out = {};
  out.color.width = sums.width, out.color.height = sums.height;
  const size_t pixels = sums.square.size();
  out.color.rgba.assign(4 * pixels, 255), out.radiance.resize(3 * pixels);
  for (size_t i = 0; i < 3 * pixels; ++i) {
    const double mean = sums.paths > 0 ? sums.radiance[i] / sums.paths : 0;
    out.radiance[i] = static_cast<float>(mean), out.color.rgba[i / 3 * 4 + i % 3] = srgb_byte(mean);
  }
}

std::vector<std::string> path_remarks(const Scene& scene, const Settings& settings) {
  const SceneData& data = scene.data();
  std::vector<std::string> remarks;
  if (to_dvec(data.ambient_radiance) != glm::dvec3(0)) remarks.emplace_back("ambient light is left out");
  bool attenuated = data.light_follows_eye, point = data.light_follows_eye, mirror = false, layer = false;
  for (const Light& light : data.lights) {
    if (light.kind != static_cast<int32_t>(LightKind::kPoint)) continue;
    point = true, attenuated |= light.attenuation[0] != 0 || light.attenuation[1] != 0 || light.attenuation[2] != 1;
  }
  std::string bright;
  for (size_t i = 0; i < data.materials.size(); ++i) {
    const Material& m = data.materials[i];
    if (reference::most_reflected(m.reflectance, to_dvec(m.diffuse), to_dvec(m.specular), to_dvec(m.mirror), m.shininess) > 1)
      bright += (bright.empty() ? "" : ", ") + data.material_names[i];
    mirror |= m.mirror[0] > 0 || m.mirror[1] > 0 || m.mirror[2] > 0;
    const reference::Role role = reference::role_of(m, reference::for_paths(settings));
    layer |= role == reference::Role::kBlended || role == reference::Role::kScreenDoor;
  }
  if (attenuated) remarks.emplace_back("lights that do not fall off with the square of the distance are taken as they are");
  if (!bright.empty()) remarks.push_back("made darker, since they would reflect more light than they receive: " + bright);
  if (point && mirror) remarks.emplace_back("light that mirrors throw from point lights onto other surfaces is not found");
  if (layer) remarks.emplace_back("translucent layers let light through by chance, without refraction, and dim shadows");
  return remarks;
}

}  // namespace spanray
