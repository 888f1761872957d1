#include "viewer/orbit_camera.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace isophote::viewer {
namespace {

constexpr double kPi = std::numbers::pi;

double safeRadius(const Bounds& bounds) {
  const double radius = bounds.empty() ? 1 : 0.5 * glm::length(bounds.upper - bounds.lower);
  return radius > 0 ? radius : 1;
}

} // namespace

OrbitCamera::OrbitCamera(const Camera& start, const Bounds& bounds) : lens_(start) {
  const glm::dvec3 position(start.worldFromCamera[3]);
  const glm::dvec3 startBack = glm::normalize(glm::dvec3(start.worldFromCamera[2]));
  const glm::dvec3 startRight(start.worldFromCamera[0]);
  const glm::dvec3 center = bounds.empty() ? glm::dvec3(0) : 0.5 * (bounds.lower + bounds.upper);

  elevation_ = std::asin(std::clamp(startBack.y, -1.0, 1.0));
  // Straight up or down the line of sight has no azimuth of its own.
  const bool vertical = std::hypot(startBack.x, startBack.z) < 1e-6;
  azimuth_ = vertical ? std::atan2(-startRight.z, startRight.x) : std::atan2(startBack.x, startBack.z);

  const double along = glm::dot(center - position, -startBack);
  const double radius = safeRadius(bounds);
  distance_ = along > 1e-3 * radius ? along : radius;
  target_ = position - distance_ * startBack;
}

glm::dvec3 OrbitCamera::back() const {
  return {std::sin(azimuth_) * std::cos(elevation_), std::sin(elevation_), std::cos(azimuth_) * std::cos(elevation_)};
}

glm::dvec3 OrbitCamera::right() const { return {std::cos(azimuth_), 0, -std::sin(azimuth_)}; }

void OrbitCamera::orbit(double x, double y) {
  azimuth_ = std::remainder(azimuth_ - kPi * x, 2 * kPi);
  elevation_ = std::clamp(elevation_ + kPi * y, -0.5 * kPi, 0.5 * kPi);
}

void OrbitCamera::pan(double x, double y) {
  const bool orthographic = lens_.kind == CameraKind::Orthographic;
  const double height = 2 * (orthographic ? lens_.ymag : distance_ * std::tan(0.5 * lens_.yfov));
  const glm::dvec3 up = glm::cross(back(), right());
  target_ += height * (y * up - x * right());
}

void OrbitCamera::dolly(double steps) {
  const double factor = std::exp(-0.1 * steps);
  distance_ *= factor;
  lens_.ymag *= factor; // what an orthographic camera sees does not depend on its distance
}

Camera OrbitCamera::camera(double aspectRatio) const {
  Camera result = lens_;
  result.aspectRatio.reset();
  result.xmag = lens_.ymag * aspectRatio;
  const glm::dvec3 b = back();
  const glm::dvec3 r = right();
  result.worldFromCamera = glm::dmat4(glm::dvec4(r, 0), glm::dvec4(glm::cross(b, r), 0), glm::dvec4(b, 0),
                                      glm::dvec4(target_ + distance_ * b, 1));
  return result;
}

} // namespace isophote::viewer
