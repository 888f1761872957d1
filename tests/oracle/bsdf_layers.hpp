// Clearcoat over sheen over the base, in double precision, written from docs/bsdf-layers.md.
#pragma once

#include <memory>
#include <vector>

#include <glm/glm.hpp>

#include "oracle/bsdf_metallic_roughness.hpp"

namespace isophote::oracle {

struct ClearcoatLayer {
  double amount = 0;
  double roughness = 0;
  glm::dvec3 normal{0, 0, 1}; ///< unit, in the base's local frame
};

struct SheenLayer {
  glm::dvec3 color{0};
  double roughness = 0;
};

/// Charlie distribution and visibility, color 1, as published: f cos wi.
/// Source: Estevez and Kulla 2017, "Production Friendly Microfacet Sheen BRDF"; Khronos, KHR_materials_sheen.
[[nodiscard]] double sheenLobe(const glm::dvec3& wo, const glm::dvec3& wi, double roughness);

/// What a layer reflects and how it couples with a base below.
class LayerCoupling;

/// A base with layers. Costly to build (tens of milliseconds a new pair of roughnesses); copies share what was built.
class LayeredSurface {
public:
  LayeredSurface(const MetallicRoughness& base, const ClearcoatLayer& coat, const SheenLayer& sheen);

  /// f |cos wi| of the continuous lobes; on the other side, wi.z < 0, those of thin walls.
  [[nodiscard]] glm::dvec3 eval(const glm::dvec3& wo, const glm::dvec3& wi) const;
  [[nodiscard]] double pdf(const glm::dvec3& wo, const glm::dvec3& wi) const;
  [[nodiscard]] BsdfSample sample(const glm::dvec3& wo, double uLobe, const glm::dvec2& u) const;

private:
  struct Probabilities {
    double coat = 0;
    double sheen = 0; ///< where not the coat
  };
  struct Passage {
    double narrow = 1;
    glm::dvec3 broad{1};
  };
  struct Cover {
    double share = 0;
    const LayerCoupling* layer = nullptr; ///< null: bare
  };

  [[nodiscard]] Probabilities probabilities(const glm::dvec3& wo) const;
  [[nodiscard]] Passage passage(const glm::dvec3& wo, const glm::dvec3& wi) const;
  [[nodiscard]] std::vector<Cover> covers() const;
  [[nodiscard]] double cosineTo(const LayerCoupling& layer, const glm::dvec3& w) const;
  template <class Layer>
  [[nodiscard]] glm::dvec3 left(const glm::dvec3& coatReflected, const glm::dvec2& albedo, const Layer& of) const;
  [[nodiscard]] glm::dvec3 leftAlong(const glm::dvec3& w) const;
  [[nodiscard]] glm::dvec3 leftOnAverage() const;
  [[nodiscard]] glm::dvec3 coatPassed(const glm::dvec3& w) const;

  MetallicRoughness base_;
  ClearcoatLayer coat_;
  SheenLayer sheen_;
  std::shared_ptr<const LayerCoupling> coatCoupling_;  ///< null: no coat
  std::shared_ptr<const LayerCoupling> sheenCoupling_; ///< null: no sheen
  std::shared_ptr<const LayerCoupling> bothCoupling_;  ///< null: not both
};

} // namespace isophote::oracle
