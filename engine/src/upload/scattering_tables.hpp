// The tables that surface scattering reads, for one scene and one choice of facets.
#pragma once

#include <vector>

#include "gpu/buffer.hpp"
#include "isophote/settings.hpp"
#include "shared/scene_view.h"
#include "upload/anisotropic_albedo.hpp"
#include "upload/film_albedo.hpp"
#include "upload/glass_loss.hpp"

namespace isophote {

/// What the materials of a scene need; the settings say how it is computed. Nothing here costs a table by itself.
struct TableNeeds {
  bool facets = false;
  bool clearcoat = false;
  bool sheen = false;
  bool coatedSheen = false;      ///< both on one material
  std::vector<float> opaqueIors; ///< of dielectric facets: MaterialRecord::exactAlbedo, from kFacetAlbedoSize on
  std::vector<AnisotropicSurface> anisotropic; ///< one table each: MaterialRecord::anisotropicAlbedo
  std::vector<FilmSurface> films;              ///< one table each: MaterialRecord::filmAlbedo
  std::vector<GlassSurface> glass; ///< one loss table each, 2 kGlassLossHalf items: MaterialRecord::glassLoss
};

class ScatteringTables {
public:
  /// Computes what `needs` and the settings ask for, and uploads it.
  ScatteringTables(const Device& device, const TableNeeds& needs, const EstimatorSettings& settings);

  /// Adds the tables' addresses.
  void writeTo(gpu::SceneView& view) const;
  [[nodiscard]] const std::vector<gpu::Buffer>& buffers() const { return buffers_; }

private:
  template <class T> gpu::Address upload(const Device& device, const std::vector<T>& table, const char* name);

  gpu::Address facetAlbedo_ = 0;
  gpu::Address anisotropicAlbedo_ = 0;
  gpu::Address glassLoss_ = 0;
  gpu::Address clearcoat_ = 0;
  gpu::Address sheen_ = 0;
  gpu::Address coatedSheen_ = 0;
  gpu::Address filmAlbedo_ = 0;
  std::vector<gpu::Buffer> buffers_;
};

} // namespace isophote
