#include "oracle/triangle_soup.hpp"

namespace isophote::oracle {

namespace {

void appendPrimitive(const Scene& scene, uint32_t instance, uint32_t primitive, std::vector<Triangle>& triangles) {
  const glm::dmat4& worldFromObject = scene.instances[instance].worldFromObject;
  const double front = glm::determinant(glm::dmat3(worldFromObject)) < 0 ? -1 : 1;
  const Primitive& source = scene.meshes[scene.instances[instance].mesh].primitives[primitive];
  const auto vertex = [&](size_t corner) {
    return glm::dvec3(worldFromObject * glm::dvec4(glm::dvec3(source.positions[source.indices[corner]]), 1));
  };
  for (size_t corner = 0; corner + 2 < source.indices.size(); corner += 3) {
    Triangle triangle;
    triangle.v0 = vertex(corner);
    triangle.edge1 = vertex(corner + 1) - triangle.v0;
    triangle.edge2 = vertex(corner + 2) - triangle.v0;
    const glm::dvec3 normal = glm::cross(triangle.edge1, triangle.edge2);
    const double length = glm::length(normal);
    if (!(length > 0)) continue;
    triangle.ng = normal * (front / length);
    triangle.area = length / 2;
    triangle.instance = instance;
    triangle.primitive = primitive;
    triangle.index = static_cast<uint32_t>(corner / 3);
    triangle.material = source.material;
    triangle.opaque = scene.materials[source.material].alphaMode == AlphaMode::Opaque;
    triangles.push_back(triangle);
  }
}

} // namespace

std::vector<Triangle> flattenScene(const Scene& scene) {
  std::vector<Triangle> triangles;
  for (uint32_t instance = 0; instance < scene.instances.size(); ++instance) {
    const size_t primitives = scene.meshes[scene.instances[instance].mesh].primitives.size();
    for (uint32_t primitive = 0; primitive < primitives; ++primitive)
      appendPrimitive(scene, instance, primitive, triangles);
  }
  return triangles;
}

} // namespace isophote::oracle
