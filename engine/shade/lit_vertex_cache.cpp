#include "shade/lit_vertex_cache.h"

#include <thread>

#include "shade/light_kernel.h"

namespace spanray {

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
  constexpr int kChunk = 96;  // vertices lit at once
  uint32_t claimed[kChunk + 16] = {}, material[kChunk + 16] = {};
  int count = 0;
  const auto light_claimed = [&] {
    kLightVertices[isa_index(frame.isa)](frame, claimed, material, count, values.data(), stride());
    for (int k = 0; k < count; ++k) states[claimed[k]].store(2 * epoch + 1, std::memory_order_release);
    lit.fetch_add(static_cast<uint64_t>(count), std::memory_order_relaxed);
    count = 0;
  };
  const auto for_each_triangle = [&](const auto& body) {
    uint32_t previous = kNoPrimitive;  // neighbours in a batch mostly see the same triangle
    for (int i = 0; i < surfaces.count; ++i) {
      if (surfaces.valid[i] == 0 || surfaces.primitive[i] == previous) continue;
      previous = surfaces.primitive[i];
      body(frame.scene->triangles[previous]);
    }
  };

  // A task first lights all that it claimed and only then waits for others: no two tasks can wait for each other.
  bool wait = false;
  ClaimGuard guard(abandoned);
  for_each_triangle([&](const Triangle& triangle) {
    for (const uint32_t vertex : triangle.vertex) {
      if (is_lit(vertex)) continue;
      if (!try_claim(vertex)) {
        wait = true;
        continue;
      }
      claimed[count] = vertex;
      material[count++] = material_of(triangle);
      if (count == kChunk) light_claimed();
    }
  });
  if (count > 0) light_claimed();
  guard.release();
  if (!wait) return;
  for_each_triangle([&](const Triangle& triangle) {
    for (const uint32_t vertex : triangle.vertex)
      wait_for(vertex);
  });
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
