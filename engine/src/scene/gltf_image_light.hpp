// EXT_lights_image_based: the cube map around a scene becomes its Environment.
#pragma once

#include <optional>

#include "isophote/scene.hpp"
#include "scene/gltf_document.hpp"
#include "scene/gltf_textures.hpp"

namespace isophote::gltf {

/// The light of the scene that is loaded; absent where it names none.
///
/// Read are the faces of the sharpest cube map, `specularImages[0]`, the intensity and the rotation. Rougher levels and
/// irradianceCoefficients precompute what a path tracer integrates. PNG and JPEG are decoded as sRGB and divided by
/// alpha (RGBD). The cube map is resampled to an equirectangular map of four texels for each of a face's, at most 4096
/// wide: every texel is the mean of 4 x 4 bilinear lookups, spread evenly over its solid angle.
/// @throws SceneError where faces are not square or differ in size, or where an image is broken
[[nodiscard]] std::optional<Environment> readImageLight(Document& document, Textures& textures);

} // namespace isophote::gltf
