#include "render/path_pool.hpp"

#include <numeric>

namespace isophote {

using gpu::Buffer;
using gpu::Memory;

PathPool::PathPool(const Device& device, uint32_t pathCount, const PathPoolParts& parts)
    : capacity(pathCount),
      queues(device,
             uint64_t{pathCount} * (parts.scatteringMedia ? gpu::kQueueCount : gpu::kQueueMedium) * sizeof(uint32_t),
             Memory::Device, "pool.queues"),
      rays(device, uint64_t{pathCount} * sizeof(gpu::RayState), Memory::Device, "pool.rays"),
      hits(device, uint64_t{pathCount} * sizeof(gpu::HitState), Memory::Device, "pool.hits"),
      paths(device, uint64_t{pathCount} * sizeof(gpu::PathState), Memory::Device, "pool.paths"),
      shadows(device, parts.shadows ? uint64_t{pathCount} * sizeof(gpu::ShadowState) : 0, Memory::Device,
              "pool.shadows"),
      interiors(device, parts.interiors ? uint64_t{pathCount} * sizeof(gpu::InteriorState) : 0, Memory::Device,
                "pool.interiors"),
      receivers(device, parts.receivers ? uint64_t{pathCount} * sizeof(gpu::LightReceiver) : 0, Memory::Device,
                "pool.receivers"),
      media(device, parts.media ? uint64_t{pathCount} * sizeof(gpu::MediaState) : 0, Memory::Device, "pool.media"),
      straight(device, parts.straight ? uint64_t{pathCount} * sizeof(gpu::StraightState) : 0, Memory::Device,
               "pool.straight"),
      beyond(device, parts.beyond ? uint64_t{pathCount} * sizeof(gpu::BeyondState) : 0, Memory::Device, "pool.beyond"),
      wave(device, sizeof(gpu::WaveState), Memory::Device, "pool.wave"),
      render(device, sizeof(gpu::RenderView), Memory::Device, "pool.render"),
      filterTable(device, gpu::kFilterTableSize * sizeof(float), Memory::Device, "pool.filterTable"),
      readback(device, sizeof(gpu::WaveState), Memory::Host, "pool.readback") {}

void PathPool::reset(const Device& device, uint64_t firstWork) const {
  std::vector<uint32_t> slots(capacity);
  std::iota(slots.begin(), slots.end(), 0u);
  gpu::writeBuffer(device, queues, uint64_t{gpu::kQueueFree} * capacity * sizeof(uint32_t),
                   std::as_bytes(std::span(slots)));
  gpu::WaveState state{};
  state.counts[gpu::kQueueFree] = capacity;
  state.nextWork = firstWork;
  for (auto& dispatch : state.dispatches) dispatch = {0, 1, 1};
  gpu::writeBuffer(device, wave, 0, std::as_bytes(std::span(&state, 1)));
}

std::vector<BufferUse> PathPool::buffers() const {
  std::vector<BufferUse> uses;
  for (const Buffer* buffer : {&queues, &rays, &hits, &paths, &shadows, &interiors, &receivers, &media, &straight,
                               &beyond, &wave, &render, &filterTable, &readback}) {
    if (buffer->bytes() != 0) uses.push_back({buffer->name(), buffer->bytes()});
  }
  return uses;
}

uint64_t PathPool::bytes() const {
  uint64_t sum = 0;
  for (const BufferUse& use : buffers()) sum += use.bytes;
  return sum;
}

uint64_t PathPool::bytesPerPath() const {
  return (queues.bytes() + rays.bytes() + hits.bytes() + paths.bytes() + shadows.bytes() + interiors.bytes() +
          receivers.bytes() + media.bytes() + straight.bytes() + beyond.bytes()) /
         capacity;
}

} // namespace isophote
