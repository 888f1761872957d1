#include "oracle/reference_camera.hpp"

#include <cmath>

namespace isophote::oracle {

Ray cameraRay(const Camera& camera, uint32_t width, uint32_t height, glm::dvec2 pixel) {
  const double sx = 2 * pixel.x / width - 1, sy = 1 - 2 * pixel.y / height;
  glm::dvec3 origin(0), direction(0, 0, -1);
  if (camera.kind == CameraKind::Orthographic) {
    origin = {sx * camera.ymag * width / height, sy * camera.ymag, 0};
  } else {
    const double halfHeight = std::tan(camera.yfov / 2);
    direction = glm::normalize(glm::dvec3(sx * halfHeight * width / height, sy * halfHeight, -1));
  }
  Ray ray;
  ray.origin = glm::dvec3(camera.worldFromCamera * glm::dvec4(origin, 1));
  ray.direction = glm::normalize(glm::dvec3(camera.worldFromCamera * glm::dvec4(direction, 0)));
  ray.tMin = camera.znear / -direction.z;
  if (camera.zfar > 0) ray.tMax = camera.zfar / -direction.z;
  return ray;
}

} // namespace isophote::oracle
