#include "scene/medium.hpp"

#include <algorithm>
#include <cmath>

namespace isophote {
namespace {

// In place of infinity, for an attenuation color of 0: black after a billionth of the attenuation distance.
constexpr double kLargestOpticalDepth = 1e9;
constexpr double kLargestExtinction = 1e30;

double extinction(double color, double distance) {
  if (distance <= 0) return 0; // infinite
  return std::min(std::min(-std::log(color), kLargestOpticalDepth) / distance, kLargestExtinction);
}

double singleScatteringAlbedo(double multiple) {
  if (multiple <= 0) return 0; // the fit gives 6e-6
  const double s =
      4.09712 + 4.20863 * multiple - std::sqrt(9.59217 + 41.6808 * multiple + 17.7126 * multiple * multiple);
  return std::clamp(1 - s * s, 0.0, 1.0);
}

} // namespace

MediumCoefficients mediumCoefficients(const Volume& volume) {
  MediumCoefficients result;
  for (int c = 0; c < 3; ++c) {
    result.extinction[c] = static_cast<float>(extinction(volume.attenuationColor[c], volume.attenuationDistance));
    result.albedo[c] = static_cast<float>(singleScatteringAlbedo(volume.multiscatterColor[c]));
  }
  return result;
}

bool isVolume(const Material& material) {
  const bool passes = material.transmission.factor > 0 || material.diffuseTransmission.factor > 0;
  return material.volume.thickness > 0 && passes && !material.unlit;
}

bool isClear(const Material& material) {
  return isVolume(material) && material.dispersion == 0 && material.transmission.factor == 1 &&
         !material.transmission.texture.present() && material.metallic == 0 &&
         glm::vec3(material.baseColor) == glm::vec3(1) && !material.baseColorTexture.present() &&
         material.emissive == glm::vec3(0) && material.clearcoat.factor == 0 && material.sheen.color == glm::vec3(0) &&
         material.iridescence.factor == 0 && material.alphaMode == AlphaMode::Opaque;
}

} // namespace isophote
