#include "upload/scattering_tables.hpp"

#include "upload/facet_albedo.hpp"
#include "upload/layer_tables.hpp"

namespace isophote {
namespace {

template <class T> void append(std::vector<T>& all, const std::vector<T>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

std::vector<glm::vec2> facetAlbedos(const TableNeeds& needs, const FacetModel& model, Fresnel fresnel) {
  std::vector<glm::vec2> all;
  if (needs.facets) all = facetAlbedoTable(model);
  if (fresnel != Fresnel::Exact) return all;
  for (const float ior : needs.opaqueIors) append(all, exactAlbedoTable(model, ior));
  return all;
}

} // namespace

ScatteringTables::ScatteringTables(const Device& device, const TableNeeds& needs, const EstimatorSettings& settings) {
  const FacetModel model{settings.ndf, settings.masking};
  facetAlbedo_ = upload(device, facetAlbedos(needs, model, settings.fresnel), "tables.facetAlbedo");
  std::vector<glm::vec2> anisotropic;
  for (const AnisotropicSurface& surface : needs.anisotropic)
    append(anisotropic, anisotropicAlbedoTable(surface, model));
  anisotropicAlbedo_ = upload(device, anisotropic, "tables.anisotropicAlbedo");
  if (needs.clearcoat) clearcoat_ = upload(device, clearcoatTable(model), "tables.clearcoat");
  if (needs.sheen) sheen_ = upload(device, sheenTable(model), "tables.sheen");
  if (needs.coatedSheen) coatedSheen_ = upload(device, coatedSheenTable(model), "tables.coatedSheen");
  std::vector<glm::vec3> films;
  for (const FilmSurface& surface : needs.films) append(films, filmAlbedoTable(surface, model));
  filmAlbedo_ = upload(device, films, "tables.filmAlbedo");
  if (!settings.multipleScattering) return;
  std::vector<glm::vec2> losses;
  for (const GlassSurface& glass : needs.glass) {
    append(losses, glassLossTable(glass, {model, settings.fresnel == Fresnel::Schlick}));
  }
  glassLoss_ = upload(device, losses, "tables.glassLoss");
}

void ScatteringTables::writeTo(gpu::SceneView& view) const {
  view.facetAlbedo = facetAlbedo_;
  view.anisotropicAlbedo = anisotropicAlbedo_;
  view.glassLoss = glassLoss_;
  view.clearcoatTable = clearcoat_;
  view.sheenTable = sheen_;
  view.coatedSheenTable = coatedSheen_;
  view.filmAlbedo = filmAlbedo_;
}

template <class T>
gpu::Address ScatteringTables::upload(const Device& device, const std::vector<T>& table, const char* name) {
  if (table.empty()) return 0;
  buffers_.push_back(gpu::uploadBuffer(device, table, name));
  return buffers_.back().address();
}

} // namespace isophote
