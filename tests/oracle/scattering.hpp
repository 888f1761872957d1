// How a surface point scatters: the oracle BSDF in the point's shading frame, with the horizon rules of the renderer.
#pragma once

#include <glm/glm.hpp>

#include "oracle/random_stream.hpp"
#include "oracle/surface.hpp"

namespace isophote::oracle {

struct ScatterValue {
  glm::dvec3 value{0}; ///< BSDF times |dot(ns, wi)|, without delta lobes
  double pdf = 0;      ///< density per steradian with which sample() draws wi from a non-delta lobe
};

struct ScatterSample {
  glm::dvec3 wi{0};
  glm::dvec3 weight{0}; ///< BSDF |dot(ns, wi)| / pdf; zero: the path ends
  double pdf = 0;       ///< as in ScatterValue; meaningless where `delta`
  bool delta = false;
};

/// Light is scattered only between directions above the horizons of both ng and ns.
class Scattering {
public:
  Scattering(const SurfacePoint& point, glm::dvec3 wo);

  [[nodiscard]] ScatterValue evaluate(glm::dvec3 wi) const;
  [[nodiscard]] ScatterSample sample(RandomStream& random) const;

private:
  [[nodiscard]] bool above(glm::dvec3 w) const;

  SurfacePoint point_;
  glm::dvec3 wo_;
  glm::dvec3 tangent_, bitangent_;
};

} // namespace isophote::oracle
