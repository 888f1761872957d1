// Scale, distance from the origin, and size of the coordinates themselves.
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

#include "envelope/closed_forms.hpp"
#include "envelope/scene_parts.hpp"
#include "envelope/sweep.hpp"

namespace isophote::envelope {
namespace {

/// A square lamp over a floor: light samples, their shadow rays and what the floor finds by itself.
Case lamp() {
  return {.scene = squareLightOverFloor(1),
          .camera = sensorAt({0, 0, 0}),
          .exact = polygonIrradiance({{-.5, 1, -.5}, {.5, 1, -.5}, {.5, 1, .5}, {-.5, 1, .5}}) / kPi,
          .mostSamples = 1 << 16};
}

/// A room that emits 1 and reflects a half, with a block of glass and a ball of mirrors in it: 2 in every direction, by
/// every path. One that leaks out of the room or is lost in the glass is missing.
Case cavity() {
  Case c{.scene = boxFurnace(glm::vec3(1), glm::vec3(0.5f)),
         .camera = boxFurnaceCamera(),
         .estimator = {.filter = PixelFilter::Box,
                       .lightSampling = LightSampling::BsdfOnly,
                       .maxDepth = 64,
                       .russianRoulette = RussianRoulette::Off},
         .exact = 2};
  const uint32_t clear = addMaterial(c.scene, glass(0));
  const uint32_t mirror = addMaterial(c.scene, metal(glm::vec3(1), 0));
  addPrimitive(c.scene, box({-0.3, -0.25, -0.2}, {0.3, 0.25, 0.2}, false, clear),
               glm::rotate(glm::translate(glm::dmat4(1), {-0.4, -0.1, -0.4}), 0.4, glm::dvec3(0.2, 1, 0.3)));
  addPrimitive(c.scene, sphere(0.3, 8, false, false, mirror), glm::translate(glm::dmat4(1), {0.5, 0.1, -0.8}));
  return c;
}

/// The case with all that is in it taken along by `map`, a similarity of factor `factor`.
Case placed(Case c, const glm::dmat4& map, double factor) {
  for (Instance& instance : c.scene.instances) instance.worldFromObject = map * instance.worldFromObject;
  c.camera.worldFromCamera[3] = map * c.camera.worldFromCamera[3];
  c.camera.xmag *= factor;
  c.camera.ymag *= factor;
  return c;
}

Case scaled(const Case& c, double factor) { return placed(c, glm::scale(glm::dmat4(1), glm::dvec3(factor)), factor); }

/// `sizes` times the room's diagonal away, in a direction without symmetry.
Case moved(const Case& c, double sizes) {
  const double size = glm::length(glm::dvec3(2, 1.6, 3));
  return placed(c, glm::translate(glm::dmat4(1), sizes * size * glm::normalize(glm::dvec3(0.5, -0.7, 0.4))), 1);
}

/// The same by the vertices, the nodes' matrices being 1.
Case withCoordinates(Case c, double factor) {
  for (Mesh& mesh : c.scene.meshes) {
    for (Primitive& primitive : mesh.primitives) {
      for (glm::vec3& position : primitive.positions) position = glm::vec3(glm::dvec3(position) * factor);
    }
  }
  c.camera.worldFromCamera[3] = glm::dvec4(glm::dvec3(c.camera.worldFromCamera[3]) * factor, 1);
  c.camera.xmag *= factor;
  c.camera.ymag *= factor;
  return c;
}

std::vector<double> powers(double base, int first, int last, int step) {
  std::vector<double> values;
  for (int k = first; k <= last; k += step) values.push_back(std::pow(base, k));
  return values;
}

} // namespace

void addPlacementSweeps(std::vector<Sweep>& sweeps) {
  const std::string lampText = "A square lamp over a Lambert floor, Lambert's form factor";
  const std::string cavityText =
      "A room that emits 1 and reflects a half, glass and mirrors in it: 2 whatever the path, no path may be lost";
  const std::vector<double> scales = powers(2, -20, 20, 4);
  const std::vector<double> distances = powers(10, 0, 7, 1);
  sweeps.push_back({"scale", "scale of the scene, by its nodes", lampText, scales, 1,
                    [](double value) { return scaled(lamp(), value); }});
  sweeps.push_back({"scale-cavity", "scale of the scene, by its nodes", cavityText, scales, 1,
                    [](double value) { return scaled(cavity(), value); }});
  sweeps.push_back({"distance", "distance from the origin, sizes of the scene", lampText, distances, 1,
                    [](double value) { return moved(lamp(), value); }});
  sweeps.push_back({"distance-cavity", "distance from the origin, sizes of the scene", cavityText, distances, 1,
                    [](double value) { return moved(cavity(), value); }});
  sweeps.push_back({"coordinates", "size of the vertices' coordinates", lampText, powers(10, -8, 8, 2), 1,
                    [](double value) { return withCoordinates(lamp(), value); }});
}

} // namespace isophote::envelope
