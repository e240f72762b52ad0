// Inside LitVertexCache (shade/light.h).
#pragma once
#include "shade/light.h"

namespace spanray {

// While a task has claims: sets the flag if an exception ends it, so that others stop waiting for what it claimed.
class ClaimGuard {
 public:
  explicit ClaimGuard(std::atomic<bool>& abandoned) : abandoned_(&abandoned) {}
  ~ClaimGuard() {
    if (abandoned_ != nullptr) abandoned_->store(true, std::memory_order_relaxed);
  }
  ClaimGuard(const ClaimGuard&) = delete;
  ClaimGuard& operator=(const ClaimGuard&) = delete;
  void release() { abandoned_ = nullptr; }  // all claims are lit

 private:
  std::atomic<bool>* abandoned_;
};

struct LitVertexCache::Impl {
  Impl(size_t vertex_count, size_t light_count);

  // Lights all vertices of the valid surfaces' triangles that are not lit yet. When it returns they all are, whichever task did it.
  void light_vertices_of(const Frame& frame, const SurfaceBatch& surfaces);
  // Pairs (diffuse, specular) by vertex, of one light.
  const float* values_of(int light) const { return values.data() + static_cast<size_t>(light) * stride(); }
  size_t stride() const { return 2 * vertices; }

  // State of a vertex: 2 * epoch while a task lights it, 2 * epoch + 1 when it is lit; anything else: not lit.
  bool try_claim(uint32_t vertex);
  // Waits until another task has lit it, or failed to.
  void wait_for(uint32_t vertex) const;
  bool is_lit(uint32_t vertex) const { return states[vertex].load(std::memory_order_acquire) == 2 * epoch + 1; }

  size_t vertices, lights;
  uint32_t epoch = 1;
  std::unique_ptr<std::atomic<uint32_t>[]> states;
  AlignedBuffer<float> values;  // not initialised: pages of vertices that are never visible are never touched
  std::atomic<uint64_t> lit{0};
  std::atomic<bool> abandoned{false};  // a task threw while it had claims: the frame is lost, and nobody may wait for them
};

}  // namespace spanray
