#include "envelope/scene_parts.hpp"

#include <array>
#include <cmath>
#include <cstring>
#include <utility>

namespace isophote::envelope {

namespace {
constexpr double kPi = 3.14159265358979323846;

glm::dmat4 cameraFrame(glm::dvec3 position, glm::dvec3 target) {
  const glm::dvec3 back = glm::normalize(position - target);
  const glm::dvec3 helper = std::abs(back.y) < 0.999 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, -1);
  const glm::dvec3 right = glm::normalize(glm::cross(helper, back));
  const glm::dvec3 up = glm::cross(back, right);
  return {glm::dvec4(right, 0), glm::dvec4(up, 0), glm::dvec4(back, 0), glm::dvec4(position, 1)};
}
} // namespace

Material lambert(glm::vec3 reflectance) {
  Material material;
  material.baseColor = glm::vec4(reflectance, 1);
  material.metallic = 0;
  material.specular = 0;
  return material;
}

Material emitter(glm::vec3 radiance, glm::vec3 reflectance) {
  Material material = lambert(reflectance);
  material.emissive = radiance;
  return material;
}

Material metal(glm::vec3 baseColor, float roughness) {
  Material material;
  material.baseColor = glm::vec4(baseColor, 1);
  material.metallic = 1;
  material.roughness = roughness;
  return material;
}

Material dielectric(glm::vec3 baseColor, float roughness) {
  Material material = metal(baseColor, roughness);
  material.metallic = 0;
  return material;
}

Material thinGlass(float roughness) {
  Material material = dielectric(glm::vec3(1), roughness);
  material.transmission.factor = 1;
  return material;
}

Material glass(float roughness, float ior) {
  Material material = thinGlass(roughness);
  material.ior = ior;
  material.volume.thickness = 1;
  return material;
}

Primitive quad(glm::dvec3 corner, glm::dvec3 edgeU, glm::dvec3 edgeV, uint32_t material) {
  Primitive primitive;
  primitive.positions = {glm::vec3(corner), glm::vec3(corner + edgeU), glm::vec3(corner + edgeU + edgeV),
                         glm::vec3(corner + edgeV)};
  primitive.uvs[0] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  primitive.indices = {0, 1, 2, 0, 2, 3};
  primitive.material = material;
  return primitive;
}

Primitive facingQuad(double halfWidth, double halfHeight, uint32_t material) {
  Primitive primitive = quad({-halfWidth, -halfHeight, 0}, {2 * halfWidth, 0, 0}, {0, 2 * halfHeight, 0}, material);
  primitive.uvs[0] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  primitive.normals.assign(4, glm::vec3(0, 0, 1));
  primitive.tangents.assign(4, glm::vec4(1, 0, 0, 1));
  return primitive;
}

