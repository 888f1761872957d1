// What GpuScene owns, for the renderer.
#pragma once

#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "gpu/acceleration_structures.hpp"
#include "gpu/buffer.hpp"
#include "gpu/texture_array.hpp"
#include "isophote/gpu_scene.hpp"
#include "shared/scene_view.h"
#include "upload/scattering_tables.hpp"

namespace isophote {

struct GpuScene::Impl {
  std::vector<gpu::Buffer> buffers;         ///< those that exist; `view` holds their addresses
  gpu::AccelerationStructures acceleration; ///< of Backend::RayQuery
  gpu::Buffer view;                         ///< one gpu::SceneView, without the tables of scattering
  gpu::SceneView viewContents{};
  TableNeeds tables; ///< which a renderer computes for its settings
  gpu::TextureArray textures;
  FeatureSet features;
  SceneStatistics statistics;
  glm::dvec3 worldOrigin{0}; ///< what device positions are relative to
  glm::dvec3 worldCenter{0}; ///< of the bounds, absolute
  double worldRadius = 1;
  float emitterScale = 1;
  std::vector<std::string> materialNames; ///< by index on the device
};

} // namespace isophote
