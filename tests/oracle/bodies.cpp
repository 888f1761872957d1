#include "oracle/bodies.hpp"

#include <algorithm>

namespace isophote::oracle {

double channelIor(double ior, double dispersion, int channel) {
  if (channel < 0 || channel > 2 || dispersion == 0 || ior <= 1) return ior;
  const double halfSpread = (ior - 1) * 0.025 * dispersion;
  return std::max(1.0, ior + (channel - 1) * halfSpread);
}

bool Bodies::isBoundary(const Material& material) {
  return material.volume.thickness > 0 && (material.transmission.factor > 0 || material.diffuseTransmission.factor > 0);
}

Bodies Bodies::across(uint32_t material, bool frontFace) const {
  Bodies result = *this;
  if (frontFace) {
    result.materials_.push_back(material);
    return result;
  }
  const auto last = std::find(result.materials_.rbegin(), result.materials_.rend(), material);
  if (last != result.materials_.rend()) result.materials_.erase(std::next(last).base());
  return result;
}

std::optional<uint32_t> Bodies::filling() const {
  std::optional<uint32_t> found;
  for (const uint32_t material : materials_) {
    if (!found || scene_->materials[material].volume.priority >= scene_->materials[*found].volume.priority)
      found = material;
  }
  return found;
}

std::optional<MediumCoefficients> Bodies::medium() const {
  const auto material = filling();
  if (!material) return std::nullopt;
  const MediumCoefficients result = mediumCoefficients(scene_->materials[*material].volume);
  if (result.extinction == glm::dvec3(0)) return std::nullopt;
  return result;
}

double Bodies::ior(int channel) const {
  const auto found = filling();
  if (!found || scene_->materials[*found].transmission.factor == 0) return 1;
  const Material& material = scene_->materials[*found];
  return channelIor(double(material.ior), double(material.dispersion), channel);
}

} // namespace isophote::oracle
