// Slivers.
#include <algorithm>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

#include "envelope/closed_forms.hpp"
#include "envelope/scene_parts.hpp"
#include "envelope/sweep.hpp"

namespace isophote::envelope {
namespace {

/// A strip in y = 0 of `count` rectangles along x, two triangles each, 2 long in z and 2 / aspect wide.
Primitive slivers(double aspect, uint32_t count, uint32_t material) {
  Primitive strip;
  const double width = 2 / aspect;
  for (uint32_t i = 0; i <= count; ++i) {
    const auto x = static_cast<float>(width * (static_cast<double>(i) - count / 2.0));
    strip.positions.insert(strip.positions.end(), {{x, 0, 1}, {x, 0, -1}});
  }
  for (uint32_t i = 0; i < count; ++i) {
    const uint32_t a = 2 * i;
    strip.indices.insert(strip.indices.end(), {a, a + 2, a + 3, a, a + 3, a + 1});
  }
  strip.material = material;
  return strip;
}

/// A floor of slivers, tilted by its node, under a sun: what misses them is dark, and a wrong normal shows.
Case sliverFloor(double aspect) {
  constexpr uint32_t kCount = 64;
  Case c;
  const glm::dmat4 tilt = glm::rotate(glm::dmat4(1), 0.7, glm::normalize(glm::dvec3(1, 0.2, 0.4)));
  addPrimitive(c.scene, slivers(aspect, kCount, addMaterial(c.scene, lambert(glm::vec3(1)))), tilt);
  const glm::dvec3 normal(tilt * glm::dvec4(0, 1, 0, 0));
  c.scene.lights.push_back({.kind = LightKind::Directional, .intensity = glm::vec3(1), .direction = {0, -1, 0}});
  const double half = std::min(0.4, 20 / aspect); // the floor is 64 / aspect wide each way and 1 long
  c.camera = orthographicLookAt(normal, {0, 0, 0}, half, half);
  c.exact = normal.y / kPi;
  c.estimator.maxDepth = 1;
  return c;
}

/// One sliver of radiance 1 over a floor.
Case sliverLamp(double aspect) {
  Case c{.scene = lambertFloor(glm::vec3(1), 2), .camera = sensorAt({0, 0, 0}), .mostSamples = 1 << 15};
  Primitive light;
  light.positions = {{-0.5f, 1, 0}, {0.5f, 1, 0}, {0.1f, 1, static_cast<float>(1 / aspect)}};
  light.indices = {0, 1, 2};
  const auto radiance = static_cast<float>(aspect);
  light.material = addMaterial(c.scene, emitter(glm::vec3(radiance)));
  const std::vector<glm::dvec3> corners(light.positions.begin(), light.positions.end());
  c.exact = static_cast<double>(radiance) * polygonIrradiance(corners) / kPi;
  addPrimitive(c.scene, light);
  return c;
}

} // namespace

void addTriangleSweeps(std::vector<Sweep>& sweeps) {
  const std::vector<double> aspects = {1, 10, 100, 1e3, 1e4, 1e5, 1e6, 1e7};
  sweeps.push_back({"aspect-floor", "length over width of the triangles",
                    "A tilted Lambert floor of slivers under a sun: the cosine over pi", aspects, 1, sliverFloor});
  sweeps.push_back({"aspect-lamp", "length over width of the triangle",
                    "A lamp of one sliver over a Lambert floor, as bright as it is thin: Lambert's formula", aspects, 1,
                    sliverLamp});
}

} // namespace isophote::envelope
