// A filter that trades noise for bias, beside the image and never in it.
#pragma once

#include <cstdint>

#include "isophote/image.hpp"

namespace isophote {

enum class Denoiser : uint32_t { None, Atrous };

/// Adds the layer `denoised.{R,G,B}`: what an edge-avoiding wavelet filter (engine/src/denoise/atrous_filter.hpp) makes
/// of R, G, B. It is biased, mostly by less than a pixel's error; no other layer changes. Where the error is not known
/// (fewer than two replicates) or nil, the layer is the image.
/// @param image  as Film::resolve returns it: R, G, B, A, stderr, sampleCount, albedo, normal and position, all finite
/// @throws UsageError where one of these layers is missing
void addDenoised(Image& image);

/// The layer as R, G, B of an image of its own, with A and the attributes; of its error nothing is known.
/// @throws UsageError where the image has none
[[nodiscard]] Image denoisedImage(const Image& image);

} // namespace isophote
