// worldBounds and framingCamera.
#include <algorithm>
#include <cmath>

#include <glm/glm.hpp>

#include "isophote/error.hpp"
#include "isophote/scene.hpp"

namespace isophote {
namespace {

void extend(Bounds& bounds, glm::dvec3 point) {
  bounds.lower = glm::min(bounds.lower, point);
  bounds.upper = glm::max(bounds.upper, point);
}

bool contains(const Bounds& outer, const Bounds& inner) {
  return glm::all(glm::lessThanEqual(outer.lower, inner.lower)) &&
         glm::all(glm::greaterThanEqual(outer.upper, inner.upper));
}

glm::dvec3 transformed(const glm::dmat4& matrix, glm::dvec3 point) { return glm::dvec3(matrix * glm::dvec4(point, 1)); }

glm::dvec3 corner(const Bounds& bounds, int index) {
  return {index & 1 ? bounds.upper.x : bounds.lower.x, index & 2 ? bounds.upper.y : bounds.lower.y,
          index & 4 ? bounds.upper.z : bounds.lower.z};
}

Bounds objectBounds(const Mesh& mesh) {
  Bounds bounds;
  for (const Primitive& primitive : mesh.primitives) {
    for (const glm::vec3 position : primitive.positions) extend(bounds, glm::dvec3(position));
  }
  return bounds;
}

Bounds boxAroundBox(const Bounds& object, const glm::dmat4& worldFromObject) {
  Bounds bounds;
  for (int i = 0; i < 8; ++i) extend(bounds, transformed(worldFromObject, corner(object, i)));
  return bounds;
}

} // namespace

Bounds worldBounds(const Scene& scene) {
  std::vector<Bounds> objects;
  for (const Mesh& mesh : scene.meshes) objects.push_back(objectBounds(mesh));
  Bounds bounds;
  for (const Instance& instance : scene.instances) {
    const Bounds& object = objects[instance.mesh];
    // The exact bounds need every vertex, but most instances of a large scene lie inside of what is already covered.
    if (object.empty() || contains(bounds, boxAroundBox(object, instance.worldFromObject))) continue;
    for (const Primitive& primitive : scene.meshes[instance.mesh].primitives) {
      for (const glm::vec3 position : primitive.positions) {
        extend(bounds, transformed(instance.worldFromObject, glm::dvec3(position)));
      }
    }
  }
  return bounds;
}

Camera framingCamera(const Scene& scene, double aspectRatio) {
  if (!(aspectRatio > 0) || !std::isfinite(aspectRatio))
    throw UsageError("the aspect ratio of a camera has to be above 0");
  Bounds bounds = worldBounds(scene);
  if (bounds.empty()) bounds = {glm::dvec3(-1), glm::dvec3(1)};
  const glm::dvec3 center = 0.5 * (bounds.lower + bounds.upper);

  const glm::dvec3 back = glm::normalize(glm::dvec3(0.7, 0.5, 1.0)); // from the front right, a little above
  const glm::dvec3 right = glm::normalize(glm::cross(glm::dvec3(0, 1, 0), back));
  const glm::dvec3 up = glm::cross(back, right);

  Camera camera;
  camera.name = "framing";
  camera.aspectRatio = aspectRatio;
  const double tanY = std::tan(0.5 * camera.yfov);
  const double tanX = tanY * aspectRatio;
  constexpr double kMargin = 1.05; // a little air around the scene
  double distance = 0;
  for (int i = 0; i < 8; ++i) {
    const glm::dvec3 offset = corner(bounds, i) - center;
    const double sideways = std::max(std::abs(glm::dot(offset, right)) / tanX, std::abs(glm::dot(offset, up)) / tanY);
    distance = std::max(distance, glm::dot(offset, back) + kMargin * sideways);
  }
  // A scene that is a point has no size; any distance that double can tell from the center will do.
  constexpr double kSmallestRelative = 1e-9;
  distance = std::max(distance, kSmallestRelative * std::max(1.0, glm::length(center)));
  camera.worldFromCamera =
      glm::dmat4(glm::dvec4(right, 0), glm::dvec4(up, 0), glm::dvec4(back, 0), glm::dvec4(center + distance * back, 1));
  return camera;
}

} // namespace isophote
