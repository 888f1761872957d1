// Device memory of the paths in flight: state by slot, and the queues of slot numbers.
#pragma once

#include <cstdint>
#include <vector>

#include "gpu/buffer.hpp"
#include "isophote/gpu_scene.hpp"
#include "shared/path_types.h"

namespace isophote {

/// The state that only some scenes need.
struct PathPoolParts {
  bool shadows = false;
  bool interiors = false;
  bool receivers = false;
  bool media = false;           ///< of volumes
  bool scatteringMedia = false; ///< their queue
  bool straight = false;        ///< of shadow rays that cross glass
  bool beyond = false;          ///< of paths followed beyond the depth limit
};

struct PathPool {
  uint32_t capacity = 0;
  gpu::Buffer queues;
  gpu::Buffer rays;
  gpu::Buffer hits;
  gpu::Buffer paths;
  gpu::Buffer shadows;   ///< null where no light is sampled
  gpu::Buffer interiors; ///< null where nothing transmits
  gpu::Buffer receivers; ///< null where the choice of a light does not depend on them
  gpu::Buffer media;     ///< MediaState; null without volumes
  gpu::Buffer straight;  ///< null where glass stops shadow rays
  gpu::Buffer beyond;    ///< BeyondState; null where no path is followed beyond the depth limit
  gpu::Buffer wave;      ///< WaveState
  gpu::Buffer render;    ///< RenderView
  gpu::Buffer filterTable;
  gpu::Buffer readback; ///< WaveState on the host, copied at the end of each submit

  PathPool(const Device& device, uint32_t paths, const PathPoolParts& parts);

  /// All slots free, counters zero.
  void reset(const Device& device, uint64_t firstWork) const;
  [[nodiscard]] std::vector<BufferUse> buffers() const;
  [[nodiscard]] uint64_t bytes() const;
  /// Of state and queue entries for one path.
  [[nodiscard]] uint64_t bytesPerPath() const;
};

} // namespace isophote
