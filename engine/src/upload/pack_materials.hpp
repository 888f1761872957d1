// The materials of the meshes in use, their texture slots and the textures behind them.
#pragma once

#include <cstdint>
#include <vector>

#include "upload/pack_scene.hpp"

namespace isophote {

struct PackedMaterials {
  std::vector<uint32_t> record; ///< per Scene material: its MaterialRecord, or gpu::kInvalidIndex where unused
  std::vector<uint32_t> uvSets; ///< per Scene material: bit n where a texture reads TEXCOORD_n
};

/// Appends records, slots and textures to `packed`. Materials of meshes without instance are left out.
[[nodiscard]] PackedMaterials packMaterials(const Scene& scene, const std::vector<bool>& meshUsed, PackedScene& packed);

/// Whether the material gives off light: glTF's unlit materials do not.
[[nodiscard]] bool isEmitter(const Material& material);

} // namespace isophote
