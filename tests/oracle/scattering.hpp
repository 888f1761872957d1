// How a surface point scatters: the oracle BSDF in the point's shading frame, with the horizon rules of the renderer.
#pragma once

#include <glm/glm.hpp>

#include "oracle/bsdf_metallic_roughness.hpp"
#include "oracle/random_stream.hpp"
#include "oracle/surface.hpp"

namespace isophote::oracle {

struct ScatterValue {
  glm::dvec3 value{0}; ///< BSDF times dot(ns, wi), without delta lobes
  double pdf = 0;      ///< density per steradian with which sample() draws wi from a continuous lobe
};

struct ScatterSample {
  glm::dvec3 wi{0};
  glm::dvec3 weight{0}; ///< BSDF dot(ns, wi) / pdf; zero: the path ends
  double pdf = 0;       ///< as in ScatterValue; meaningless where `delta`
  bool delta = false;
  double eta = 1; ///< index on wi's side over the index on wo's
};

/// Light is scattered only between directions of which ng and ns agree on which side they are.
class Scattering {
public:
  Scattering(const SurfacePoint& point, glm::dvec3 wo);

  [[nodiscard]] ScatterValue evaluate(glm::dvec3 wi) const;
  [[nodiscard]] ScatterSample sample(RandomStream& random) const;

private:
  [[nodiscard]] bool sidesAgree(glm::dvec3 w) const { return glm::dot(ng_, w) * glm::dot(frame_[2], w) > 0; }

  glm::dvec3 ng_;
  glm::dmat3 frame_; ///< columns tangent, bitangent, ns
  glm::dvec3 woLocal_;
  bool lit_;     ///< wo is above both horizons
  bool lambert_; ///< no specular lobe and no coat: albedo / pi, without asking the full model
  MetallicRoughness model_;
};

} // namespace isophote::oracle
