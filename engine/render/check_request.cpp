#include "render/check_request.h"

#include <cmath>
#include <string>

#include "core/number_text.h"
#include "scene/default_view.h"
#include "simd/isa.h"

namespace spanray {
namespace {

bool finite3(const double* v) { return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]); }

Error out_of_range(const char* what, const std::string& value, const std::string& range) {
  return Error{std::string(what) + " " + value + " is out of range: " + range};
}

}  // namespace

Result<void> check_camera(const Camera& c) {
  if (!finite3(c.eye) || !finite3(c.target) || !finite3(c.up)) return Error{"the camera has a coordinate that is not finite"};
  if (c.eye[0] == c.target[0] && c.eye[1] == c.target[1] && c.eye[2] == c.target[2])
    return Error{"the camera's eye and target coincide"};
  for (const double x : {c.eye[0], c.eye[1], c.eye[2], c.target[0], c.target[1], c.target[2]})
    if (std::fabs(x) > kMaxCameraCoordinate) return out_of_range("camera coordinate", number_text(x), "at most 1e18");
  if (!(c.fov_y_degrees >= kMinFovDegrees && c.fov_y_degrees <= kMaxFovDegrees))
    return out_of_range("field of view", number_text(c.fov_y_degrees), "0.01 to 179 degrees");
  if (!(c.near_plane >= 1e-18 && c.near_plane <= 1e18))
    return out_of_range("near plane", number_text(c.near_plane), "1e-18 to 1e18");
  return {};
}

Result<void> check_request(const Scene& scene, const Camera& camera, const Settings& s) {
  if (!scene.valid()) return Error{"no scene was loaded"};
  const auto side_ok = [](int n) { return n >= 1 && n <= kMaxImageSide; };
  if (!side_ok(s.width) || !side_ok(s.height))
    return out_of_range("picture size", std::to_string(s.width) + "x" + std::to_string(s.height),
                        "1x1 to " + std::to_string(kMaxImageSide) + "x" + std::to_string(kMaxImageSide));
  if (s.threads < 0 || s.threads > kMaxThreads)
    return out_of_range("number of threads", std::to_string(s.threads), "0 (one per processor) to " + std::to_string(kMaxThreads));
  if (s.max_bounces < 0 || s.max_bounces > kMaxBounces)
    return out_of_range("number of bounces", std::to_string(s.max_bounces), "0 to " + std::to_string(kMaxBounces));
  if (!sample_count_ok(s.samples)) return out_of_range("number of samples a pixel", std::to_string(s.samples), "1, 4, 8 or 16");
  if (!(std::fabs(s.time) <= kMostSeconds)) return out_of_range("time", number_text(s.time), "at most 1e6 seconds either way");
  if (!isa_supported(resolve_isa(s.isa))) return Error{"this processor does not have the instruction set " + std::string(isa_name(s.isa))};
  return check_camera(camera);
}

}  // namespace spanray
