#include "oracle/light_tree.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace isophote::oracle {
namespace {

constexpr double kPi = 3.14159265358979323846;

double snorm(uint32_t bits) {
  int16_t value = 0;
  const auto low = static_cast<uint16_t>(bits);
  std::memcpy(&value, &low, sizeof(value));
  return std::max(value / 32767.0, -1.0);
}

glm::dvec3 axisOf(uint32_t bits) {
  const double x = snorm(bits & 0xffffu);
  const double y = snorm(bits >> 16);
  const double z = 1 - std::abs(x) - std::abs(y);
  glm::dvec3 v(x, y, z);
  if (z < 0) v = {std::copysign(1 - std::abs(y), x), std::copysign(1 - std::abs(x), y), z};
  return glm::normalize(v);
}

double angle(const glm::dvec3& a, const glm::dvec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

double importance(const gpu::LightTreeNode& node, const glm::dvec3& p, const glm::dvec3& ns) {
  if (node.radius == gpu::kLightTreeFixed) return static_cast<double>(node.intensity);
  const glm::dvec3 away = p - glm::dvec3(node.center);
  const double d = glm::length(away);
  const double radius = std::max(static_cast<double>(node.radius), 1e-7);
  if (d <= radius) return static_cast<double>(node.intensity) / (radius * radius);
  const double thetaB = std::asin(radius / d);
  const double thetaO = std::acos(snorm(node.cosines & 0xffffu));
  const double cosThetaE = snorm(node.cosines >> 16);
  double thetaW = angle(axisOf(node.axis), away);
  if (node.child & gpu::kLightTreeTwoSided) thetaW = std::min(thetaW, kPi - thetaW);
  const double emission = std::cos(std::max(std::max(thetaW - thetaO, 0.0) - thetaB, 0.0));
  if (emission < cosThetaE - 2e-3) return 0;
  double reception = 1;
  if (ns != glm::dvec3(0)) reception = std::cos(std::max(angle(ns, -away) - thetaB, 0.0));
  if (reception < -2e-3) return 0;
  return static_cast<double>(node.intensity) / (d * d) * std::max(emission, 0.01) * std::max(reception, 0.01);
}

} // namespace

double lightTreePmf(const LightTree& tree, uint32_t index, glm::dvec3 p, glm::dvec3 ns) {
  const uint32_t trail = tree.trails[index];
  if (trail == gpu::kNoLightTrail) return 0;
  const glm::dvec3 at = p * static_cast<double>(tree.scale);
  double pmf = 1;
  uint32_t node = 0;
  for (uint32_t depth = 0; !(tree.nodes[node].child & gpu::kLightTreeLeaf); ++depth) {
    const uint32_t first = tree.nodes[node].child & gpu::kLightTreeIndexMask;
    const double weights[2] = {importance(tree.nodes[first], at, ns), importance(tree.nodes[first + 1], at, ns)};
    const uint32_t taken = trail >> depth & 1u;
    if (!(weights[taken] > 0)) return 0;
    pmf *= weights[taken] / (weights[0] + weights[1]);
    node = first + taken;
  }
  return (tree.nodes[node].child & gpu::kLightTreeIndexMask) == index ? pmf : -1;
}

} // namespace isophote::oracle
