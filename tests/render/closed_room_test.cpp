// Energy in closed rooms, and what many mirrors leave of it.
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "support/render.hpp"
#include "support/scenes.hpp"

namespace isophote {
namespace {

using namespace isophote::test;

// Number 28 of the reliability list: in a closed room of one reflectance rho, whatever its shape, a lamp of flux Phi
// makes a mean radiosity of Phi / (A (1 - rho)). In radiance: Le times the lamp's share of the area, over 1 - rho.
TEST(RenderClosedRoom, Test28MeanRadiosityIsTheFluxOverTheAbsorbingArea) {
  constexpr double kWidth = 3, kHeight = 1, kDepth = 2; // x, y, z
  constexpr float kRho = 0.6f;
  Scene scene;
  const uint32_t wall = addMaterial(scene, lambert(glm::vec3(kRho)));
  const uint32_t lamp = addMaterial(scene, emitter(glm::vec3(5), glm::vec3(kRho)));
  addPrimitive(scene, quad({0, 0, kDepth}, {kWidth, 0, 0}, {0, 0, -kDepth}, wall)); // floor
  addPrimitive(scene, quad({0, 0, 0}, {kWidth, 0, 0}, {0, kHeight, 0}, wall));      // back
  addPrimitive(scene, quad({0, 0, kDepth}, {0, kHeight, 0}, {kWidth, 0, 0}, wall)); // front
  addPrimitive(scene, quad({0, 0, 0}, {0, kHeight, 0}, {0, 0, kDepth}, wall));      // left
  addPrimitive(scene, quad({kWidth, 0, 0}, {0, 0, kDepth}, {0, kHeight, 0}, wall)); // right
  const auto ceiling = [&](double x0, double x1, double z0, double z1, uint32_t material) {
    addPrimitive(scene, quad({x0, kHeight, z0}, {x1 - x0, 0, 0}, {0, 0, z1 - z0}, material));
  };
  ceiling(0, 0.5, 0, kDepth, wall); // around the lamp, which lies in the ceiling's plane
  ceiling(1.5, kWidth, 0, kDepth, wall);
  ceiling(0.5, 1.5, 0, 0.25, wall);
  ceiling(0.5, 1.5, 0.75, kDepth, wall);
  ceiling(0.5, 1.5, 0.25, 0.75, lamp);

  // Six parallel views from the middle, each just as large as its wall: sensors spread evenly over the area, in square
  // pixels.
  const glm::dvec3 middle(kWidth / 2, kHeight / 2, kDepth / 2);
  struct Wall {
    glm::dvec3 towards;
    double halfAcross, halfUp;
  };
  const Wall walls[] = {{{0, 0, -1}, kWidth / 2, kHeight / 2}, {{0, 0, 1}, kWidth / 2, kHeight / 2},
                        {{-1, 0, 0}, kDepth / 2, kHeight / 2}, {{1, 0, 0}, kDepth / 2, kHeight / 2},
                        {{0, -1, 0}, kWidth / 2, kDepth / 2},  {{0, 1, 0}, kWidth / 2, kDepth / 2}};
  constexpr double kPixelArea = 1.0 / 64;
  double area = 0, sum = 0, variance = 0;
  for (const Wall& view : walls) {
    const Camera camera = orthographicLookAt(middle, middle + view.towards, view.halfAcross, view.halfUp);
    const auto columns = static_cast<uint32_t>(16 * view.halfAcross), rows = static_cast<uint32_t>(16 * view.halfUp);
    const MeasuredImage image = measured(renderImage(scene, camera, columns, rows, 512));
    area += 4 * view.halfAcross * view.halfUp;
    for (const auto& pixel : image.pixels) {
      sum += kPixelArea * pixel[1].mean;
      variance += kPixelArea * kPixelArea * pixel[1].variance;
    }
  }
  const double expected = 5 * 0.5 / area / (1 - double(kRho));
  const double halfWidth = normalTwoSidedQuantile(testSignificance()) * std::sqrt(variance) / area;
  EXPECT_LT(halfWidth, kPowerFloor * expected);
  EXPECT_NEAR(sum / area, expected, halfWidth + kRounding * expected);
}

// Number 34: a ray that goes to and fro between two mirrors of reflectance 0.9, k = 1 to 64 times before it meets an
// emitter. One lane, and one pixel, for each k. It comes in at 3 degrees, where Schlick's approximation adds
// less than 1e-15 to normal reflectance.
TEST(RenderClosedRoom, Test34AMirrorCorridorLeavesThePowerOfItsReflectance) {
  constexpr uint32_t kLanes = 64;
  constexpr double kDrift = 0.05; // along the corridor while the ray crosses it once
  constexpr double kLane = 0.01;  // its height, and the width of a pixel: much less than the drift
  constexpr double kHeight = kLanes * kLane;
  Scene scene;
  const uint32_t mirror = addMaterial(scene, metal(glm::vec3(0.9f), 0));
  const uint32_t light = addMaterial(scene, emitter(glm::vec3(1)));
  addPrimitive(scene, quad({0, 0, -1}, {0, kHeight, 0}, {0, 0, 6}, mirror)); // x = 0, faces +x
  addPrimitive(scene, quad({1, 0, -1}, {0, 0, 6}, {0, kHeight, 0}, mirror)); // x = 1, faces -x
  for (uint32_t k = 1; k <= kLanes; ++k) // the ray has bounced k times where it is in the middle again
    addPrimitive(scene, quad({0, (k - 1) * kLane, k * kDrift}, {0, kLane, 0}, {1, 0, 0}, light)); // faces -z
  const glm::dvec3 start(0.5, 0.5 * kHeight, 0);
  const Camera camera = orthographicLookAt(start, start + glm::dvec3(1, 0, kDrift), 0.5 * kLane, 0.5 * kHeight);
  const EstimatorSettings settings{
      .filter = PixelFilter::Box, .maxDepth = 100, .russianRoulette = RussianRoulette::Off};
  const Image image = renderImage(scene, camera, 1, kLanes, 8, {.estimator = settings});
  const std::vector<float> values = plane(image, "G");
  for (uint32_t k = 1; k <= kLanes; ++k) {
    const double expected = std::pow(double(0.9f), k);
    EXPECT_NEAR(values[kLanes - k], expected, 1e-5 * expected) << k << " bounces"; // row 0 is the topmost lane
  }
}

} // namespace
} // namespace isophote
