#include "accel/light_cone.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace isophote {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Angle between unit vectors, accurate at both ends.
double angleBetween(const glm::dvec3& a, const glm::dvec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

glm::dvec3 anyPerpendicular(const glm::dvec3& v) {
  const glm::dvec3 other = std::abs(v.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  return glm::normalize(glm::cross(v, other));
}

int32_t toSnorm(double value) { return static_cast<int32_t>(std::lround(std::clamp(value, -1.0, 1.0) * 32767)); }

uint32_t pair(int32_t low, int32_t high) {
  return (static_cast<uint32_t>(low) & 0xffffu) | static_cast<uint32_t>(high) << 16;
}

/// Octahedral map (Meyer et al. 2010, "On Floating-Point Normal Vectors") at 16 bits a coordinate.
std::pair<int32_t, int32_t> octahedral(const glm::dvec3& v) {
  const glm::dvec3 p = v / (std::abs(v.x) + std::abs(v.y) + std::abs(v.z));
  if (p.z >= 0) return {toSnorm(p.x), toSnorm(p.y)};
  return {toSnorm(std::copysign(1 - std::abs(p.y), p.x)), toSnorm(std::copysign(1 - std::abs(p.x), p.y))};
}

glm::dvec3 fromOctahedral(int32_t x, int32_t y) {
  glm::dvec3 v(x / 32767.0, y / 32767.0, 0);
  v.z = 1 - std::abs(v.x) - std::abs(v.y);
  if (v.z < 0) {
    const glm::dvec3 folded = v;
    v.x = std::copysign(1 - std::abs(folded.y), folded.x);
    v.y = std::copysign(1 - std::abs(folded.x), folded.y);
  }
  return glm::normalize(v);
}

} // namespace

LightCone unite(const LightCone& first, const LightCone& second) {
  LightCone a = first;
  LightCone b = second;
  if (b.thetaO > a.thetaO) std::swap(a, b);
  if (a.twoSided && b.twoSided && glm::dot(a.axis, b.axis) < 0) b.axis = -b.axis; // the nearer of its two axes
  LightCone result{a.axis, a.thetaO, std::max(a.thetaE, b.thetaE), a.twoSided || b.twoSided};
  const double between = angleBetween(a.axis, b.axis);
  if (std::min(between + b.thetaO, kPi) <= a.thetaO) return result;
  result.thetaO = 0.5 * (a.thetaO + between + b.thetaO);
  if (result.thetaO >= kPi) {
    result.thetaO = kPi;
    return result;
  }
  // The axis turns from a's towards b's.
  const double turn = result.thetaO - a.thetaO;
  glm::dvec3 across = b.axis - glm::dot(a.axis, b.axis) * a.axis;
  const double length = glm::length(across);
  across = length > 1e-12 ? across / length : anyPerpendicular(a.axis);
  result.axis = glm::normalize(std::cos(turn) * a.axis + std::sin(turn) * across);
  return result;
}

double solidAngleMeasure(const LightCone& cone) {
  const double o = cone.thetaO;
  const double w = std::min(o + cone.thetaE, kPi);
  return 2 * kPi * (1 - std::cos(o)) +
         0.5 * kPi * (2 * w * std::sin(o) - std::cos(o - 2 * w) - 2 * o * std::sin(o) + std::cos(o));
}

PackedCone pack(const LightCone& cone) {
  const auto [x, y] = octahedral(cone.axis);
  // What rounding the axis may leave out, and the device's own rounding.
  const double wider = angleBetween(cone.axis, fromOctahedral(x, y)) + 1e-4;
  const double thetaO = std::min(cone.thetaO + wider, kPi);
  const auto rounded = [](double cosine) {
    return std::clamp(static_cast<int32_t>(std::floor(cosine * 32767)), -32767, 32767);
  };
  return {pair(x, y), pair(rounded(std::cos(thetaO)), rounded(std::cos(cone.thetaE)))};
}

} // namespace isophote
