// Next-event estimation of the reference tracer: one light, one point on it.
#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "isophote/scene.hpp"
#include "oracle/environment_map.hpp"
#include "oracle/random_stream.hpp"
#include "oracle/ray.hpp"
#include "oracle/triangle_soup.hpp"

namespace isophote::oracle {

inline constexpr uint32_t kNoLight = 0xffffffffu;

struct LightSample {
  glm::dvec3 wi{0}; ///< unit, towards the light
  double distance = kInfinity;
  glm::dvec3 radiance{0}; ///< area lights: radiance; punctual lights: irradiance on a surface facing wi
  double pdf = 0;         ///< choice of the light included; per steradian, or a probability where `punctual`
  bool punctual = false;
  uint32_t triangle = kNoTriangle;
  uint32_t sphere = kNoLight; ///< light of the scene
};

/// Radiometry of KHR_lights_punctual: the irradiance `light` puts on a surface at `position` that faces it, unoccluded.
[[nodiscard]] glm::dvec3 punctualIrradiance(const PunctualLight& light, glm::dvec3 position);

/// Every light of a scene, chosen with probability proportional to an estimate of its power. Borrows its arguments.
class LightList {
public:
  LightList(const Scene& scene, const std::vector<Triangle>& triangles, const EnvironmentMap* environment);

  /// A light sample as seen from `position`; pdf 0: there is none.
  [[nodiscard]] LightSample sample(glm::dvec3 position, RandomStream& random) const;

  /// Density per steradian with which sample() from `from` finds the point of emissive triangle `triangle` at
  /// `distance` along `wi`; 0 for triangles that are no lights.
  [[nodiscard]] double pdfTriangle(uint32_t triangle, double distance, glm::dvec3 wi) const;
  [[nodiscard]] double pdfEnvironment(glm::dvec3 wi) const;
  /// The same for a light with a radius, number `light` of the scene, in a direction in which it is seen.
  [[nodiscard]] double pdfSized(uint32_t light, glm::dvec3 position) const;

private:
  enum class Kind { Triangle, Punctual, Environment };
  struct Entry {
    Kind kind;
    uint32_t index;
    double pmf;
  };
  [[nodiscard]] LightSample sampleTriangle(uint32_t triangle, double pmf, glm::dvec3 position,
                                           RandomStream& random) const;
  [[nodiscard]] LightSample samplePunctual(const PunctualLight& light, double pmf, glm::dvec3 position) const;
  [[nodiscard]] LightSample sampleSized(uint32_t light, double pmf, glm::dvec3 position, glm::dvec2 u) const;

  const Scene* scene_;
  const std::vector<Triangle>* triangles_;
  const EnvironmentMap* environment_;
  std::vector<Entry> entries_;
  std::vector<double> cumulative_;  ///< of the pmf, one per entry
  std::vector<double> trianglePmf_; ///< per triangle of the scene
  std::vector<double> lightPmf_;    ///< per light of the scene
  double environmentPmf_ = 0;
};

} // namespace isophote::oracle
