// The one test scene with every kind of texture use.
#include "support/scenes.hpp"

#include <glm/gtc/matrix_transform.hpp>

namespace isophote::test {

namespace {

std::vector<glm::u8vec4> colorTexels() {
  return {{255, 40, 40, 255},  {40, 255, 40, 255},  {40, 40, 255, 255},   {200, 200, 30, 255},
          {30, 200, 200, 255}, {200, 30, 200, 255}, {128, 128, 128, 255}, {250, 250, 250, 255}};
}

/// Tilts of up to 35 degrees; z kept positive.
std::vector<glm::u8vec4> normalTexels() {
  return {{200, 128, 232, 255}, {128, 200, 232, 255}, {56, 128, 232, 255}, {128, 56, 232, 255}};
}

std::vector<glm::u8vec4> roughnessTexels() {
  return {{0, 100, 255, 255}, {0, 255, 255, 255}, {0, 180, 0, 255}, {0, 255, 128, 255}};
}

std::vector<glm::u8vec4> cutoutTexels() {
  return {{255, 255, 255, 255}, {255, 255, 255, 20}, {255, 255, 255, 60}, {255, 255, 255, 230}};
}

glm::dmat4 at(double x, double y, double z) { return glm::translate(glm::dmat4(1), {x, y, z}); }

} // namespace

Scene texturedStillLife() {
  Scene scene;
  scene.name = "textured still life";
  Environment environment = oneTexelEnvironment(4, 2, 1, 0, {6, 5, 4});
  for (glm::vec3& pixel : environment.pixels) pixel += glm::vec3(0.4f, 0.5f, 0.6f);
  environment.rotation = 0.4;
  scene.environment = environment;

  Material painted = lambert(glm::vec3(1));
  painted.baseColorTexture = useTexture(addTexture(scene, 4, 2, colorTexels()));
  painted.baseColorTexture.uRow = {1.5f, 0, 0.1f};
  painted.baseColorTexture.vRow = {0, 2, -0.2f};
  addPrimitive(scene, facingQuad(0.9, 0.9, addMaterial(scene, painted)), at(-2, 1, 0));

  Material embossed = metal({0.9f, 0.8f, 0.7f}, 0.6f);
  embossed.normalTexture = useTexture(addTexture(scene, 2, 2, normalTexels(), Filter::Linear, Wrap::MirroredRepeat));
  embossed.normalTexture.scale = 0.8f;
  embossed.metallicRoughnessTexture = useTexture(addTexture(scene, 2, 2, roughnessTexels(), Filter::Nearest));
  addPrimitive(scene, facingQuad(0.9, 0.9, addMaterial(scene, embossed)), at(0, 1, 0));

  Primitive colored = facingQuad(0.9, 0.9, addMaterial(scene, lambert({0.9f, 0.9f, 0.9f})));
  colored.colors = {{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 1}, {1, 1, 0.2f, 1}};
  addPrimitive(scene, colored, glm::rotate(at(2, 1, 0), -0.5, glm::dvec3(0, 1, 0)));

  Material screen = emitter({1.5f, 1.5f, 1.5f}, glm::vec3(0.2f));
  screen.emissiveTexture = useTexture(addTexture(scene, 4, 2, colorTexels(), Filter::Nearest, Wrap::ClampToEdge));
  addPrimitive(scene, facingQuad(0.9, 0.9, addMaterial(scene, screen)), at(-2, -1, 0));

  Material cutout = lambert({0.8f, 0.7f, 0.2f});
  cutout.baseColorTexture = useTexture(addTexture(scene, 2, 2, cutoutTexels(), Filter::Nearest));
  cutout.alphaMode = AlphaMode::Mask;
  addPrimitive(scene, facingQuad(0.9, 0.9, addMaterial(scene, cutout)), at(0, -1, 0.3));

  Material veil = lambert({0.2f, 0.4f, 0.9f});
  veil.baseColor.w = 0.6f;
  veil.alphaMode = AlphaMode::Blend;
  addPrimitive(scene, facingQuad(0.9, 0.9, addMaterial(scene, veil)), at(2, -1, 0.3));

  // The floor passes light and shadow between all of them.
  addPrimitive(scene, quad({-4, -2.1, 3}, {8, 0, 0}, {0, 0, -5}, addMaterial(scene, lambert(glm::vec3(0.7f)))));
  return scene;
}

Camera texturedStillLifeCamera() { return lookAt({0.3, 0.2, 6}, {0, -0.2, 0}, 0.9); }

} // namespace isophote::test
