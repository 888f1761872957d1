// A camera that turns about a point. Mathematics only: no window, no device.
#pragma once

#include <glm/glm.hpp>

#include "isophote/scene.hpp"

namespace isophote::viewer {

/// Turns, moves and comes closer, always upright (world up is +y; a start camera's roll is dropped).
class OrbitCamera {
public:
  /// Starts where `start` is. The point turned about lies on its line of sight, beside the middle of `bounds`.
  OrbitCamera(const Camera& start, const Bounds& bounds);

  /// @param x, y  how far the pointer was dragged right and down, in window heights; one height is half a turn
  void orbit(double x, double y);
  /// Moves the point so that what lies in its plane follows the pointer.
  /// @param x, y  as in orbit
  void pan(double x, double y);
  /// @param steps  positive comes closer; ten steps are a factor of e
  void dolly(double steps);

  /// @param aspectRatio  width / height of the image
  [[nodiscard]] Camera camera(double aspectRatio) const;

private:
  Camera lens_; ///< everything but where it stands
  glm::dvec3 target_{0};
  double distance_ = 1;  ///< of the camera from the target
  double azimuth_ = 0;   ///< radians; 0: the camera stands towards +z
  double elevation_ = 0; ///< radians in [-pi/2, pi/2]; positive: the camera stands above

  [[nodiscard]] glm::dvec3 back() const;
  [[nodiscard]] glm::dvec3 right() const;
};

} // namespace isophote::viewer
