// Changes of whole test scenes, and environments of one texel.
#include <utility>

#include "support/scenes.hpp"

namespace isophote::test {

Environment oneTexelEnvironment(uint32_t width, uint32_t height, uint32_t x, uint32_t y, glm::vec3 radiance) {
  Environment environment;
  environment.width = width;
  environment.height = height;
  environment.pixels.assign(size_t{width} * height, glm::vec3(0));
  environment.pixels[size_t{y} * width + x] = radiance;
  return environment;
}

namespace {

Primitive transformed(Primitive primitive, const glm::dmat4& worldFromObject) {
  const glm::dmat3 linear(worldFromObject);
  const bool mirrored = glm::determinant(linear) < 0;
  const glm::dmat3 forNormals = glm::transpose(glm::inverse(linear));
  for (glm::vec3& position : primitive.positions)
    position = glm::vec3(worldFromObject * glm::dvec4(glm::dvec3(position), 1));
  for (glm::vec3& normal : primitive.normals) normal = glm::vec3(glm::normalize(forNormals * glm::dvec3(normal)));
  for (glm::vec4& tangent : primitive.tangents) {
    const glm::dvec3 direction = glm::normalize(linear * glm::dvec3(tangent));
    tangent = glm::vec4(glm::vec3(direction), mirrored ? -tangent.w : tangent.w);
  }
  if (mirrored) {
    for (size_t i = 0; i < primitive.indices.size(); i += 3)
      std::swap(primitive.indices[i + 1], primitive.indices[i + 2]);
  }
  return primitive;
}

} // namespace

Scene flattened(const Scene& scene) {
  Scene result = scene;
  result.meshes.clear();
  result.instances.clear();
  for (const Instance& instance : scene.instances) {
    for (const Primitive& primitive : scene.meshes[instance.mesh].primitives)
      addPrimitive(result, transformed(primitive, instance.worldFromObject));
  }
  return result;
}

} // namespace isophote::test
