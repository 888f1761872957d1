#include "support/scenes.hpp"

#include <array>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

namespace isophote::test {

Scene sphereWithPointLight(float intensity, float rho, uint32_t rings) {
  Scene scene;
  scene.name = "sphere with point light";
  const uint32_t wall = addMaterial(scene, lambert(glm::vec3(rho)));
  addPrimitive(scene, sphere(1, rings, false, true, wall));
  PunctualLight light;
  light.intensity = glm::vec3(intensity);
  scene.lights.push_back(light);
  return scene;
}

namespace {

using Quad = std::array<glm::dvec3, 4>;

void addCornellQuad(Scene& scene, const Quad& corners, uint32_t material) {
  Primitive primitive;
  for (const glm::dvec3& corner : corners) primitive.positions.emplace_back(corner / 1000.0); // mm to m
  primitive.indices = {0, 1, 2, 0, 2, 3};
  primitive.material = material;
  addPrimitive(scene, primitive);
}

constexpr std::array<Quad, 3> kCornellWhite{{
    {{{552.8, 0, 0}, {0, 0, 0}, {0, 0, 559.2}, {549.6, 0, 559.2}}},               // floor
    {{{556, 548.8, 0}, {556, 548.8, 559.2}, {0, 548.8, 559.2}, {0, 548.8, 0}}},   // ceiling
    {{{549.6, 0, 559.2}, {0, 0, 559.2}, {0, 548.8, 559.2}, {556, 548.8, 559.2}}}, // back
}};
constexpr Quad kCornellGreen{{{0, 0, 559.2}, {0, 0, 0}, {0, 548.8, 0}, {0, 548.8, 559.2}}};
constexpr Quad kCornellRed{{{552.8, 0, 0}, {549.6, 0, 559.2}, {556, 548.8, 559.2}, {556, 548.8, 0}}};
// In the data the light lies in the ceiling's plane, which has a hole there; here it hangs 1 mm below a whole ceiling.
constexpr Quad kCornellLight{{{343, 547.8, 227}, {343, 547.8, 332}, {213, 547.8, 332}, {213, 547.8, 227}}};
constexpr std::array<Quad, 5> kCornellShortBlock{{
    {{{130, 165, 65}, {82, 165, 225}, {240, 165, 272}, {290, 165, 114}}},
    {{{290, 0, 114}, {290, 165, 114}, {240, 165, 272}, {240, 0, 272}}},
    {{{130, 0, 65}, {130, 165, 65}, {290, 165, 114}, {290, 0, 114}}},
    {{{82, 0, 225}, {82, 165, 225}, {130, 165, 65}, {130, 0, 65}}},
    {{{240, 0, 272}, {240, 165, 272}, {82, 165, 225}, {82, 0, 225}}},
}};
constexpr std::array<Quad, 5> kCornellTallBlock{{
    {{{423, 330, 247}, {265, 330, 296}, {314, 330, 456}, {472, 330, 406}}},
    {{{423, 0, 247}, {423, 330, 247}, {472, 330, 406}, {472, 0, 406}}},
    {{{472, 0, 406}, {472, 330, 406}, {314, 330, 456}, {314, 0, 456}}},
    {{{314, 0, 456}, {314, 330, 456}, {265, 330, 296}, {265, 0, 296}}},
    {{{265, 0, 296}, {265, 330, 296}, {423, 330, 247}, {423, 0, 247}}},
}};

} // namespace

Scene cornellBox() {
  Scene scene;
  scene.name = "Cornell box";
  // RGB stand-ins for the measured spectra, as pbrt's and Mitsuba's versions of the scene have them to two digits.
  const uint32_t white = addMaterial(scene, lambert({0.73f, 0.71f, 0.68f}));
  const uint32_t red = addMaterial(scene, lambert({0.63f, 0.06f, 0.05f}));
  const uint32_t green = addMaterial(scene, lambert({0.14f, 0.45f, 0.09f}));
  const uint32_t light = addMaterial(scene, emitter({18.4f, 15.6f, 8.0f}, glm::vec3(0.78f)));
  for (const Quad& corners : kCornellWhite) addCornellQuad(scene, corners, white);
  for (const Quad& corners : kCornellShortBlock) addCornellQuad(scene, corners, white);
  for (const Quad& corners : kCornellTallBlock) addCornellQuad(scene, corners, white);
  addCornellQuad(scene, kCornellRed, red);
  addCornellQuad(scene, kCornellGreen, green);
  addCornellQuad(scene, kCornellLight, light);
  return scene;
}

Camera cornellCamera() {
  // Focal length 35 mm, film 25 mm.
  return lookAt({0.278, 0.273, -0.8}, {0.278, 0.273, 0}, 2 * std::atan(0.0125 / 0.035));
}

Scene materialSpheres() {
  Scene scene;
  scene.name = "material spheres";
  scene.environment = constantEnvironment({0.8f, 1.0f, 1.2f});
  constexpr std::array<float, 4> kRoughness{0.0f, 0.3f, 0.6f, 1.0f};
  for (size_t i = 0; i < kRoughness.size(); ++i) {
    const double x = -3.3 + 2.2 * static_cast<double>(i);
    const uint32_t gold = addMaterial(scene, metal({1.0f, 0.77f, 0.34f}, kRoughness[i]));
    const uint32_t plastic = addMaterial(scene, dielectric({0.2f, 0.5f, 0.8f}, kRoughness[i]));
    addPrimitive(scene, sphere(1, 8, true, false, gold), glm::translate(glm::dmat4(1), {x, 1.1, 0}));
    addPrimitive(scene, sphere(1, 8, true, false, plastic), glm::translate(glm::dmat4(1), {x, -1.1, 0}));
  }
  return scene;
}

Camera materialSpheresCamera() { return orthographicLookAt({0, 0, 10}, {0, 0, 0}, 4.6, 2.3); }

Scene ballsOf(const std::vector<Material>& materials) {
  Scene scene = lambertFloor(glm::vec3(0.5f), 4);
  for (size_t i = 0; i < materials.size(); ++i) {
    Primitive ball = sphere(0.5, 16, true, false, addMaterial(scene, materials[i]));
    for (const glm::vec3 normal : ball.normals) { // along the parallels
      const glm::vec3 east = glm::cross(glm::vec3(0, 1, 0), normal);
      ball.tangents.emplace_back(glm::length(east) > 1e-3f ? glm::normalize(east) : glm::vec3(1, 0, 0), 1);
    }
    addPrimitive(scene, ball,
                 glm::translate(glm::dmat4(1), {1.1 * (double(i) - 0.5 * double(materials.size() - 1)), 0.5, 0}));
  }
  const uint32_t panel = addMaterial(scene, emitter({6, 5, 4}));
  addPrimitive(scene, quad({-1, 2.5, 1}, {2, 0, 0}, {0, 0, 1}, panel));
  scene.environment = constantEnvironment({0.3f, 0.4f, 0.5f});
  return scene;
}

Camera ballsCamera() { return lookAt({0, 1.2, 4}, {0, 0.5, 0}, 0.6); }

Scene floorUnderASphere(float radius) {
  Scene scene = lambertFloor(glm::vec3(1), 2);
  PunctualLight light;
  light.position = {0, 2, 0};
  light.intensity = glm::vec3(3.14159265f);
  light.radius = radius;
  scene.lights.push_back(light);
  return scene;
}

Scene floorUnderAHalfBrightSky() {
  Environment sky;
  sky.width = 64;
  sky.height = 32;
  for (uint32_t i = 0; i < sky.width * sky.height; ++i)
    sky.pixels.emplace_back(i % sky.width < sky.width / 2 ? 3.0f : 1.0f);
  Scene scene = lambertFloor(glm::vec3(0.5f), 2);
  scene.environment = sky;
  return scene;
}

Scene alphaLayers(uint32_t layers, float alpha) {
  Scene scene;
  scene.name = "alpha layers";
  const uint32_t white = addMaterial(scene, emitter(glm::vec3(1)));
  Material sheet = lambert(glm::vec3(0));
  sheet.baseColor.w = alpha;
  sheet.alphaMode = AlphaMode::Blend;
  const uint32_t black = addMaterial(scene, sheet);
  addPrimitive(scene, facingQuad(1, 1, white));
  for (uint32_t layer = 0; layer < layers; ++layer)
    addPrimitive(scene, facingQuad(1, 1, black), glm::translate(glm::dmat4(1), {0, 0, 0.1 + 0.1 * layer}));
  return scene;
}

Scene instanceGrid() {
  Scene scene;
  scene.name = "instance grid";
  const uint32_t floor = addMaterial(scene, lambert({0.6f, 0.6f, 0.6f}));
  const uint32_t body = addMaterial(scene, lambert({0.8f, 0.3f, 0.2f}));
  const uint32_t lamp = addMaterial(scene, emitter({2.0f, 2.5f, 3.0f}, glm::vec3(0.3f)));
  const uint32_t sky = addMaterial(scene, emitter(glm::vec3(4)));
  addPrimitive(scene, quad({-4, 0, 4}, {8, 0, 0}, {0, 0, -8}, floor));
  addPrimitive(scene, quad({-2, 5, -2}, {4, 0, 0}, {0, 0, 4}, sky));
  // A slanted block with a lamp on its +x side only: mirroring and rotation are seen in the light it throws.
  Mesh mesh;
  mesh.primitives.push_back(box({-0.4, 0.0, -0.3}, {0.4, 1.0, 0.3}, false, body));
  mesh.primitives.push_back(quad({0.41, 0.3, 0.2}, {0, 0, -0.4}, {0, 0.5, 0}, lamp));
  const auto block = static_cast<uint32_t>(scene.meshes.size());
  scene.meshes.push_back(mesh);
  const glm::dmat4 one(1);
  const std::array<glm::dmat4, 5> places{
      glm::translate(one, {-2, 0, 0}),
      glm::rotate(glm::translate(one, {2, 0, 0.5}), 2.0, glm::dvec3(0, 1, 0)),
      glm::scale(glm::translate(one, {0, 0, 1}), glm::dvec3(-1, 1, 1)),
      glm::scale(glm::translate(one, {0, 0, -2}), glm::dvec3(1.5)),
      glm::scale(glm::rotate(glm::translate(one, {-2.2, 0, 2.2}), 0.7, glm::dvec3(0, 1, 0)), glm::dvec3(0.5, 2, -0.8)),
  };
  for (const glm::dmat4& place : places)
    scene.instances.push_back({.mesh = block, .worldFromObject = place, .name = {}});
  return scene;
}

Camera instanceGridCamera() { return lookAt({2.5, 4.5, 7.5}, {0, 0.4, 0}, 0.8); }

Scene punctualStillLife() {
  Scene scene = lambertFloor({0.7f, 0.65f, 0.6f}, 4);
  scene.name = "punctual lights";
  const uint32_t red = addMaterial(scene, lambert({0.8f, 0.2f, 0.2f}));
  const uint32_t plastic = addMaterial(scene, dielectric({0.2f, 0.6f, 0.3f}, 0.6f));
  addPrimitive(scene, box({-1.6, 0, -0.5}, {-0.6, 1, 0.5}, false, red));
  addPrimitive(scene, sphere(0.7, 8, true, false, plastic), glm::translate(glm::dmat4(1), {1, 0.7, 0}));
  PunctualLight point;
  point.kind = LightKind::Point;
  point.intensity = {4, 4, 5};
  point.position = {0, 2, 1};
  PunctualLight spot;
  spot.kind = LightKind::Spot;
  spot.intensity = {20, 15, 10};
  spot.position = {-2, 3, 2};
  spot.direction = glm::normalize(glm::dvec3(1.5, -3, -2));
  spot.innerConeAngle = 0.2f;
  spot.outerConeAngle = 0.5f;
  spot.range = 8;
  PunctualLight sun;
  sun.kind = LightKind::Directional;
  sun.intensity = {0.5f, 0.6f, 0.9f};
  sun.direction = glm::normalize(glm::dvec3(-0.5, -1, -0.2));
  scene.lights = {point, spot, sun};
  return scene;
}

Camera punctualStillLifeCamera() { return lookAt({0, 2.5, 6}, {0, 0.5, 0}, 0.8); }

} // namespace isophote::test
