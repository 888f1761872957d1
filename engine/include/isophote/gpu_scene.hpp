// A scene on the device.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "isophote/device.hpp"
#include "isophote/features.hpp"
#include "isophote/scene.hpp"
#include "isophote/settings.hpp"

namespace isophote {

struct BufferUse {
  std::string name;
  uint64_t bytes = 0;
};

/// What building the scene cost, for stats.
struct SceneStatistics {
  Backend backend = Backend::Compute;
  uint64_t triangles = 0; ///< stored, each once
  uint64_t instancedTriangles = 0;
  uint64_t bvhNodes = 0; ///< with sahCost and bvhMaxDepth: of Backend::Compute, the device does not tell its own
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
  ///
  /// @param backend  RayQuery has the device build its acceleration structures in place of the BVHs; renders of the
  ///                 scene then use them. It needs a Device with DeviceOptions::rayQuery.
  /// @param bvhBuild  of Backend::Compute; a device builds its own structures for fast rays
  /// @throws LimitError with needed and available bytes, before anything is uploaded (acceleration structures: after
  ///         what they are built from); UsageError where the device has no ray query enabled
  GpuScene(const Device& device, const Scene& scene, Backend backend = Backend::Compute,
           BvhBuild bvhBuild = BvhBuild::FastTrace);
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
