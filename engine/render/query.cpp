// Questions outside of frames: one tree over all triangles (of two levels where frames would have them), asked by the tracer of
// frames (rays) and by ray/sweep.h (spheres).
#include "spanray/query.h"

#include <cmath>
#include <exception>
#include <mutex>
#include <new>

#include "core/fp_env.h"
#include "frame/exact_hit.h"
#include "frame/primary_rays.h"
#include "frame/transparency.h"
#include "raster/exact.h"
#include "ray/bvh_data.h"
#include "ray/sweep.h"
#include "render/check_request.h"
#include "render/make_frame.h"
#include "render/query_hit.h"
#include "shade/surface.h"

namespace spanray {
namespace {

constexpr double kMostCoordinate = 1e30, kLeastWay = 1e-30;

// accept(hit) with surfaces that rays pass wholly through.
uint32_t accept_asked(const Frame& frame, const RayBatch& rays, int first, uint32_t primitive, uint32_t candidates) {
  return (flags_of(frame, primitive) & kMaterialTranslucent) != 0 ? 0 : accept_rays(frame, rays, first, primitive, candidates);
}

// What is wrong with a ray, or null.
const char* fault_of(const Ray& r) {
  const auto finite3 = [](const float* v) { return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]); };
  if (!finite3(r.origin)) return "the origin is not finite";
  if (!finite3(r.direction)) return "the direction is not finite";
  if (r.direction[0] == 0 && r.direction[1] == 0 && r.direction[2] == 0) return "the direction is zero";
  if (!(r.t_min >= 0) || !std::isfinite(r.t_min)) return "t_min is negative or not finite";
  if (!(r.t_max >= 0)) return "t_max is negative or NaN";
  return r.t_min > r.t_max ? "t_min is greater than t_max" : nullptr;
}

const char* fault_of(const double (&center)[3], double radius) {
  for (const double x : center)
    if (!(std::fabs(x) <= kMostCoordinate)) return "a coordinate is not finite, or beyond 1e30";
  return radius >= 0 && radius <= kMostCoordinate ? nullptr : "the radius is negative, not finite, or beyond 1e30";
}

glm::dvec3 to_dvec(const double (&v)[3]) { return {v[0], v[1], v[2]}; }

RayBatch batch_of(std::span<const Ray> rays) {
  RayBatch batch;
  batch.resize(static_cast<int>(rays.size()), false);
  for (size_t i = 0; i < rays.size(); ++i) {
    for (int k = 0; k < 3; ++k) batch.origin[k][i] = rays[i].origin[k], batch.direction[k][i] = rays[i].direction[k];
    batch.t_max[i] = rays[i].t_max;
    batch.pixel[i] = 0;
  }
  return batch;
}

// Runs a question under the default floating-point environment; what it throws becomes an error.
template <class F> auto guarded(F&& question) -> decltype(question()) {
  const FpEnvGuard guard;
  try {
    return question();
  } catch (const std::bad_alloc&) {
    return Error{"out of memory for the tree of this scene"};
  } catch (const std::exception& e) {
    return Error{std::string("cannot ask the scene: ") + e.what()};
  }
}

}  // namespace

struct SceneQuery::Impl {
  Scene scene;
  QueryOptions options;
  std::once_flag built;  // what stands below is read only from then on
  std::optional<Parallel> one;  // frames point at a pool; questions run in the thread that asks
  Frame frame;
  std::vector<uint32_t> for_rays, solid;  // MaterialFlags by material
  Bvh bvh;

  Impl(Scene asked, const QueryOptions& wanted) : scene(std::move(asked)), options(wanted) {}

  Settings settings() const {
    Settings s;
    s.width = s.height = 1;
    s.transparency = options.transparency, s.filter = options.filter, s.isa = options.isa;
    s.visibility = Visibility::kRay, s.shadows = Shadows::kNone, s.reflections = Reflections::kNone;
    s.bump = false;
    return s;
  }

  // Thread-safe, and tried again after it failed.
  Result<void> prepare() {
    if (auto checked = check_request(scene, Camera(), settings()); !checked) return checked;
    std::call_once(built, [this] { build(); });
    return {};
  }

  // MaterialFlags by material. doors: screen-doors let through what their pattern does.
  std::vector<uint32_t> flags_for(const Settings& s, bool doors) const {
    std::vector<uint32_t> flags;
    for (const Material& m : scene.data().materials) {
      const MaterialTransparency kind = effective_transparency(m, s);
      const bool cut = kind == MaterialTransparency::kMask || (doors && kind == MaterialTransparency::kScreenDoor);
      const bool passed = kind == MaterialTransparency::kAlpha && !options.translucent;
      flags.push_back(passed ? kMaterialTranslucent | kMaterialMasked : options.cutouts && cut ? kMaterialMasked : 0u);
    }
    return flags;
  }

