// Depth of field and panoramas.
#include <cmath>

#include <gtest/gtest.h>

#include "support/render.hpp"
#include "support/scenes.hpp"

namespace isophote {
namespace {

using namespace isophote::test;

constexpr double kPi = 3.14159265358979323846;

constexpr uint32_t kSize = 32;
constexpr double kHalfSide = 0.1; // of the emitter
constexpr double kDepth = 4;

/// A square of radiance 1 on the axis of a camera with a lens of radius 1 whose image is 1 wide at distance 1.
Scene glowingSquare() {
  Scene scene;
  const uint32_t material = addMaterial(scene, emitter(glm::vec3(1)));
  addPrimitive(scene, quad({-kHalfSide, -kHalfSide, -kDepth}, {2 * kHalfSide, 0, 0}, {0, 2 * kHalfSide, 0}, material));
  return scene;
}

Camera lensCamera(double focusDistance) {
  Camera camera;
  camera.yfov = 2 * std::atan(0.5);
  camera.lensRadius = 1;
  camera.focusDistance = focusDistance;
  return camera;
}

/// Where the middle of a pixel lies, in units of the image's width at distance 1.
glm::dvec2 tangents(size_t pixel) {
  return {(static_cast<double>(pixel % kSize) + 0.5) / kSize - 0.5,
          0.5 - (static_cast<double>(pixel / kSize) + 0.5) / kSize};
}

// A point at depth z is blurred to the aperture's shape scaled by |1/f - 1/z| (tangents). The emitter's side adds
// kHalfSide / z and a pixel 1 / kSize.
constexpr double kFocus = 2;
constexpr double kBlur = 1 / kFocus - 1 / kDepth;
constexpr double kMargin = 1.5 * (kHalfSide / kDepth + 0.5 / kSize);

/// A pixel well within the blur sees the emitter through the share of the lens that its area is of the lens's image in
/// its plane; none beyond the blur sees it; and the sum over the image does not depend on the blur's shape.
/// @param inside  how far a point is inside of the aperture's shape of radius 1, negative outside
template <class Inside> void expectBlur(const Camera& camera, double apertureArea, Inside inside) {
  const Image image = renderImage(glowingSquare(), camera, kSize, kSize, 4096);
  const std::vector<float> values = plane(image, "R"), errors = plane(image, "stderr.R");
  const double lensImage = apertureArea * std::pow(1 - kDepth / kFocus, 2);
  const double expected = 4 * kHalfSide * kHalfSide / lensImage;
  double sum = 0, variance = 0;
  Moments within;
  for (size_t i = 0; i < values.size(); ++i) {
    sum += values[i];
    variance += double{errors[i]} * errors[i];
    const double depth = kBlur * inside(tangents(i) / kBlur);
    if (depth > kMargin) within.add(values[i]);
    if (depth < -kMargin) {
      ASSERT_EQ(values[i], 0) << i % kSize << "," << i / kSize;
    }
  }
  ASSERT_GT(within.count(), 30u);
  EXPECT_TRUE(meanIs(within, expected, 0.06));
  const double total = expected * apertureArea * kBlur * kBlur * kSize * kSize;
  EXPECT_NEAR(sum, total, 4.5 * std::sqrt(variance));
  EXPECT_LT(4.5 * std::sqrt(variance), 0.03 * total);
}

TEST(RenderCamera, APointOutOfFocusIsADiskOfTheThinLensFormulasSize) {
  expectBlur(lensCamera(kFocus), kPi, [](glm::dvec2 p) { return 1 - glm::length(p); });
}

TEST(RenderCamera, StraightBladesMakeTheBlurAPolygon) {
  for (const double rotation : {0.0, 0.3}) {
    Camera camera = lensCamera(kFocus);
    camera.apertureBlades = 5;
    camera.apertureRotation = rotation;
    // From lens point l a point on the axis appears at l (1/f - 1/z): beyond the plane in focus the blur is the
    // aperture's own shape, neither turned nor mirrored.
    expectBlur(camera, 2.5 * std::sin(2 * kPi / 5), [&](glm::dvec2 p) {
      double least = 1;
      for (int i = 0; i < 5; ++i) {
        const double middle = rotation + kPi * (2 * i + 1) / 5;
        least = std::min(least, std::cos(kPi / 5) - glm::dot(p, {std::cos(middle), std::sin(middle)}));
      }
      return least;
    });
  }
}

TEST(RenderCamera, WhatLiesInThePlaneOfFocusIsSharp) {
  const Image image = renderImage(glowingSquare(), lensCamera(kDepth), kSize, kSize, 64);
  const std::vector<float> values = plane(image, "R");
  for (size_t i = 0; i < values.size(); ++i) {
    const glm::dvec2 p = glm::abs(tangents(i)) - kHalfSide / kDepth;
    const double outside = std::max(p.x, p.y);
    if (std::abs(outside) > 0.5 / kSize) {
      ASSERT_EQ(values[i], outside < 0 ? 1 : 0) << i;
    }
  }
}

TEST(RenderCamera, LensesMatchTheReference) {
  const Scene scene = cornellBox();
  Camera perspective = cornellCamera();
  perspective.lensRadius = 0.05;
  perspective.focusDistance = 1.1;
  perspective.apertureBlades = 6;
  perspective.apertureRotation = 0.4;
  Camera parallel = orthographicLookAt({0.278, 0.273, -0.8}, {0.278, 0.273, 0.2}, 0.25, 0.25);
  parallel.lensRadius = 0.1;
  parallel.focusDistance = 1.0;
  for (const Camera& camera : {perspective, parallel}) {
    const Image image =
        renderImage(scene, camera, 16, 16, 1024, {.estimator = {.filter = PixelFilter::Box, .maxDepth = 1}});
    const auto reference = oracle::renderReference(scene, camera, 16, 16, 1024, {.maxDepth = 1});
    EXPECT_TRUE(sameImage(measured(image), measured(reference), {.powerFloor = 0.08}));
  }
}

TEST(RenderCamera, APanoramaMatchesTheReference) {
  Scene scene = cornellBox();
  scene.environment = oneTexelEnvironment(16, 8, 5, 3, {3, 2, 1}); // seen through the open side
  Camera camera = cornellCamera();
  camera.kind = CameraKind::Panorama;
  camera.worldFromCamera[3] = glm::dvec4(0.2, 0.25, 0.1, 1);
  const Image image =
      renderImage(scene, camera, 32, 16, 512, {.estimator = {.filter = PixelFilter::Box, .maxDepth = 1}});
  const auto reference = oracle::renderReference(scene, camera, 32, 16, 512, {.maxDepth = 1});
  EXPECT_TRUE(sameImage(measured(image), measured(reference), {.powerFloor = 0.05}));
}

TEST(RenderCamera, APanoramaOfAnEnvironmentIsTheEnvironmentsMap) {
  Scene scene;
  scene.environment = oneTexelEnvironment(16, 8, 5, 3, {8, 0, 0});
  Camera camera;
  camera.kind = CameraKind::Panorama;
  const Image image = renderImage(scene, camera, 16, 8, 64, {.estimator = {.filter = PixelFilter::Box}});
  const std::vector<float> values = plane(image, "R");
  // The map is read bilinearly: averaged over a pixel, the tent of a texel keeps 3/4 and 3/4.
  EXPECT_NEAR(values[3 * 16 + 5], 8 * 0.5625, 0.1);
  for (size_t i = 0; i < values.size(); ++i) {
    const int dx = static_cast<int>(i % 16) - 5, dy = static_cast<int>(i / 16) - 3;
    if (std::abs(dx) > 1 || std::abs(dy) > 1) {
      ASSERT_EQ(values[i], 0) << i;
    }
  }
}

TEST(RenderCamera, APanoramaOfAConstantIsConstantToItsBorders) {
  Scene scene;
  scene.environment = constantEnvironment({0.25f, 1, 3});
  Camera camera;
  camera.kind = CameraKind::Panorama;
  const Image image = renderImage(scene, camera, 17, 9, 16);
  for (const float value : plane(image, "R")) ASSERT_NEAR(value, 0.25, 0.25e-6);
  for (const float value : plane(image, "B")) ASSERT_NEAR(value, 3, 3e-6);
}

TEST(RenderCamera, SpecializedKernelsGiveTheImageOfThoseWithAllFeatures) {
  const Scene scene = cornellBox();
  Camera lens = cornellCamera();
  lens.lensRadius = 0.05;
  lens.focusDistance = 1;
  Camera panorama = cornellCamera();
  panorama.kind = CameraKind::Panorama;
  for (const Camera& camera : {cornellCamera(), lens, panorama}) {
    RenderOptions options;
    const Image specialized = renderImage(scene, camera, 16, 12, 8, options);
    options.execution.specialize = false;
    EXPECT_TRUE(bitIdentical(specialized, renderImage(scene, camera, 16, 12, 8, options)));
  }
}

} // namespace
} // namespace isophote
