// Cones of directions that bound what lights send out.
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

namespace isophote {

/// Normals lie within thetaO of the axis (of +-axis where twoSided), light within thetaE of a normal. Radians.
struct LightCone {
  glm::dvec3 axis{0, 1, 0}; ///< unit
  double thetaO = 0;
  double thetaE = 0;
  bool twoSided = false;
};

/// A cone that holds both, two-sided where one of them is. Conty Estevez and Kulla 2018, algorithm 1.
[[nodiscard]] LightCone unite(const LightCone& a, const LightCone& b);

/// Solid angle of the normals plus the light's spread weighted by its cosine: M_Omega of Conty Estevez and Kulla 2018,
/// section 4.4.
[[nodiscard]] double solidAngleMeasure(const LightCone& cone);

/// 8 bytes for the device, see gpu::LightTreeNode. What is decoded holds the cone that went in.
struct PackedCone {
  uint32_t axis = 0;
  uint32_t cosines = 0;
};
[[nodiscard]] PackedCone pack(const LightCone& cone);

} // namespace isophote
