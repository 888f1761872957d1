// Size, brightness and number of lights.
#include <cmath>
#include <random>

#include "envelope/closed_forms.hpp"
#include "envelope/scene_parts.hpp"
#include "envelope/sweep.hpp"

namespace isophote::envelope {
namespace {

Case floorUnder(std::vector<PunctualLight> lights) {
  Case c{.scene = lambertFloor(glm::vec3(1), 20), .camera = sensorAt({0, 0, 0}), .mostSamples = 1 << 16};
  c.scene.lights = std::move(lights);
  return c;
}

/// A sphere of radiance L and given solid angle whose irradiance is pi: L sin^2 of its angular radius is 1. From 2 pi
/// on the floor is inside it, or it touches the floor from below the horizon.
Case sphereOfSolidAngle(double solidAngle) {
  constexpr double kDistance = 2;
  const double cosine = 1 - solidAngle / (2 * kPi); // of the angular radius
  const bool inside = cosine <= 0;
  const double sineSquared = inside ? 1 : solidAngle / (2 * kPi) * (1 + cosine);
  PunctualLight light;
  light.kind = LightKind::Point;
  light.position = inside ? glm::dvec3(0.1, 0.2, -0.1) : glm::dvec3(0, kDistance, 0);
  light.radius = static_cast<float>(inside ? 1 : kDistance * std::sqrt(sineSquared));
  const double radius = static_cast<double>(light.radius);
  light.intensity = glm::vec3(static_cast<float>(kPi * radius * radius / sineSquared));
  Case c = floorUnder({light});
  c.camera = orthographicLookAt({0, 1e-4, 0}, {0, 0, 0}, 1e-6, 1e-6); // below the sphere
  c.exact = static_cast<double>(light.intensity.g) / (inside ? kPi * radius * radius : kPi * kDistance * kDistance);
  return c;
}

/// A square overhead of given solid angle, about; its irradiance is about pi.
Case squareOfSolidAngle(double solidAngle) {
  const double half = std::sqrt(solidAngle) / 2;
  const auto radiance = static_cast<float>(kPi / solidAngle);
  Case c = floorUnder({});
  const Primitive square = quad({0.3 - half, 1, -half}, {2 * half, 0, 0}, {0, 0, 2 * half},
                                addMaterial(c.scene, emitter(glm::vec3(radiance))));
  addPrimitive(c.scene, square);
  const std::vector<glm::dvec3> corners(square.positions.begin(), square.positions.end());
  c.exact = static_cast<double>(radiance) * polygonIrradiance(corners) / kPi;
  return c;
}

Case lampOfRadiance(double radiance) {
  const auto given = static_cast<float>(radiance);
  return {.scene = squareLightOverFloor(given),
          .camera = sensorAt({0, 0, 0}),
          .exact = static_cast<double>(given) *
                   polygonIrradiance({{-.5, 1, -.5}, {.5, 1, -.5}, {.5, 1, .5}, {-.5, 1, .5}}) / kPi,
          .mostSamples = 1 << 16};
}

/// A lamp at height 1 over a floor of this half width, above its middle.
Case lampOverPlain(double size) {
  Case c{.scene = lambertFloor(glm::vec3(1), size), .camera = sensorAt({0, 0, 0}), .fewestSamples = 1024};
  PunctualLight light;
  light.intensity = glm::vec3(static_cast<float>(kPi));
  light.position = {0, 1, 0};
  c.scene.lights.push_back(light);
  c.exact = static_cast<double>(light.intensity.g) / kPi;
  return c;
}

/// Point lights of random places and intensities over a floor.
Case lamps(double count) {
  std::mt19937 generator(6);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<PunctualLight> lights(static_cast<size_t>(count));
  double irradiance = 0;
  for (PunctualLight& light : lights) {
    light.position = {8 * unit(generator) - 4, 0.5 + 3 * unit(generator), 8 * unit(generator) - 4};
    light.intensity = glm::vec3(static_cast<float>(unit(generator) / count));
    const double distance = glm::length(light.position);
    irradiance += static_cast<double>(light.intensity.g) * light.position.y / (distance * distance * distance);
  }
  Case c = floorUnder(std::move(lights));
  c.exact = irradiance / kPi;
  return c;
}

} // namespace

void addLightSweeps(std::vector<Sweep>& sweeps) {
  sweeps.push_back({"solid-angle-sphere",
                    "solid angle of the light, sr",
                    "A spherical lamp over a Lambert floor, its irradiance pi at every size: cosine over a cone",
                    {4 * kPi, 6, 1, 0.1, 1e-2, 1e-4, 6.8e-5, 1e-6, 1e-8, 1e-10, 1e-12},
                    1,
                    sphereOfSolidAngle});
  sweeps.push_back({"solid-angle-square",
                    "solid angle of the light, sr",
                    "A square lamp over a Lambert floor, its irradiance about pi at every size: Lambert's formula",
                    {1, 0.1, 1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12},
                    1,
                    squareOfSolidAngle});
  sweeps.push_back({"intensity",
                    "radiance of the light",
                    "A square lamp over a Lambert floor, Lambert's form factor",
                    {1e-20, 1e-16, 1e-12, 1e-8, 1e-4, 1, 1e4, 1e8, 1e12, 1e16, 1e20},
                    1,
                    lampOfRadiance});
  sweeps.push_back({"nearness",
                    "size of the scene over the distance of the lamp",
                    "A point light over a large Lambert floor: the inverse square of its height",
                    {1, 10, 100, 1e3, 1e4, 1e5, 1e6},
                    10,
                    lampOverPlain});
  sweeps.push_back({"lights",
                    "number of lights",
                    "Point lights of random places and intensities over a Lambert floor: their sum",
                    {1, 10, 100, 1e3, 1e4, 1e5, 1e6},
                    1,
                    lamps});
  sweeps.back().slow = {1e6};
}

} // namespace isophote::envelope
