// The correction of shading normals that lean away from the viewer, in double precision.
#pragma once

#include <algorithm>
#include <cmath>

#include <glm/glm.hpp>

namespace isophote::oracle {

/// Turns ns towards wo in the plane of both until dot(wo, ns) = min(0.01, dot(wo, ng)), where it is less
/// (docs/bsdf.md).
[[nodiscard]] inline glm::dvec3 bendTowards(const glm::dvec3& ns, const glm::dvec3& ng, const glm::dvec3& wo) {
  const double least = std::min(0.01, glm::dot(wo, ng));
  const double cosine = glm::dot(wo, ns);
  if (cosine >= least) return ns;
  const glm::dvec3 across = ns - cosine * wo;
  if (glm::length(across) < 1e-4) return ng;
  const double angle = std::acos(least);
  return std::cos(angle) * wo + std::sin(angle) * glm::normalize(across);
}

} // namespace isophote::oracle
