#include "render/render_view.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "isophote/error.hpp"
#include "upload/camera_record.hpp"

namespace isophote {
namespace {

uint32_t powerOfTwoBelow(uint32_t value, uint32_t limit) { return std::min(std::bit_floor(value), limit); }

// Lengths: a power of two near the scene's radius, with room for points 2^33 radii away.
FilmScale filmScale(const GpuScene::Impl& scene) {
  const double radius = std::exp2(std::ceil(std::log2(std::max(scene.worldRadius, 1e-30))));
  return {.radiancePerUnit = scene.emitterScale * std::ldexp(1.0, -static_cast<int>(gpu::kRadianceFractionBits)),
          .lengthPerUnit = radius * std::ldexp(1.0, -30),
          .worldOrigin = scene.worldOrigin};
}

} // namespace

gpu::RenderView renderView(const GpuScene::Impl& scene, Film::Impl& film, const Camera& camera, SampleRange range,
                           const EstimatorSettings& settings, uint64_t filterTable) {
  const FilmScale scale = filmScale(scene);
  if (film.scale && !(*film.scale == scale)) throw Error("the film holds samples of another scene: clear it first");
  film.scale = scale;

  const PixelRect& crop = film.options.crop;
  gpu::RenderView view{};
  view.camera = cameraRecord(camera, film.options.width, film.options.height, scene.worldOrigin);
  view.filterTable = filterTable;
  view.replicates = film.replicates.address();
  view.aovs = film.aovs.address();
  view.clamped = film.clamped.address();
  view.beyond = film.beyond.address();
  view.imageSize = {film.options.width, film.options.height};
  view.cropOrigin = {crop.x0, crop.y0};
  view.cropSize = {film.cropWidth, film.cropHeight};
  view.tileSize = {powerOfTwoBelow(film.cropWidth, 8), powerOfTwoBelow(film.cropHeight, 8)};
  view.tileColumns = (film.cropWidth + view.tileSize.x - 1) / view.tileSize.x;
  const uint32_t tileRows = (film.cropHeight + view.tileSize.y - 1) / view.tileSize.y;
  view.paddedPixelCount = view.tileColumns * view.tileSize.x * tileRows * view.tileSize.y;
  view.firstSample = range.first;
  view.maxDepth = settings.maxDepth;
  view.seed = {static_cast<uint32_t>(settings.seed), static_cast<uint32_t>(settings.seed >> 32)};
  view.radianceScale = static_cast<float>(1.0 / scale.radiancePerUnit);
  view.distanceScale = static_cast<float>(1.0 / scale.lengthPerUnit);
  view.sampleLimit = settings.clamp;
  view.workEnd = uint64_t{view.paddedPixelCount} * (range.last - range.first);
  return view;
}

} // namespace isophote
