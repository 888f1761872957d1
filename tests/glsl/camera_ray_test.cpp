#include "glsl/camera_ray_case.h"

#include <cmath>
#include <numbers>
#include <random>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "support/probe.hpp"
#include "support/statistics.hpp"
#include "test_glsl_kernels.hpp"
#include "upload/camera_record.hpp"

namespace isophote {
namespace {

using gpu::CameraRayCase;
using gpu::CameraRayResult;

std::vector<CameraRayResult> run(const std::vector<CameraRayCase>& cases,
                                 std::span<const gpu::SpecConstant> constants = {}) {
  return test::runProbe<CameraRayCase, CameraRayResult>(test_glsl_kernels::kernelSource("camera_ray_probe"), cases, 0,
                                                        constants);
}

Camera randomCamera(std::mt19937& generator, CameraKind kind) {
  std::uniform_real_distribution<double> unit(0, 1);
  Camera camera;
  camera.kind = kind;
  camera.yfov = 0.02 + 2.9 * unit(generator);
  camera.xmag = 0.1 + 5 * unit(generator);
  camera.ymag = 0.1 + 5 * unit(generator);
  camera.znear = 0.5 * unit(generator);
  camera.zfar = unit(generator) < 0.5 ? 0 : 10 + unit(generator);
  const glm::dvec3 eye(10 * unit(generator), 10 * unit(generator), 10 * unit(generator));
  const glm::dvec3 target(10 * unit(generator), 10 * unit(generator) + 11, 10 * unit(generator));
  camera.worldFromCamera = glm::inverse(glm::lookAt(eye, target, glm::dvec3(0.3, 0.1, 1)));
  return camera;
}

struct Ray {
  glm::dvec3 origin, direction;
  double tMin, tMax;
};

/// The ray by the camera's definition, in double and world space.
Ray oracle(const Camera& camera, double width, double height, const glm::dvec2& pixel) {
  const glm::dvec2 s(2 * pixel.x / width - 1, 1 - 2 * pixel.y / height);
  const glm::dmat3 rotation(camera.worldFromCamera);
  const glm::dvec3 position(camera.worldFromCamera[3]);
  const double aspect = width / height;
  if (camera.kind == CameraKind::Panorama) {
    const double longitude = s.x * std::numbers::pi, latitude = s.y * std::numbers::pi / 2;
    const glm::dvec3 local(std::cos(latitude) * std::sin(longitude), std::sin(latitude),
                           -std::cos(latitude) * std::cos(longitude));
    return {position, rotation * local, camera.znear, camera.zfar};
  }
  if (camera.kind == CameraKind::Orthographic) {
    const glm::dvec3 local(s.x * camera.ymag * aspect, s.y * camera.ymag, 0);
    return {position + rotation * local, rotation * glm::dvec3(0, 0, -1), camera.znear, camera.zfar};
  }
  const double tangent = std::tan(camera.yfov / 2);
  const glm::dvec3 local(s.x * tangent * aspect, s.y * tangent, -1);
  const double length = glm::length(local);
  return {position, rotation * local / length, camera.znear * length, camera.zfar * length};
}

void expectRaysMatch(CameraKind kind, std::span<const gpu::SpecConstant> constants) {
  std::mt19937 generator(3);
  std::uniform_real_distribution<float> unit(0, 1);
  const glm::dvec3 worldOrigin(1e6, -2e5, 3e4);
  std::vector<CameraRayCase> cases;
  std::vector<Ray> expected;
  for (int i = 0; i < 20'000; ++i) {
    Camera camera = randomCamera(generator, kind);
    camera.worldFromCamera[3] += glm::dvec4(worldOrigin, 0);
    const uint32_t width = 1u << generator() % 13;
    const uint32_t height = 1 + static_cast<uint32_t>(generator() % 3000);
    const glm::vec2 size(static_cast<float>(width), static_cast<float>(height));
    const glm::vec2 pixel = glm::vec2(unit(generator), unit(generator)) * size;
    cases.push_back({cameraRecord(camera, width, height, worldOrigin), pixel, size, {0.5f, 0.5f}});
    camera.worldFromCamera[3] -= glm::dvec4(worldOrigin, 0);
    expected.push_back(oracle(camera, width, height, glm::dvec2(pixel)));
  }
  const auto results = run(cases, constants);
  for (size_t i = 0; i < cases.size(); ++i) {
    const Ray& ray = expected[i];
    const double extent = 1 + glm::length(ray.origin);
    ASSERT_LT(glm::length(glm::dvec3(results[i].direction) - ray.direction), 1e-6) << i;
    ASSERT_LT(glm::length(glm::dvec3(results[i].origin) - ray.origin), 1e-6 * extent) << i;
    ASSERT_NEAR(results[i].tMin, ray.tMin, 1e-6 * ray.tMin) << i;
    if (ray.tMax > 0) {
      ASSERT_NEAR(results[i].tMax, ray.tMax, 1e-6 * ray.tMax) << i;
    } else {
      ASSERT_EQ(results[i].tMax, 3.402823466e38f) << i;
    }
  }
}

TEST(CameraRays, PerspectiveMatchesDouble) { expectRaysMatch(CameraKind::Perspective, {}); }

TEST(CameraRays, PerspectiveMatchesDoubleWithoutTheOrthographicFeature) {
  const gpu::SpecConstant constants[] = {{12, 0}};
  expectRaysMatch(CameraKind::Perspective, constants);
}

TEST(CameraRays, OrthographicMatchesDouble) { expectRaysMatch(CameraKind::Orthographic, {}); }

TEST(CameraRays, PanoramasMatchDouble) { expectRaysMatch(CameraKind::Panorama, {}); }

TEST(CameraRays, APanoramaGoesOnBeyondItsBorders) {
  Camera camera;
  camera.kind = CameraKind::Panorama;
  const auto record = cameraRecord(camera, 200, 100, glm::dvec3(0));
  const auto results = run({{record, {-1, 30}, {200, 100}, {}},
                            {record, {199, 30}, {200, 100}, {}},
                            {record, {30, -1}, {200, 100}, {}},
                            {record, {130, 1}, {200, 100}, {}}});
  EXPECT_LT(glm::length(results[0].direction - results[1].direction), 2e-6f);
  EXPECT_LT(glm::length(results[2].direction - results[3].direction), 2e-6f); // over the pole
}

TEST(CameraRays, ALensKeepsWhereRaysMeetThePlaneInFocus) {
  std::mt19937 generator(8);
  std::uniform_real_distribution<float> unit(0, 1);
  for (const CameraKind kind : {CameraKind::Perspective, CameraKind::Orthographic}) {
    std::vector<CameraRayCase> cases;
    std::vector<Camera> cameras;
    for (int i = 0; i < 5000; ++i) {
      Camera camera = randomCamera(generator, kind);
      camera.yfov = 0.02 + 2 * unit(generator);
      camera.lensRadius = 0.5 * unit(generator);
      camera.focusDistance = 0.5 + 20 * unit(generator);
      camera.apertureBlades = generator() % 8;
      camera.apertureRotation = 6 * unit(generator);
      const glm::vec2 pixel(100 * unit(generator), 80 * unit(generator));
      cases.push_back(
          {cameraRecord(camera, 100, 80, glm::dvec3(0)), pixel, {100, 80}, {unit(generator), unit(generator)}});
      cameras.push_back(camera);
    }
    const auto results = run(cases);
    for (size_t i = 0; i < cases.size(); ++i) {
      const Camera& camera = cameras[i];
      const Ray pinhole = oracle(camera, 100, 80, glm::dvec2(cases[i].pixelPosition));
      const glm::dvec3 forward = -glm::dvec3(camera.worldFromCamera[2]);
      const glm::dvec3 inFocus =
          pinhole.origin + pinhole.direction * (camera.focusDistance / glm::dot(pinhole.direction, forward));
      const glm::dvec3 origin(results[i].origin), direction(results[i].direction);
      const double scale = 30 + glm::length(inFocus - origin);
      ASSERT_LE(glm::length(origin - pinhole.origin), camera.lensRadius + 1e-6 * scale) << i;
      ASSERT_NEAR(glm::dot(origin - pinhole.origin, forward), 0, 1e-6 * scale) << i;
      ASSERT_LT(glm::length(glm::cross(inFocus - origin, direction)), 2e-6 * scale) << i;
      ASSERT_NEAR(results[i].tMin * glm::dot(direction, forward), camera.znear, 1e-5) << i;
    }
  }
}

// 200,000 points per aperture in bins of equal area: by sector between corners, and within a sector by the square of
// the height over the apothem (rings of a polygon), or of the radius.
TEST(CameraRays, LensPointsCoverTheApertureUniformly) {
  constexpr size_t kRings = 16;
  constexpr uint32_t kSamples = 200'000;
  for (const uint32_t blades : {0u, 3u, 5u, 6u, 9u}) {
    Camera camera;
    camera.lensRadius = camera.focusDistance = 1;
    camera.apertureBlades = blades;
    const auto record = cameraRecord(camera, 2, 2, glm::dvec3(0));
    std::mt19937 generator(5 + blades);
    const auto lattice = [&] { return std::ldexp(static_cast<float>(generator() >> 8), -24); };
    std::vector<CameraRayCase> cases(kSamples, {record, {1, 1}, {2, 2}, {}});
    for (auto& c : cases) {
      c.uLens.x = lattice();
      c.uLens.y = lattice();
    }
    const size_t sectors = blades == 0 ? 16 : blades;
    std::vector<uint64_t> observed(sectors * kRings, 0);
    for (const auto& ray : run(cases)) {
      const glm::dvec2 p(ray.origin);
      const double turn = std::atan2(p.y, p.x) / (2 * std::numbers::pi);
      const auto sector =
          std::min(static_cast<size_t>((turn < 0 ? turn + 1 : turn) * static_cast<double>(sectors)), sectors - 1);
      const double middle = 2 * std::numbers::pi * (static_cast<double>(sector) + 0.5) / static_cast<double>(sectors);
      const double height =
          blades == 0 ? glm::length(p)
                      : glm::dot(p, {std::cos(middle), std::sin(middle)}) / std::cos(std::numbers::pi / blades);
      ASSERT_LE(height, 1 + 1e-6);
      ++observed[sector * kRings + std::min(static_cast<size_t>(height * height * kRings), kRings - 1)];
    }
    const std::vector<double> expected(observed.size(),
                                       static_cast<double>(kSamples) / static_cast<double>(observed.size()));
    EXPECT_GT(test::chiSquareTest(observed, expected).p, test::sidak(0.001, 5)) << blades;
  }
}

TEST(CameraRays, CornersOfTheImageAreTheCornersOfTheView) {
  Camera camera;
  camera.yfov = 2 * std::atan(0.5);
  const auto record = cameraRecord(camera, 200, 100, glm::dvec3(0));
  const auto results = run(
      {{record, {0, 0}, {200, 100}, {}}, {record, {200, 100}, {200, 100}, {}}, {record, {100, 50}, {200, 100}, {}}});
  const auto tangents = [](const CameraRayResult& ray) { return glm::vec2(ray.direction) / -ray.direction.z; };
  EXPECT_NEAR(tangents(results[0]).x, -1, 1e-6);
  EXPECT_NEAR(tangents(results[0]).y, 0.5, 1e-6); // row 0 is the top
  EXPECT_NEAR(tangents(results[1]).x, 1, 1e-6);
  EXPECT_NEAR(tangents(results[1]).y, -0.5, 1e-6);
  EXPECT_EQ(results[2].direction, glm::vec3(0, 0, -1));
}

} // namespace
} // namespace isophote
