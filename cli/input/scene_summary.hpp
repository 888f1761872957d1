// What a scene contains and roughly what it will take on a device, counted without one.
#pragma once

#include <cstdint>

#include "isophote/scene.hpp"

namespace isophote::cli {

struct SceneSummary {
  uint64_t triangles = 0; ///< each once
  uint64_t instancedTriangles = 0;
  uint64_t emissiveTriangles = 0; ///< instanced
  uint64_t vertices = 0;
  uint64_t primitives = 0;
  uint64_t geometryBytes = 0; ///< triangles, indices and attributes
  uint64_t bvhBytes = 0;      ///< an estimate; the tree is not built
  uint64_t textureBytes = 0;
  uint64_t environmentBytes = 0;
  [[nodiscard]] uint64_t totalBytes() const { return geometryBytes + bvhBytes + textureBytes + environmentBytes; }
};

[[nodiscard]] SceneSummary summarize(const Scene& scene);

} // namespace isophote::cli
