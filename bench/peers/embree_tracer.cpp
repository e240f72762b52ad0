#include "embree_tracer.h"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <string>

#include <embree3/rtcore.h>
#include <pmmintrin.h>
#include <xmmintrin.h>

#include "measure.h"

namespace spanray::peers {
namespace {

constexpr int kStream = 256;  // rays of one call

bool coherent(EmbreeMode m) { return m == EmbreeMode::kCoherent8 || m == EmbreeMode::kCoherent16 || m == EmbreeMode::kCoherentStream; }

RTCIntersectContext make_context(EmbreeMode mode) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = coherent(mode) ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  return context;
}

// Embree asks its callers for this; our tasks run with the IEEE default.
class FlushDenormals {
 public:
  FlushDenormals() : before_(_mm_getcsr()) {
    _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
    _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
  }
  ~FlushDenormals() { _mm_setcsr(before_); }
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
  unsigned before_;
};

// What the packet sizes call their types and functions.
template <int K> struct Packet;
template <> struct Packet<8> {
  using Ray = RTCRay8;
  using RayHit = RTCRayHit8;
  static constexpr auto intersect = rtcIntersect8;
  static constexpr auto occluded = rtcOccluded8;
};
template <> struct Packet<16> {
  using Ray = RTCRay16;
  using RayHit = RTCRayHit16;
  static constexpr auto intersect = rtcIntersect16;
  static constexpr auto occluded = rtcOccluded16;
};

// Reads whole vectors: AlignedBuffer is padded by 64 bytes.
template <int K> void fill_packet(const RayBatch& rays, int first, typename Packet<K>::Ray& out, int* valid) {
  constexpr size_t kBytes = K * sizeof(float);
  float* const origin[3] = {out.org_x, out.org_y, out.org_z};
  float* const direction[3] = {out.dir_x, out.dir_y, out.dir_z};
  for (int k = 0; k < 3; ++k) {
    std::memcpy(origin[k], rays.origin[k].data() + first, kBytes);
    std::memcpy(direction[k], rays.direction[k].data() + first, kBytes);
  }
  std::memcpy(out.tfar, rays.t_max.data() + first, kBytes);
  for (int lane = 0; lane < K; ++lane) {
    valid[lane] = first + lane < rays.count ? -1 : 0;
    out.tnear[lane] = out.time[lane] = 0;
    out.mask[lane] = ~0u, out.id[lane] = 0, out.flags[lane] = 0;
  }
}

RTCRay single_ray(const RayBatch& rays, size_t i) {
  RTCRay ray = {};
  ray.org_x = rays.origin[0][i], ray.org_y = rays.origin[1][i], ray.org_z = rays.origin[2][i];
  ray.dir_x = rays.direction[0][i], ray.dir_y = rays.direction[1][i], ray.dir_z = rays.direction[2][i];
  ray.tfar = rays.t_max[i], ray.mask = ~0u;
  return ray;
}

template <int K> void closest_packets(RTCScene scene, EmbreeMode mode, const RayBatch& rays, uint32_t* primitive, float* t) {
  RTCIntersectContext context = make_context(mode);
  alignas(64) int valid[K];
  alignas(64) typename Packet<K>::RayHit packet;
  for (int first = 0; first < rays.count; first += K) {
    fill_packet<K>(rays, first, packet.ray, valid);
    for (int lane = 0; lane < K; ++lane) packet.hit.geomID[lane] = packet.hit.primID[lane] = RTC_INVALID_GEOMETRY_ID;
    Packet<K>::intersect(valid, scene, &context, &packet);
    for (int lane = 0; lane < K && first + lane < rays.count; ++lane) {
      primitive[first + lane] = packet.hit.primID[lane];
      t[first + lane] = packet.ray.tfar[lane];
    }
  }
}

template <int K> void any_packets(RTCScene scene, EmbreeMode mode, const RayBatch& rays, uint32_t* bits) {
  RTCIntersectContext context = make_context(mode);
  alignas(64) int valid[K];
  alignas(64) typename Packet<K>::Ray packet;
  for (int first = 0; first < rays.count; first += K) {
    fill_packet<K>(rays, first, packet, valid);
    Packet<K>::occluded(valid, scene, &context, &packet);
    uint32_t occluded = 0;
    for (int lane = 0; lane < K; ++lane) occluded |= static_cast<uint32_t>(valid[lane] != 0 && packet.tfar[lane] < 0) << lane;
    bits[first / 32] |= occluded << (first % 32);
  }
}

void closest_rays(RTCScene scene, EmbreeMode mode, const RayBatch& rays, uint32_t* primitive, float* t) {
  RTCIntersectContext context = make_context(mode);
  alignas(64) RTCRayHit hits[kStream];
  for (int first = 0; first < rays.count; first += kStream) {
    const int n = std::min(kStream, rays.count - first);
    for (int i = 0; i < n; ++i) {
      hits[i].ray = single_ray(rays, static_cast<size_t>(first + i));
      hits[i].hit.geomID = hits[i].hit.primID = RTC_INVALID_GEOMETRY_ID;
      if (mode == EmbreeMode::kSingle) rtcIntersect1(scene, &context, &hits[i]);
    }
    if (mode != EmbreeMode::kSingle) rtcIntersect1M(scene, &context, hits, static_cast<unsigned>(n), sizeof(RTCRayHit));
    for (int i = 0; i < n; ++i) primitive[first + i] = hits[i].hit.primID, t[first + i] = hits[i].ray.tfar;
  }
}

void any_rays(RTCScene scene, EmbreeMode mode, const RayBatch& rays, uint32_t* bits) {
  RTCIntersectContext context = make_context(mode);
  alignas(64) RTCRay stream[kStream];
  for (int first = 0; first < rays.count; first += kStream) {
    const int n = std::min(kStream, rays.count - first);
    for (int i = 0; i < n; ++i) {
      stream[i] = single_ray(rays, static_cast<size_t>(first + i));
      if (mode == EmbreeMode::kSingle) rtcOccluded1(scene, &context, &stream[i]);
    }
    if (mode != EmbreeMode::kSingle) rtcOccluded1M(scene, &context, stream, static_cast<unsigned>(n), sizeof(RTCRay));
    for (int i = 0; i < n; ++i) bits[(first + i) / 32] |= static_cast<uint32_t>(stream[i].tfar < 0) << ((first + i) % 32);
  }
}

bool count_memory(void* counter, ssize_t bytes, bool) {
  *static_cast<std::atomic<int64_t>*>(counter) += bytes;
  return true;
}

}  // namespace

