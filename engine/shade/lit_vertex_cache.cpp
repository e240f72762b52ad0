#include "shade/lit_vertex_cache.h"

#include <thread>

#include "shade/light_kernel.h"

namespace spanray {
namespace {

constexpr int kSpan = 256;  // surfaces whose vertices are lit at once

}  // namespace

LitVertexCache::Impl::Impl(size_t vertex_count, size_t light_count)
    : vertices(vertex_count), lights(light_count), states(new std::atomic<uint32_t>[vertex_count]()),
      values(2 * vertex_count * light_count) {}

bool LitVertexCache::Impl::try_claim(uint32_t vertex) {
  uint32_t state = states[vertex].load(std::memory_order_relaxed);
  // Only this frame's tasks run, so any state but the two of this epoch is an old one.
  return (state | 1) != 2 * epoch + 1 && states[vertex].compare_exchange_strong(state, 2 * epoch, std::memory_order_relaxed);
}

void LitVertexCache::Impl::wait_for(uint32_t vertex) const {
  while (!is_lit(vertex) && !abandoned.load(std::memory_order_relaxed)) std::this_thread::yield();
}

void LitVertexCache::Impl::light_vertices_of(const Frame& frame, const SurfaceBatch& surfaces) {
  uint32_t previous = kNoPrimitive;  // neighbours in a batch mostly see the same triangle
  for (int begin = 0; begin < surfaces.count; begin += kSpan) {
    const int end = begin + kSpan < surfaces.count ? begin + kSpan : surfaces.count;
    uint32_t claimed[3 * kSpan + 16], material[3 * kSpan + 16], awaited[3 * kSpan];  // claimed, material: read one vector past the end
    int claims = 0, others = 0;
    ClaimGuard guard(abandoned);
    for (int i = begin; i < end; ++i) {
      if (surfaces.valid[i] == 0 || surfaces.primitive[i] == previous) continue;
      previous = surfaces.primitive[i];
      const Triangle& triangle = frame.scene->triangles[previous];
      for (const uint32_t vertex : triangle.vertex) {
        if (is_lit(vertex)) continue;
        if (try_claim(vertex)) claimed[claims] = vertex, material[claims++] = material_of(triangle);
        else awaited[others++] = vertex;  // claimed here or by another task
      }
    }
    // A task first lights all that it claimed and only then waits for others: no two tasks can wait for each other.
    if (claims > 0) {
      for (int k = claims; k < claims + 16; ++k) claimed[k] = material[k] = 0;
      kLightVertices[isa_index(frame.isa)](frame, claimed, material, claims, values.data(), stride());
      for (int k = 0; k < claims; ++k) states[claimed[k]].store(2 * epoch + 1, std::memory_order_release);
      lit.fetch_add(static_cast<uint64_t>(claims), std::memory_order_relaxed);
    }
    guard.release();
    for (int k = 0; k < others; ++k) wait_for(awaited[k]);
  }
}

LitVertexCache::LitVertexCache(size_t vertices, size_t lights) : impl_(std::make_unique<Impl>(vertices, lights)) {}
LitVertexCache::~LitVertexCache() = default;

void LitVertexCache::reset() {
  Impl& i = *impl_;
  i.lit = 0;
  i.abandoned = false;
  if (++i.epoch < 0x7fffffffu) return;
  for (size_t v = 0; v < i.vertices; ++v) i.states[v] = 0;
  i.epoch = 1;
}

size_t LitVertexCache::memory_bytes() const {
  return impl_->values.bytes() + impl_->vertices * sizeof(std::atomic<uint32_t>);
}
uint64_t LitVertexCache::lit_count() const { return impl_->lit.load(std::memory_order_relaxed); }

}  // namespace spanray
