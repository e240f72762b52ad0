// Embree 3 over our triangles, asked in every mode that it has.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "frame/rays.h"
#include "scene/scene_data.h"
#include "spanray/result.h"

namespace spanray::peers {

// Single rays; packets of 8 and 16 and streams, each with the flag for coherent or incoherent rays.
enum class EmbreeMode { kSingle, kCoherent8, kIncoherent8, kCoherent16, kIncoherent16, kCoherentStream, kIncoherentStream };
inline constexpr int kEmbreeModes = 7;
const char* embree_mode_name(EmbreeMode mode);

class EmbreeTracer {
 public:
  // Builds at medium quality, Embree's default, `builds` times. robust: RTC_SCENE_FLAG_ROBUST.
  static Result<std::unique_ptr<EmbreeTracer>> create(const SceneData& scene, bool robust, int threads, int builds);
  ~EmbreeTracer();
  EmbreeTracer(const EmbreeTracer&) = delete;
  EmbreeTracer& operator=(const EmbreeTracer&) = delete;

  // As trace_closest and trace_any of ray/bvh.h; t: of the hit, in units of the direction, unchanged where nothing is hit. Thread-safe.
  void closest(EmbreeMode mode, const RayBatch& rays, uint32_t* primitive, float* t) const;
  void any(EmbreeMode mode, const RayBatch& rays, uint32_t* bits) const;

  double build_ms() const { return build_ms_; }
  size_t memory_bytes() const;  // vertices and indices excluded, which both tracers share with the scene

 private:
  EmbreeTracer() = default;
  void build(bool robust);
  struct Handles;
  std::unique_ptr<Handles> handles_;
  std::vector<float> positions_;
  std::vector<uint32_t> indices_;
  double build_ms_ = 0;
};

}  // namespace spanray::peers
