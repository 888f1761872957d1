#include "viewer/orbit_camera.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace isophote::viewer {
namespace {

constexpr double kTolerance = 1e-12; // a few dozen rounding errors of doubles near 1

const Bounds kBounds{.lower = glm::dvec3(-1, 0, -1), .upper = glm::dvec3(1, 2, 1)};
const glm::dvec3 kCenter(0, 1, 0);

Camera lookingAtCenter(glm::dvec3 position) {
  const glm::dvec3 back = glm::normalize(position - kCenter);
  const glm::dvec3 right = glm::normalize(glm::cross(glm::dvec3(0, 1, 0), back));
  Camera camera;
  camera.worldFromCamera = glm::dmat4(glm::dvec4(right, 0), glm::dvec4(glm::cross(back, right), 0), glm::dvec4(back, 0),
                                      glm::dvec4(position, 1));
  return camera;
}

double largestDifference(const glm::dmat4& a, const glm::dmat4& b) {
  double largest = 0;
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row) largest = std::max(largest, std::abs(a[column][row] - b[column][row]));
  }
  return largest;
}

glm::dvec3 position(const Camera& camera) { return glm::dvec3(camera.worldFromCamera[3]); }

/// Where a world point lands: x right and y down in window heights from the middle.
glm::dvec2 onScreen(const Camera& camera, glm::dvec3 point) {
  const glm::dvec3 local(glm::inverse(camera.worldFromCamera) * glm::dvec4(point, 1));
  const double halfHeight =
      camera.kind == CameraKind::Perspective ? -local.z * std::tan(0.5 * camera.yfov) : camera.ymag;
  return {0.5 * local.x / halfHeight, -0.5 * local.y / halfHeight};
}

} // namespace

TEST(OrbitCamera, StartsAtAnUprightCamera) {
  for (const glm::dvec3 from : {glm::dvec3(0, 1, 5), glm::dvec3(3, 4, -2), glm::dvec3(-7, -6, 0.1)}) {
    const Camera start = lookingAtCenter(from);
    EXPECT_LT(largestDifference(OrbitCamera(start, kBounds).camera(1.5).worldFromCamera, start.worldFromCamera),
              10 * kTolerance);
  }
}

TEST(OrbitCamera, StartsAtACameraThatLooksStraightDown) {
  Camera start;
  const double turn = 0.7;
  start.worldFromCamera =
      glm::dmat4(glm::dvec4(std::cos(turn), 0, -std::sin(turn), 0), glm::dvec4(-std::sin(turn), 0, -std::cos(turn), 0),
                 glm::dvec4(0, 1, 0, 0), glm::dvec4(0, 6, 0, 1));
  EXPECT_LT(largestDifference(OrbitCamera(start, kBounds).camera(1).worldFromCamera, start.worldFromCamera),
            10 * kTolerance);
}

TEST(OrbitCamera, TurnsAboutTheMiddleOfTheScene) {
  OrbitCamera orbit(lookingAtCenter({0, 1, 5}), kBounds);
  orbit.orbit(0.5, 0); // a quarter turn: dragging right moves the camera to the left of what it looks at
  EXPECT_NEAR(glm::length(position(orbit.camera(1)) - glm::dvec3(-5, 1, 0)), 0, 10 * kTolerance);
  orbit.orbit(0, 0.25); // dragging down moves it up
  EXPECT_NEAR(position(orbit.camera(1)).y, 1 + 5 * std::sin(std::numbers::pi / 4), 10 * kTolerance);
  EXPECT_NEAR(glm::length(position(orbit.camera(1)) - kCenter), 5, 10 * kTolerance);
}

TEST(OrbitCamera, StopsAtThePoles) {
  OrbitCamera orbit(lookingAtCenter({0, 1, 5}), kBounds);
  orbit.orbit(0, 10);
  EXPECT_NEAR(glm::length(position(orbit.camera(1)) - glm::dvec3(0, 6, 0)), 0, 10 * kTolerance);
  EXPECT_NEAR(orbit.camera(1).worldFromCamera[1].z, -1, kTolerance); // the far side of the scene is up in the image
}

TEST(OrbitCamera, PanMakesThePointFollowThePointer) {
  for (const CameraKind kind : {CameraKind::Perspective, CameraKind::Orthographic}) {
    Camera start = lookingAtCenter({3, 4, -2});
    start.kind = kind;
    start.ymag = 1.7;
    OrbitCamera orbit(start, kBounds);
    orbit.pan(0.2, -0.1);
    const glm::dvec2 landed = onScreen(orbit.camera(1), kCenter);
    EXPECT_NEAR(landed.x, 0.2, 10 * kTolerance);
    EXPECT_NEAR(landed.y, -0.1, 10 * kTolerance);
  }
}

TEST(OrbitCamera, DollyScalesTheDistanceOrTheOrthographicView) {
  OrbitCamera perspective(lookingAtCenter({0, 1, 5}), kBounds);
  perspective.dolly(10);
  EXPECT_NEAR(glm::length(position(perspective.camera(1)) - kCenter), 5 / std::numbers::e, 10 * kTolerance);

  Camera start = lookingAtCenter({0, 1, 5});
  start.kind = CameraKind::Orthographic;
  start.ymag = 2;
  OrbitCamera orthographic(start, kBounds);
  orthographic.dolly(-10);
  EXPECT_NEAR(orthographic.camera(1.5).ymag, 2 * std::numbers::e, kTolerance * 10);
  EXPECT_NEAR(orthographic.camera(1.5).xmag, 3 * std::numbers::e, kTolerance * 10);
}

TEST(OrbitCamera, StaysRigidAndUprightUnderRandomMoves) {
  OrbitCamera orbit(lookingAtCenter({0, 1, 5}), kBounds);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> amount(-1, 1);
  for (int i = 0; i < 1000; ++i) {
    orbit.orbit(amount(random), amount(random));
    orbit.pan(amount(random), amount(random));
    orbit.dolly(amount(random));
    const glm::dmat3 rotation(orbit.camera(1).worldFromCamera);
    EXPECT_NEAR(glm::determinant(rotation), 1, kTolerance);
    EXPECT_LT(largestDifference(glm::dmat4(rotation * glm::transpose(rotation)), glm::dmat4(1)), kTolerance);
    EXPECT_EQ(rotation[0].y, 0); // right is level
    EXPECT_GE(rotation[1].y, 0); // up is not down
  }
}

TEST(OrbitCamera, HasATargetAheadWhereTheSceneIsBehindOrEmpty) {
  Camera away;
  away.worldFromCamera[3] = glm::dvec4(0, 1, -50, 1); // looks down -z, away from the scene
  OrbitCamera behind(away, kBounds);
  behind.orbit(1, 0);
  EXPECT_TRUE(std::isfinite(position(behind.camera(1)).z));
  EXPECT_LT(position(behind.camera(1)).z, -50); // half a turn about a point ahead
  OrbitCamera empty(away, Bounds{});
  empty.orbit(1, 0);
  EXPECT_TRUE(std::isfinite(position(empty.camera(1)).z));
}

} // namespace isophote::viewer