  void build() {
    const SceneData& data = scene.data();
    const Settings s = settings();
    solid.assign(data.materials.size(), 0), for_rays = flags_for(s, false);
    one.emplace(1);
    frame = make_frame(data, Camera(), s, make_plan(data, find_scene_use(data), s), *one);
    frame.material_flags = for_rays.data();
    frame.accept_rays = accept_asked;
    Parallel all(0);
    bvh = build_bvh(data, solid.data(), 0, 0, all, TreeQuality::kFast);
  }

  Frame frame_for(const std::vector<uint32_t>& flags) const {
    Frame f = frame;
    f.material_flags = flags.data();
    return f;
  }

  // The same among hits at t_min or beyond: all hits are asked for, since the tracer knows no t_min.
  std::optional<RayHit> first_beyond(const Frame& f, const Ray& ray) const {
    FragmentList list;
    trace_all(f, bvh, batch_of({&ray, 1}), HitsOnEdges::kOfAll, list);
    std::optional<RayHit> best;
    for (const uint32_t primitive : list.primitive) {
      const RayHit hit = hit_of(scene.data(), ray, primitive);
      if (hit.t < static_cast<double>(ray.t_min)) continue;
      if (!best || hit.t < best->t || (hit.t == best->t && primitive < best->name.triangle)) best = hit;
    }
    if (bvh.data().exact.empty()) return best;
    ExactRay beyond = exact_ray(ray);
    beyond.t_min = std::nextafter(static_cast<double>(ray.t_min), -1.0);  // a hit at exactly t_min counts
    uint32_t met = kNoPrimitive;
    closest_exact(f, bvh.data().exact, batch_of({&ray, 1}), beyond.t_min, &met);
    if (met == kNoPrimitive) return best;
    const RayHit hit = hit_of(scene.data(), beyond, met);
    return best && shows_triangle(scene.data(), best->name.triangle, best->t, met, hit.t) ? best : hit;
  }

  std::vector<std::optional<RayHit>> closest(const Frame& f, std::span<const Ray> rays) const {
    std::vector<uint32_t> primitive(rays.size());
    trace_closest(f, bvh, batch_of(rays), primitive.data());
    std::vector<std::optional<RayHit>> hits(rays.size());
    for (size_t i = 0; i < rays.size(); ++i) {
      if (primitive[i] == kNoPrimitive) continue;
      hits[i] = hit_of(scene.data(), rays[i], primitive[i]);
      if (hits[i]->t < static_cast<double>(rays[i].t_min)) hits[i] = first_beyond(f, rays[i]);
    }
    return hits;
  }

  std::optional<SweepHit> sweep_ray(const glm::dvec3& start, const glm::dvec3& motion) const {
    Ray ray;
    for (int k = 0; k < 3; ++k) ray.origin[k] = static_cast<float>(start[k]), ray.direction[k] = static_cast<float>(motion[k]);
    ray.t_max = 1;
    const std::optional<RayHit> met = closest(frame_for(solid), {&ray, 1})[0];
    if (!met) return std::nullopt;
    SweepHit hit;
    hit.name = met->name, hit.time = met->t, hit.distance = met->distance;
    for (int k = 0; k < 3; ++k) {
      hit.center[k] = hit.position[k] = met->position[k];
      hit.normal[k] = met->front ? met->normal[k] : -met->normal[k];
    }
    return hit;
  }
};

SceneQuery::SceneQuery(Scene scene, const QueryOptions& options) : impl_(std::make_shared<Impl>(std::move(scene), options)) {}

Result<void> SceneQuery::prepare() const {
  return guarded([&] { return impl_->prepare(); });
}

Result<QueryTree> SceneQuery::tree() const {
  return guarded([&]() -> Result<QueryTree> {
    if (auto ready = impl_->prepare(); !ready) return ready.error();
    const Bvh& bvh = impl_->bvh;
    return QueryTree{bvh.levels(), bvh.instance_count(), bvh.memory_bytes()};
  });
}

Result<std::optional<RayHit>> SceneQuery::closest(const Ray& ray) const {
  if (const char* fault = fault_of(ray)) return Error{std::string("the ray: ") + fault};
  Result<std::vector<std::optional<RayHit>>> hits = closest({&ray, 1});
  if (!hits) return hits.error();
  return hits.value()[0];
}

Result<std::vector<std::optional<RayHit>>> SceneQuery::closest(std::span<const Ray> rays) const {
  return guarded([&]() -> Result<std::vector<std::optional<RayHit>>> {
    if (rays.size() > static_cast<size_t>(std::numeric_limits<int>::max())) return Error{"more than 2^31 - 1 rays at once"};
    for (size_t i = 0; i < rays.size(); ++i)
      if (const char* fault = fault_of(rays[i])) return Error{"ray " + std::to_string(i) + ": " + fault};
    if (auto ready = impl_->prepare(); !ready) return ready.error();
    return impl_->closest(impl_->frame, rays);
  });
}

