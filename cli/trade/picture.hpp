// Pictures within a page.
#pragma once

#include <string>

#include "isophote/image.hpp"

namespace isophote::cli {

/// R, G, B as an <img> with its PNG inside. @param exposureEv  stops
[[nodiscard]] std::string pictureTag(const Image& image, float exposureEv, const std::string& description);

/// The mean over R, G and B: red where positive, blue where negative, white at 0; full color at `full` and beyond.
[[nodiscard]] std::string differenceTag(const Image& difference, float full, const std::string& description);

/// The exposure in stops that brings an image's mean luminance to a middle gray.
[[nodiscard]] float middleExposure(const Image& image);

} // namespace isophote::cli
