// Optical depth.
#include <algorithm>
#include <cmath>

#include "envelope/closed_forms.hpp"
#include "envelope/scene_parts.hpp"
#include "envelope/sweep.hpp"

namespace isophote::envelope {
namespace {

/// A block of optical depth `depth` from front to back, behind a boundary that cannot be seen.
Material medium(double depth) {
  Material material = dielectric(glm::vec3(1), 0);
  material.ior = 1;
  material.transmission.factor = 1;
  // Two units long; colors are kept well inside of float's range, the distance takes the rest.
  const double perUnit = depth / 2;
  const double color = std::exp(-std::clamp(perUnit, 1e-2, 10.0));
  material.volume.thickness = 1;
  material.volume.attenuationColor = glm::vec3(static_cast<float>(color));
  material.volume.attenuationDistance =
      static_cast<float>(-std::log(static_cast<double>(static_cast<float>(color))) / perUnit);
  return material;
}

/// What `medium` gives after rounding to the material's numbers.
double givenDepth(const Material& material) {
  return -2 * std::log(static_cast<double>(material.volume.attenuationColor.g)) /
         static_cast<double>(material.volume.attenuationDistance);
}

Case block(const Material& material) {
  Case c{.camera = orthographicLookAt({0.03, 0.02, 3}, {0.03, 0.02, 2}, 0.5, 0.5)};
  addPrimitive(c.scene, box({-1, -1, -1}, {1, 1, 1}, false, addMaterial(c.scene, material)));
  return c;
}

Case absorbing(double depth) {
  const Material material = medium(depth);
  Case c = block(material);
  c.scene.environment = constantEnvironment(glm::vec3(1));
  c.exact = std::exp(-givenDepth(material));
  c.scale = 1;
  return c;
}

/// The share that is left, in relation to itself.
Case dark(double depth) {
  Case c = absorbing(depth);
  c.scale = 0;
  return c;
}

Case scatteringAll(double depth) {
  Material material = medium(depth);
  material.volume.multiscatterColor = glm::vec3(1);
  Case c = block(material);
  c.scene.environment = constantEnvironment(glm::vec3(1));
  c.estimator.lightSampling = LightSampling::BsdfOnly;
  // Roulette ends one path in a thousand scatterings, and the others' weights grow: much noise where they are as many
  // as in deep blocks. Without it the longest paths are as many scatterings as the depth squared.
  if (depth <= 100) {
    c.estimator.russianRoulette = RussianRoulette::Off;
    c.estimator.maxDepth = 1 << 20;
  }
  c.fewestSamples = 64;
  c.mostSamples = depth > 10 ? 64 : 1024; // of a path as many scatterings as the depth, on average
  return c;
}

/// One scattering back to the view of a sun that shines along it: E p(180 degrees) (1 - exp(-2 depth)) / 2.
Case scatteringOnce(double depth) {
  Material material = medium(depth);
  material.volume.multiscatterColor = glm::vec3(1);
  const double given = givenDepth(material);
  Case c = block(material);
  c.scene.lights.push_back(
      {.kind = LightKind::Directional, .intensity = glm::vec3(static_cast<float>(4 * kPi)), .direction = {0, 0, -1}});
  c.estimator.maxDepth = 1;
  c.exact = static_cast<double>(static_cast<float>(4 * kPi)) / (4 * kPi) * -std::expm1(-2 * given) / 2;
  c.mostSamples = 1 << 17;
  return c;
}

} // namespace

void addMediumSweeps(std::vector<Sweep>& sweeps) {
  const std::vector<double> depths = {1e-8, 1e-6, 1e-4, 1e-2, 0.1, 1, 10, 100, 1e3, 1e4};
  const char* quantity = "optical depth";
  sweeps.push_back({"absorption", quantity,
                    "A block that absorbs, before a white sky: exp(-depth), relative to the sky", depths, 1,
                    absorbing});
  sweeps.push_back({"darkness",
                    quantity,
                    "The same, relative to what is left of the sky",
                    {1e-2, 0.1, 1, 2, 5, 10, 15, 20, 25, 30},
                    1,
                    dark});
  sweeps.push_back({"scattering",
                    quantity,
                    "A block that scatters and loses nothing, under a white sky: 1",
                    {1e-8, 1e-6, 1e-4, 1e-2, 0.1, 1, 10, 100, 1e3, 1e4},
                    1,
                    scatteringAll});
  sweeps.back().slow = {1e3, 1e4};
  sweeps.push_back({"single-scattering", quantity, "The sun scattered back once by a block: an integral over its depth",
                    depths, 1, scatteringOnce});
}

} // namespace isophote::envelope
