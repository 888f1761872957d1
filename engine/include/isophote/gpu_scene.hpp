// A scene on the device.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "isophote/device.hpp"
#include "isophote/features.hpp"
#include "isophote/scene.hpp"

namespace isophote {

struct BufferUse {
  std::string name;
  uint64_t bytes = 0;
};

/// What building the scene cost, for stats.
struct SceneStatistics {
  uint64_t triangles = 0; ///< stored, each once
  uint64_t instancedTriangles = 0;
  uint64_t bvhNodes = 0;
  double sahCost = 0;
  uint32_t bvhMaxDepth = 0;
  double bvhSeconds = 0;
  double packSeconds = 0; ///< without the BVH
  double uploadSeconds = 0;
  uint64_t sceneBytes = 0; ///< everything but the BVH
  uint64_t bvhBytes = 0;
  uint64_t textureBytes = 0;
  std::vector<BufferUse> buffers; ///< those that exist
};

/// Buffers and textures of one scene, immutable. Keeps nothing of the Scene it was made from. Borrows the Device.
class GpuScene {
public:
  /// Builds the BVHs, packs and uploads.
  /// @throws LimitError with needed and available bytes, before anything is uploaded
  GpuScene(const Device& device, const Scene& scene);
  GpuScene(GpuScene&&) noexcept;
  GpuScene& operator=(GpuScene&&) noexcept;
  ~GpuScene();

  [[nodiscard]] const FeatureSet& features() const;
  [[nodiscard]] const SceneStatistics& statistics() const;

  struct Impl;
  [[nodiscard]] const Impl& impl() const { return *impl_; }

private:
  std::unique_ptr<Impl> impl_;
};

} // namespace isophote