Result<bool> SceneQuery::any(const Ray& ray) const {
  return guarded([&]() -> Result<bool> {
    if (const char* fault = fault_of(ray)) return Error{std::string("the ray: ") + fault};
    if (auto ready = impl_->prepare(); !ready) return ready.error();
    if (ray.t_min > 0) return impl_->first_beyond(impl_->frame, ray).has_value();
    uint32_t bits = 0;
    trace_any(impl_->frame, impl_->bvh, batch_of({&ray, 1}), &bits);
    return (bits & 1u) != 0;
  });
}

Result<std::optional<RayHit>> SceneQuery::pixel(const Camera& camera, const Settings& asked, int x, int y) const {
  return guarded([&]() -> Result<std::optional<RayHit>> {
    Settings settings = impl_->settings();
    settings.width = asked.width, settings.height = asked.height;
    settings.transparency = asked.transparency, settings.filter = asked.filter, settings.culling = asked.culling;
    if (auto checked = check_request(impl_->scene, camera, settings); !checked) return checked.error();
    if (x < 0 || y < 0 || x >= settings.width || y >= settings.height)
      return Error{"pixel " + std::to_string(x) + "," + std::to_string(y) + " is outside of the picture"};
    if (auto ready = impl_->prepare(); !ready) return ready.error();
    const std::vector<uint32_t> flags = impl_->flags_for(settings, true);
    Frame frame = impl_->frame_for(flags);
    frame.settings = settings;
    frame.primary = make_primary_rays(camera, settings.width, settings.height);
    Ray ray;
    round_primary_ray(frame.primary, x + frame.places.x[0], y + frame.places.y[0], ray.origin, ray.direction);
    RayBatch batch = batch_of({&ray, 1});
    batch.primary = true, batch.pixel[0] = pack_pixel(static_cast<uint32_t>(x), static_cast<uint32_t>(y));
    uint32_t primitive = kNoPrimitive;
    trace_closest(frame, impl_->bvh, batch, &primitive);
    frame.grid = TileGrid(settings.width, settings.height);
    if (frame.scene->has_exact()) {
      ExactBins bins;
      bin_exact(frame, bins);
      float depth = kUnknownDepth;
      const int tile = y / kTileSize * frame.grid.columns + x / kTileSize;
      draw_exact(frame, bins, tile, 0, {{x, y, x + 1, y + 1}, 1, &primitive, &depth});
    }
    if (primitive == kNoPrimitive) return std::optional<RayHit>();
    if (frame.scene->is_triangle(primitive)) return std::optional<RayHit>(hit_of(*frame.scene, ray, primitive));
    const ExactRay exact = primary_exact_ray(frame, x + frame.places.x[0], y + frame.places.y[0]);
    RayHit hit = hit_of(*frame.scene, exact, primitive);
    hit.t -= camera.near_plane, hit.distance = hit.t * length3(exact.direction);
    return std::optional<RayHit>(hit);
  });
}

Result<std::optional<SweepHit>> SceneQuery::sweep(const SphereSweep& sphere) const {
  return guarded([&]() -> Result<std::optional<SweepHit>> {
    for (const auto* center : {&sphere.start, &sphere.end})
      if (const char* fault = fault_of(*center, sphere.radius)) return Error{std::string("the sphere: ") + fault};
    const glm::dvec3 start = to_dvec(sphere.start), end = to_dvec(sphere.end), motion = end - start;
    const double length = length3(motion);
    if (!(length > kLeastWay)) return Error{"the sphere: its start and end coincide"};
    if (auto ready = impl_->prepare(); !ready) return ready.error();
    if (sphere.radius == 0) return impl_->sweep_ray(start, motion);
    const SphereHit first = sweep_sphere(impl_->scene.data(), impl_->bvh, start, end, sphere.radius);
    if (first.primitive == kNoPrimitive) return std::optional<SweepHit>();
    SweepHit hit;
    hit.name = name_of(impl_->scene.data(), first.primitive);
    hit.time = first.contact.time, hit.distance = hit.time * length;
    store(start + motion * hit.time, hit.center);
    store(start + first.contact.point, hit.position);
    store(first.contact.normal, hit.normal);
    return std::optional<SweepHit>(hit);
  });
}

Result<std::vector<SphereTouch>> SceneQuery::touching(const double (&center)[3], double radius) const {
  return guarded([&]() -> Result<std::vector<SphereTouch>> {
    if (const char* fault = fault_of(center, radius)) return Error{std::string("the sphere: ") + fault};
    if (auto ready = impl_->prepare(); !ready) return ready.error();
    std::vector<SphereTouch> touches;
    for (const SphereHit& hit : touch_sphere(impl_->scene.data(), impl_->bvh, to_dvec(center), radius)) {
      SphereTouch touch;
      touch.name = name_of(impl_->scene.data(), hit.primitive);
      touch.distance = hit.distance;
      store(to_dvec(center) + hit.contact.point, touch.position);
      store(hit.contact.normal, touch.normal);
      touches.push_back(touch);
    }
    return touches;
  });
}

}  // namespace spanray
