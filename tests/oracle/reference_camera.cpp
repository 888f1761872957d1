#include "oracle/reference_camera.hpp"

#include <cmath>

namespace isophote::oracle {

Ray cameraRay(const Camera& camera, uint32_t width, uint32_t height, glm::dvec2 pixel, glm::dvec2 lens) {
  const double sx = 2 * pixel.x / width - 1, sy = 1 - 2 * pixel.y / height;
  glm::dvec3 origin(0), direction(0, 0, -1);
  if (camera.kind == CameraKind::Orthographic) {
    origin = {sx * camera.ymag * width / height, sy * camera.ymag, 0};
  } else if (camera.kind == CameraKind::Panorama) {
    const double longitude = kPi * sx, latitude = kPi / 2 * sy;
    direction = {std::cos(latitude) * std::sin(longitude), std::sin(latitude),
                 -std::cos(latitude) * std::cos(longitude)};
  } else {
    const double halfHeight = std::tan(camera.yfov / 2);
    direction = glm::normalize(glm::dvec3(sx * halfHeight * width / height, sy * halfHeight, -1));
  }
  if (camera.hasLens()) {
    const glm::dvec3 inFocus = origin + direction * (camera.focusDistance / -direction.z);
    origin += camera.lensRadius * glm::dvec3(lens, 0);
    direction = glm::normalize(inFocus - origin);
  }
  Ray ray;
  ray.origin = glm::dvec3(camera.worldFromCamera * glm::dvec4(origin, 1));
  ray.direction = glm::normalize(glm::dvec3(camera.worldFromCamera * glm::dvec4(direction, 0)));
  const double cosine = camera.kind == CameraKind::Panorama ? 1 : -direction.z;
  ray.tMin = camera.znear / cosine;
  if (camera.zfar > 0) ray.tMax = camera.zfar / cosine;
  return ray;
}

} // namespace isophote::oracle
