// Texture reads in double, from the rules of glTF 2.0 and nothing else.
#pragma once

#include <glm/glm.hpp>

#include "isophote/scene.hpp"

namespace isophote::oracle {

enum class Encoding { Linear, Srgb };

/// IEC 61966-2-1, exact: the linear value of an sRGB-encoded one, both in [0, 1].
[[nodiscard]] double decodeSrgb(double encoded);

/// One texel as RGBA, decoded; alpha is never sRGB.
[[nodiscard]] glm::dvec4 readTexel(const ImageData& image, uint32_t x, uint32_t y, Encoding encoding);

/// Column or row of texel `index` under a wrap mode, in [0, size).
[[nodiscard]] uint32_t wrapTexel(int64_t index, uint32_t size, Wrap wrap);

/// Reads `texture` at uv; (0, 0) is the upper left corner of the upper left texel. Linear filtering interpolates
/// decoded values between texel centers, which lie at half texels.
[[nodiscard]] glm::dvec4 lookUp(const Scene& scene, const Texture& texture, glm::dvec2 uv, Encoding encoding);

/// The same after the reference's uv transform. `meshUv` belongs to the reference's uv set.
[[nodiscard]] glm::dvec4 lookUp(const Scene& scene, const TextureRef& reference, glm::dvec2 meshUv, Encoding encoding);

} // namespace isophote::oracle