Primitive box(glm::dvec3 lower, glm::dvec3 upper, bool inward, uint32_t material) {
  Primitive primitive;
  for (int corner = 0; corner < 8; ++corner)
    primitive.positions.emplace_back(corner & 1 ? upper.x : lower.x, corner & 2 ? upper.y : lower.y,
                                     corner & 4 ? upper.z : lower.z);
  // Counter-clockwise from outside: -x, +x, -y, +y, -z, +z.
  constexpr std::array<std::array<uint32_t, 4>, 6> kFaces{
      {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
  for (const auto& face : kFaces) {
    for (const size_t i : {0, 1, 2, 0, 2, 3}) primitive.indices.push_back(face[i]);
  }
  if (inward) {
    for (size_t i = 0; i < primitive.indices.size(); i += 3)
      std::swap(primitive.indices[i + 1], primitive.indices[i + 2]);
  }
  primitive.material = material;
  return primitive;
}

Primitive sphere(double radius, uint32_t rings, bool smooth, bool inward, uint32_t material) {
  Primitive primitive;
  const uint32_t columns = 2 * rings;
  const double side = inward ? -1 : 1;
  for (uint32_t row = 0; row <= rings; ++row) {
    const double theta = kPi * row / rings;
    for (uint32_t column = 0; column <= columns; ++column) {
      const double phi = 2 * kPi * (column % columns) / columns;
      const double ring = row == 0 || row == rings ? 0 : std::sin(theta);
      const glm::dvec3 normal(ring * std::cos(phi), std::cos(theta), -ring * std::sin(phi));
      primitive.positions.emplace_back(radius * normal);
      primitive.uvs[0].emplace_back(static_cast<double>(column) / columns, static_cast<double>(row) / rings);
      if (smooth) primitive.normals.emplace_back(side * normal);
    }
  }
  const auto triangle = [&](uint32_t a, uint32_t b, uint32_t c) {
    primitive.indices.insert(primitive.indices.end(), {a, inward ? c : b, inward ? b : c});
  };
  for (uint32_t row = 0; row < rings; ++row) {
    for (uint32_t column = 0; column < columns; ++column) {
      const uint32_t upper = row * (columns + 1) + column, lower = upper + columns + 1;
      if (row + 1 < rings) triangle(upper, lower, lower + 1); // at the poles one edge of a cell has no length
      if (row > 0) triangle(upper, lower + 1, upper + 1);
    }
  }
  primitive.material = material;
  return primitive;
}

uint32_t addMaterial(Scene& scene, const Material& material) {
  scene.materials.push_back(material);
  return static_cast<uint32_t>(scene.materials.size() - 1);
}

uint32_t addPrimitive(Scene& scene, Primitive primitive, const glm::dmat4& worldFromObject) {
  const auto mesh = static_cast<uint32_t>(scene.meshes.size());
  scene.meshes.push_back({.name = {}, .primitives = {std::move(primitive)}});
  scene.instances.push_back({.mesh = mesh, .worldFromObject = worldFromObject, .name = {}});
  return mesh;
}

uint32_t addTexture(Scene& scene, uint32_t width, uint32_t height, const std::vector<glm::u8vec4>& texels,
                    Filter filter, Wrap wrap) {
  ImageData image;
  image.width = width;
  image.height = height;
  image.pixels.resize(texels.size() * 4);
  std::memcpy(image.pixels.data(), texels.data(), image.pixels.size());
  scene.images.push_back(std::move(image));
  scene.textures.push_back(
      {.image = static_cast<uint32_t>(scene.images.size() - 1), .wrapS = wrap, .wrapT = wrap, .filter = filter});
  return static_cast<uint32_t>(scene.textures.size() - 1);
}

TextureRef useTexture(uint32_t texture) {
  TextureRef reference;
  reference.texture = static_cast<int32_t>(texture);
  return reference;
}

Environment constantEnvironment(glm::vec3 radiance) {
  Environment environment;
  environment.width = environment.height = 1;
  environment.pixels = {radiance};
  return environment;
}

Camera lookAt(glm::dvec3 position, glm::dvec3 target, double yfov) {
  Camera camera;
  camera.yfov = yfov;
  camera.worldFromCamera = cameraFrame(position, target);
  return camera;
}

Camera orthographicLookAt(glm::dvec3 position, glm::dvec3 target, double halfWidth, double halfHeight) {
  Camera camera;
  camera.kind = CameraKind::Orthographic;
  camera.xmag = halfWidth;
  camera.ymag = halfHeight;
  camera.worldFromCamera = cameraFrame(position, target);
  return camera;
}

Scene boxFurnace(glm::vec3 Le, glm::vec3 rho) {
  Scene scene;
  scene.name = "box furnace";
  const uint32_t walls = addMaterial(scene, emitter(Le, rho));
  addPrimitive(scene, box({-1, -0.8, -1.5}, {1, 0.8, 1.5}, true, walls));
  return scene;
}

Camera boxFurnaceCamera() { return lookAt({0.31, -0.17, 0.9}, {-0.2, 0.13, -0.6}, 1.2); }

Scene squareLightOverFloor(float Le) {
  Scene scene;
  scene.name = "square light";
  const uint32_t floor = addMaterial(scene, lambert(glm::vec3(1)));
  const uint32_t light = addMaterial(scene, emitter(glm::vec3(Le)));
  addPrimitive(scene, quad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, floor));
  addPrimitive(scene, quad({-0.5, 1, -0.5}, {1, 0, 0}, {0, 0, 1}, light));
  return scene;
}

Camera sensorAt(glm::dvec3 point) {
  Camera camera = orthographicLookAt(point + glm::dvec3(0, 0.5, 0), point, 1e-6, 1e-6);
  return camera;
}

Scene lambertFloor(glm::vec3 rho, double halfSize) {
  Scene scene;
  scene.name = "floor";
  const uint32_t floor = addMaterial(scene, lambert(rho));
  addPrimitive(scene, quad({-halfSize, 0, halfSize}, {2 * halfSize, 0, 0}, {0, 0, -2 * halfSize}, floor));
  return scene;
}

} // namespace isophote::envelope
