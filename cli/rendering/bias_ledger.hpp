// What biasing settings took from an image, as its ledger says.
#pragma once

#include <optional>

#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>

#include "isophote/image.hpp"

namespace isophote::cli {

/// Mean radiance over the pixels of an image, R, G, B.
struct BiasAccount {
  glm::dvec3 kept{0};               ///< what the image has
  glm::dvec3 clamped{0};            ///< what the clamp removed
  std::optional<glm::dvec3> beyond; ///< what the depth limit left out, where it was measured
  glm::dvec3 undenoised{0};         ///< what the denoised layer lacks of `kept`, where there is one
};

/// Read off the image's layers.
[[nodiscard]] BiasAccount biasAccount(const Image& image);

/// Adds to the entries of `ledger`, such as biasJson() makes, what they removed.
void enterAccount(const BiasAccount& account, nlohmann::ordered_json& ledger);

} // namespace isophote::cli
