// What the reference tracer knows about a point on a surface.
#pragma once

#include <glm/glm.hpp>

#include "isophote/scene.hpp"
#include "oracle/bsdf_fresnel.hpp"
#include "oracle/ray.hpp"
#include "oracle/triangle_soup.hpp"

namespace isophote::oracle {

/// Material parameters at a point, textures and vertex colors applied.
struct SurfaceMaterial {
  glm::dvec3 baseColor{1};
  double metallic = 0;
  double roughness = 1; ///< perceptual
  double ior = 1.5;
  double specular = 1;
  glm::dvec3 specularColor{1};
  double clearcoat = 0;
  double clearcoatRoughness = 0;
  glm::dvec3 sheenColor{0};
  double sheenRoughness = 0;
  double anisotropy = 0; ///< strength
  ThinFilm film;
  glm::dvec3 conductorN{0}; ///< complex index of the metal; 0: it reflects its base color
  glm::dvec3 conductorK{0};
  double transmission = 0;
  double diffuseTransmission = 0;
  glm::dvec3 diffuseTransmissionColor{1};
  bool thinWalled = true;
  double dispersion = 0; ///< 20 / Abbe number
};

struct SurfacePoint {
  glm::dvec3 position{0};
  glm::dvec3 ng{0};         ///< unit geometric normal, on wo's side
  glm::dvec3 ns{0};         ///< unit shading normal, turned over together with ng
  glm::dvec3 coatNormal{0}; ///< the clearcoat's own shading normal
  glm::dvec3 along{0};      ///< direction of anisotropy, orthogonal to ns; 0: none
  glm::dvec3 emission{0};   ///< radiance towards wo
  bool frontFace = true;
  bool unlit = false; ///< KHR_materials_unlit: `emission` is the base color and nothing scatters
  SurfaceMaterial material;
};

/// Evaluates `hit` on `triangle` for a path that looks at it along -wo.
[[nodiscard]] SurfacePoint evaluateSurface(const Scene& scene, const Triangle& triangle, const Hit& hit, glm::dvec3 wo);

/// Radiance that leaves the hit point towards wo: of emissive materials the front face only, unless double-sided.
[[nodiscard]] glm::dvec3 evaluateEmission(const Scene& scene, const Triangle& triangle, const Hit& hit, glm::dvec3 wo);

/// Probability that a ray meets the surface at `hit` instead of passing through: 0 or 1 for mask, alpha for blend.
[[nodiscard]] double evaluateCoverage(const Scene& scene, const Triangle& triangle, const Hit& hit);

} // namespace isophote::oracle
