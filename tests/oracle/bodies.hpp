// Which closed bodies of a scene a path lies in, and what fills the place: media, their indices and their order.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "isophote/scene.hpp"
#include "oracle/medium.hpp"

namespace isophote::oracle {

/// Index of refraction that one color channel sees. Source: Khronos, KHR_materials_dispersion.
/// @param channel 0 to 2; any other: the nominal index
[[nodiscard]] double channelIor(double ior, double dispersion, int channel);

/// The bodies around a point. A path starts outside of all. Borrows the scene.
class Bodies {
public:
  explicit Bodies(const Scene& scene) : scene_(&scene) {}

  /// Whether a material's surfaces bound a body that light can enter.
  [[nodiscard]] static bool isBoundary(const Material& material);

  /// The bodies on the other side of a boundary of `material`, met from its front or its back.
  [[nodiscard]] Bodies across(uint32_t material, bool frontFace) const;

  /// The material that fills the place: of the highest priority, of equal ones the last entered (Schmidt and Budge
  /// 2002).
  [[nodiscard]] std::optional<uint32_t> filling() const;

  /// The medium around, where something absorbs or scatters.
  [[nodiscard]] std::optional<MediumCoefficients> medium() const;

  /// Index of what fills the place: 1 of air, and of bodies that light enters by diffuse transmission alone.
  [[nodiscard]] double ior(int channel) const;

private:
  const Scene* scene_;
  std::vector<uint32_t> materials_; ///< in the order of entering
};

} // namespace isophote::oracle
