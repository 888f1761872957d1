#include "upload/camera_record.hpp"

#include <cmath>

#include "isophote/error.hpp"

namespace isophote {

gpu::CameraRecord cameraRecord(const Camera& camera, uint32_t width, uint32_t height, const glm::dvec3& worldOrigin) {
  if (width == 0 || height == 0) throw UsageError("an image needs at least one pixel in each direction");
  static_assert(static_cast<uint32_t>(CameraKind::Orthographic) == gpu::kCameraOrthographic &&
                static_cast<uint32_t>(CameraKind::Panorama) == gpu::kCameraPanorama);
  const bool panorama = camera.kind == CameraKind::Panorama;
  const double halfHeight = panorama                                  ? 1
                            : camera.kind == CameraKind::Orthographic ? camera.ymag
                                                                      : std::tan(0.5 * camera.yfov);
  const double halfWidth = panorama ? 1 : halfHeight * width / height;
  const glm::dmat4& m = camera.worldFromCamera;
  const glm::dvec3 right = glm::normalize(glm::dvec3(m[0]));
  const glm::dvec3 up = glm::normalize(glm::dvec3(m[1]));
  gpu::CameraRecord record{};
  record.position = glm::vec3(glm::dvec3(m[3]) - worldOrigin);
  record.right = glm::vec3(halfWidth * right);
  record.up = glm::vec3(halfHeight * up);
  record.forward = glm::vec3(-glm::normalize(glm::dvec3(m[2])));
  record.znear = static_cast<float>(camera.znear);
  record.zfar = static_cast<float>(camera.zfar);
  record.kind = static_cast<uint32_t>(camera.kind);
  if (camera.hasLens()) {
    const double c = std::cos(camera.apertureRotation), s = std::sin(camera.apertureRotation);
    record.focusDistance = static_cast<float>(camera.focusDistance);
    record.lensRight = glm::vec3(camera.lensRadius * (c * right + s * up));
    record.lensUp = glm::vec3(camera.lensRadius * (c * up - s * right));
    record.bladeCount = camera.apertureBlades < 3 ? 0 : camera.apertureBlades;
  }
  return record;
}

} // namespace isophote
