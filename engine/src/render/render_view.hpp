// What a render tells its kernels.
#pragma once

#include "isophote/film.hpp"
#include "isophote/scene.hpp"
#include "isophote/settings.hpp"
#include "render/film_impl.hpp"
#include "shared/path_types.h"
#include "upload/gpu_scene.hpp"

namespace isophote {

/// Also fixes the film's scale, where it holds no samples yet.
/// @param filterTable  device address of filterTable(settings.filter)
/// @throws Error where the film holds samples of another scene
[[nodiscard]] gpu::RenderView renderView(const GpuScene::Impl& scene, Film::Impl& film, const Camera& camera,
                                         SampleRange range, const EstimatorSettings& settings, uint64_t filterTable);

} // namespace isophote
