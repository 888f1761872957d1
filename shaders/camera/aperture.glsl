// Points on the lens of a camera.
#ifndef ISOPHOTE_CAMERA_APERTURE_GLSL
#define ISOPHOTE_CAMERA_APERTURE_GLSL

#include "sampling/warp.glsl"

/// Samples the opening between `bladeCount` straight blades uniformly: a regular polygon with corners on the unit
/// circle, the first of them at (1, 0).
///
/// @param bladeCount  0: the unit disk; else at least 3
/// @param u           in [0, 1)^2
vec2 sampleAperture(uint bladeCount, vec2 u) {
  if (bladeCount == 0u) return sampleUniformDisk(u);
  const float count = float(bladeCount);
  const float x = u.x * count;
  const float sector = min(floor(x), count - 1.0); // triangle between the center and two corners
  const vec3 weights = sampleUniformTriangle(vec2(x - sector, u.y));
  return weights.y * sinCosPi(2.0 * sector / count).yx + weights.z * sinCosPi(2.0 * (sector + 1.0) / count).yx;
}

#endif
