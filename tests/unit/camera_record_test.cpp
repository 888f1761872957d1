#include "upload/camera_record.hpp"

#include <cmath>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "isophote/error.hpp"

namespace isophote {
namespace {

TEST(CameraRecord, KeepsTheVerticalFieldOfViewForEveryAspectRatio) {
  Camera camera;
  camera.yfov = 1.1;
  camera.aspectRatio = 1.0; // the image's own ratio is used
  for (const uint32_t width : {1u, 100u, 400u, 65535u}) {
    const auto record = cameraRecord(camera, width, 100, glm::dvec3(0));
    EXPECT_FLOAT_EQ(glm::length(record.up), static_cast<float>(std::tan(0.55)));
    EXPECT_FLOAT_EQ(glm::length(record.right), static_cast<float>(std::tan(0.55) * width / 100.0));
  }
}

TEST(CameraRecord, OrthographicKeepsYmag) {
  Camera camera;
  camera.kind = CameraKind::Orthographic;
  camera.xmag = 7;
  camera.ymag = 3;
  const auto record = cameraRecord(camera, 300, 200, glm::dvec3(0));
  EXPECT_EQ(record.kind, gpu::kCameraOrthographic);
  EXPECT_FLOAT_EQ(glm::length(record.up), 3);
  EXPECT_FLOAT_EQ(glm::length(record.right), 4.5);
}

TEST(CameraRecord, FarFromTheOriginThePositionKeepsItsPrecision) {
  Camera camera;
  camera.worldFromCamera[3] = glm::dvec4(3e8 + 0.25, -7e8 + 0.125, 5e7 - 0.5, 1);
  const auto record = cameraRecord(camera, 10, 10, glm::dvec3(3e8, -7e8, 5e7));
  EXPECT_EQ(record.position, glm::vec3(0.25f, 0.125f, -0.5f));
}

TEST(CameraRecord, AxesAreOrthogonalAndLookDownMinusZ) {
  Camera camera;
  camera.worldFromCamera = glm::rotate(glm::dmat4(1), 0.7, glm::dvec3(1, 2, 3));
  const auto record = cameraRecord(camera, 30, 20, glm::dvec3(0));
  EXPECT_NEAR(glm::dot(record.right, record.up), 0, 1e-7);
  EXPECT_NEAR(glm::dot(record.right, record.forward), 0, 1e-7);
  const glm::vec3 backwards = glm::normalize(glm::cross(record.right, record.up));
  EXPECT_NEAR(glm::length(backwards + record.forward), 0, 1e-6);
  EXPECT_NEAR(glm::length(record.forward - glm::vec3(-camera.worldFromCamera[2])), 0, 1e-6);
}

TEST(CameraRecord, RefusesAnImageWithoutPixels) {
  EXPECT_THROW(static_cast<void>(cameraRecord(Camera{}, 0, 10, glm::dvec3(0))), UsageError);
  EXPECT_THROW(static_cast<void>(cameraRecord(Camera{}, 10, 0, glm::dvec3(0))), UsageError);
}

} // namespace
} // namespace isophote
