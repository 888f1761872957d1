// Camera -> what the device reads.
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "isophote/scene.hpp"
#include "shared/camera_types.h"

namespace isophote {

/// The camera for an image of width x height pixels. The vertical extent (yfov, ymag) is kept; the image's own aspect
/// ratio decides the horizontal one, so pixels are square and nothing is stretched; a panorama is stretched over the
/// image. Positions become relative to `worldOrigin` in double before they are rounded.
/// @throws UsageError for an image without pixels
[[nodiscard]] gpu::CameraRecord cameraRecord(const Camera& camera, uint32_t width, uint32_t height,
                                             const glm::dvec3& worldOrigin);

} // namespace isophote
