// Camera rays of the reference tracer.
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "isophote/scene.hpp"
#include "oracle/ray.hpp"

namespace isophote::oracle {

/// The ray through `pixel` (continuous, row 0 at the top, pixel centers at halves) of a width x height image, limited
/// to what lies between the camera's znear and zfar along the view axis. @param lens  on the aperture of radius 1
[[nodiscard]] Ray cameraRay(const Camera& camera, uint32_t width, uint32_t height, glm::dvec2 pixel,
                            glm::dvec2 lens = glm::dvec2(0));

} // namespace isophote::oracle