struct EmbreeTracer::Handles {
  std::atomic<int64_t> bytes{0};
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  ~Handles() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }
};

const char* embree_mode_name(EmbreeMode mode) {
  static const char* const names[kEmbreeModes] = {"1", "8 coherent", "8", "16 coherent", "16", "stream coherent", "stream"};
  return names[static_cast<int>(mode)];
}

Result<std::unique_ptr<EmbreeTracer>> EmbreeTracer::create(const SceneData& scene, bool robust, int threads, int builds) {
  std::unique_ptr<EmbreeTracer> tracer(new EmbreeTracer);
  tracer->handles_ = std::make_unique<Handles>();
  tracer->handles_->device = rtcNewDevice(("threads=" + std::to_string(threads)).c_str());
  if (tracer->handles_->device == nullptr) return Error{"Embree makes no device"};
  rtcSetDeviceMemoryMonitorFunction(tracer->handles_->device, count_memory, &tracer->handles_->bytes);
  tracer->positions_.reserve(3 * scene.vertices.size() + 4);
  for (const Vertex& v : scene.vertices) tracer->positions_.insert(tracer->positions_.end(), v.position, v.position + 3);
  tracer->positions_.resize(3 * scene.vertices.size() + 4);  // Embree reads 16 bytes at a time
  for (const Triangle& t : scene.triangles) tracer->indices_.insert(tracer->indices_.end(), t.vertex, t.vertex + 3);
  std::vector<double> ms;
  for (int i = 0; i < builds; ++i) {
    const Stopwatch watch;
    tracer->build(robust);
    ms.push_back(watch.wall());
  }
  tracer->build_ms_ = median(ms);
  if (rtcGetDeviceError(tracer->handles_->device) != RTC_ERROR_NONE) return Error{"Embree could not build the scene"};
  return tracer;
}

EmbreeTracer::~EmbreeTracer() = default;

void EmbreeTracer::build(bool robust) {
  RTCDevice device = handles_->device;
  if (handles_->scene != nullptr) rtcReleaseScene(handles_->scene);
  handles_->scene = rtcNewScene(device);
  rtcSetSceneFlags(handles_->scene, robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
  rtcSetSceneBuildQuality(handles_->scene, RTC_BUILD_QUALITY_MEDIUM);
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, positions_.data(), 0, 12, (positions_.size() - 4) / 3);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, indices_.data(), 0, 12, indices_.size() / 3);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(handles_->scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(handles_->scene);
}

size_t EmbreeTracer::memory_bytes() const { return static_cast<size_t>(std::max<int64_t>(0, handles_->bytes)); }

void EmbreeTracer::closest(EmbreeMode mode, const RayBatch& rays, uint32_t* primitive, float* t) const {
  const FlushDenormals guard;
  switch (mode) {
    case EmbreeMode::kCoherent8:
    case EmbreeMode::kIncoherent8: return closest_packets<8>(handles_->scene, mode, rays, primitive, t);
    case EmbreeMode::kCoherent16:
    case EmbreeMode::kIncoherent16: return closest_packets<16>(handles_->scene, mode, rays, primitive, t);
    default: return closest_rays(handles_->scene, mode, rays, primitive, t);
  }
}

void EmbreeTracer::any(EmbreeMode mode, const RayBatch& rays, uint32_t* bits) const {
  const FlushDenormals guard;
  for (int i = 0; i < (rays.count + 31) / 32; ++i) bits[i] = 0;
  switch (mode) {
    case EmbreeMode::kCoherent8:
    case EmbreeMode::kIncoherent8: return any_packets<8>(handles_->scene, mode, rays, bits);
    case EmbreeMode::kCoherent16:
    case EmbreeMode::kIncoherent16: return any_packets<16>(handles_->scene, mode, rays, bits);
    default: return any_rays(handles_->scene, mode, rays, bits);
  }
}

}  // namespace spanray::peers
