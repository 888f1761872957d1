// Roughness, anisotropy, and views along the surface.
#include <cmath>

#include "envelope/closed_forms.hpp"
#include "envelope/scene_parts.hpp"
#include "envelope/sweep.hpp"

namespace isophote::envelope {
namespace {

constexpr double kSunRadius = 0.00465; // rad: the real one's, and the smallest strong light there is outdoors

const std::vector<double> kRoughnesses = {1,    0.7,  0.5,  0.3,  0.2,   0.1,  0.07, 0.05,
                                          0.04, 0.03, 0.02, 0.01, 0.005, 1e-3, 0};

Case sunInMetal(double roughness) {
  Case c{.camera = sensorAt({0, 0, 0}),
         .estimator = {.filter = PixelFilter::Box, .maxDepth = 1, .multipleScattering = false}};
  const auto given = static_cast<float>(roughness);
  addPrimitive(c.scene, quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, addMaterial(c.scene, metal(glm::vec3(1), given))));
  const auto radius = static_cast<float>(kSunRadius);
  const double sine = std::sin(static_cast<double>(radius));
  c.scene.lights.push_back({.kind = LightKind::Directional,
                            .intensity = glm::vec3(static_cast<float>(kPi * sine * sine)),
                            .radius = radius,
                            .direction = {0, -1, 0}});
  const double alpha = static_cast<double>(given) * static_cast<double>(given);
  c.exact = ggxReflectionOfDisk(alpha, static_cast<double>(radius));
  return c;
}

/// A surface that loses nothing under a white sky, seen at `cosine` from its normal: 1.
Case whitePlate(const Material& material, double cosine) {
  Case c{.estimator = {.filter = PixelFilter::Box, .lightSampling = LightSampling::BsdfOnly}, .mostSamples = 1 << 15};
  c.scene.environment = constantEnvironment(glm::vec3(1));
  Primitive plate = quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, addMaterial(c.scene, material));
  plate.normals.assign(4, glm::vec3(0, 1, 0));
  plate.tangents.assign(4, glm::vec4(1, 0, 0, 1));
  addPrimitive(c.scene, plate);
  const double sine = std::sqrt(1 - cosine * cosine);
  const glm::dvec3 direction(0.6 * sine, cosine, 0.8 * sine);
  c.camera = orthographicLookAt(0.5 * direction, {0, 0, 0}, 1e-9, 1e-9);
  return c;
}

Case whiteGlass(double roughness) {
  Case c{.camera = lookAt({1.6, 1.1, 2.1}, {0, 0, 0}, 0.2),
         .estimator = {.filter = PixelFilter::Box, .lightSampling = LightSampling::BsdfOnly},
         .mostSamples = 1 << 14};
  c.scene.environment = constantEnvironment(glm::vec3(1));
  const uint32_t material = addMaterial(c.scene, glass(static_cast<float>(roughness)));
  addPrimitive(c.scene, box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}, false, material));
  return c;
}

Material brushed(double ratio) { // widths 1 / ratio and 1
  Material material = metal(glm::vec3(1), static_cast<float>(std::sqrt(1 / ratio)));
  material.anisotropy.strength = 1;
  return material;
}

} // namespace

void addRoughnessSweeps(std::vector<Sweep>& sweeps) {
  const std::vector<double> cosines = {1, 0.3, 0.1, 0.03, 0.01, 1e-3, 1e-4, 1e-5, 1e-6};
  sweeps.push_back({"roughness-sun", "roughness",
                    "The sun's disk in a metal plate seen along the normal, single scattering: an integral over GGX's "
                    "facets",
                    kRoughnesses, 0.5, sunInMetal});
  sweeps.push_back({"roughness-metal", "roughness", "A white metal plate at 60 degrees under a white sky: 1",
                    kRoughnesses, 0.5,
                    [](double value) { return whitePlate(metal(glm::vec3(1), static_cast<float>(value)), 0.5); }});
  sweeps.push_back(
      {"roughness-glass", "roughness", "A block of glass under a white sky: 1", kRoughnesses, 0.5, whiteGlass});
  sweeps.push_back({"anisotropy",
                    "ratio of the facets' widths",
                    "A brushed white metal plate at 60 degrees under a white sky, the wider alpha 1: 1",
                    {1, 3, 10, 30, 100, 300, 1e3, 1e4, 1e5, 1e6},
                    1,
                    [](double value) { return whitePlate(brushed(value), 0.5); }});
  sweeps.push_back({"grazing-metal", "cosine of the view", "A white metal plate of roughness 0.5 under a white sky: 1",
                    cosines, 0.3, [](double value) { return whitePlate(metal(glm::vec3(1), 0.5f), value); }});
  sweeps.push_back({"grazing-plastic", "cosine of the view",
                    "A white plastic plate of roughness 0.2 under a white sky: 1", cosines, 0.3,
                    [](double value) { return whitePlate(dielectric(glm::vec3(1), 0.2f), value); }});
}

} // namespace isophote::envelope
