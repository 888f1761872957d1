// The media around the camera, from the answers of kernels/find_camera_media.comp.
#pragma once

#include <span>

#include "shared/path_types.h"

namespace isophote {

/// The MediaState::path that occurs most often; of equally frequent ones the first. @param answers  not empty
[[nodiscard]] gpu::MediumStack mostFrequent(std::span<const gpu::MediaState> answers);

} // namespace isophote
