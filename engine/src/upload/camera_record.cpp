#include "upload/camera_record.hpp"

#include <cmath>

#include "isophote/error.hpp"

namespace isophote {

gpu::CameraRecord cameraRecord(const Camera& camera, uint32_t width, uint32_t height, const glm::dvec3& worldOrigin) {
  if (width == 0 || height == 0) throw UsageError("an image needs at least one pixel in each direction");
  const bool orthographic = camera.kind == CameraKind::Orthographic;
  const double halfHeight = orthographic ? camera.ymag : std::tan(0.5 * camera.yfov);
  const double halfWidth = halfHeight * width / height;
  const glm::dmat4& m = camera.worldFromCamera;
  gpu::CameraRecord record{};
  record.position = glm::vec3(glm::dvec3(m[3]) - worldOrigin);
  record.right = glm::vec3(halfWidth * glm::normalize(glm::dvec3(m[0])));
  record.up = glm::vec3(halfHeight * glm::normalize(glm::dvec3(m[1])));
  record.forward = glm::vec3(-glm::normalize(glm::dvec3(m[2])));
  record.znear = static_cast<float>(camera.znear);
  record.zfar = static_cast<float>(camera.zfar);
  record.orthographic = orthographic ? 1u : 0u;
  return record;
}

} // namespace isophote
