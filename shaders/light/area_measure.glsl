// Densities of points on a surface as densities of directions.
#ifndef ISOPHOTE_LIGHT_AREA_MEASURE_GLSL
#define ISOPHOTE_LIGHT_AREA_MEASURE_GLSL

// The smallest projected area, times distance 1, that a density is formed with; below it surfaces count as seen
// edge-on.
const float kSmallestProjectedArea = 1e-37;

/// Converts the density of points on a surface to directions.
///
/// @return per steradian; 0 where the surface is seen edge-on, in sampling and hit alike
float areaToSolidAngle(float area, float cosLight, float distance) {
  const float projected = area * cosLight;
  return projected > kSmallestProjectedArea ? distance * (distance / projected) : 0.0;
}

#endif
