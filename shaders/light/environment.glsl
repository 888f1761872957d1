// The equirectangular environment: radiance, density, sampling. See EnvironmentRecord in shared/light_types.h.
// Within a texel directions are sampled uniformly in solid angle, so the density is one number per texel, at the poles
// too, and is found from the texel's index alone.
#ifndef ISOPHOTE_LIGHT_ENVIRONMENT_GLSL
#define ISOPHOTE_LIGHT_ENVIRONMENT_GLSL

#include "math/constants.glsl"
#include "math/trigonometry.glsl"
#include "shared/buffers.glsl"

struct EnvironmentSample {
  vec3 direction; // unit, towards the environment
  vec3 radiance;
  float pdfSolidAngle;
};

vec3 mapFromWorld(const EnvironmentRecord map, vec3 d) {
  return vec3(map.cosRotation * d.x - map.sinRotation * d.z, d.y, map.sinRotation * d.x + map.cosRotation * d.z);
}

vec3 worldFromMap(const EnvironmentRecord map, vec3 d) {
  return vec3(map.cosRotation * d.x + map.sinRotation * d.z, d.y, map.cosRotation * d.z - map.sinRotation * d.x);
}

/// Texture coordinates in [0, 1]^2 of a direction in the map's own orientation.
vec2 mapCoordinates(vec3 d) { return vec2(0.5 + 0.5 * atan2Pi(d.x, -d.z), atan2Pi(length(d.xz), d.y)); }

/// Solid angle of a texel, steradian: 2 pi / width (cos theta0 - cos theta1) as a product, exact to rounding at the
/// poles.
float texelSolidAngle(const EnvironmentRecord map, uint row) {
  const float height = float(map.height);
  return 4.0 * kPi / float(map.width) * sinCosPi(0.5 / height).x * sinCosPi((float(row) + 0.5) / height).x;
}

/// Bilinear lookup, periodic in u, clamped in v. One texel: exactly its value.
///
/// @param uv  in [0, 1]^2
vec3 lookUpEnvironment(const EnvironmentRecord map, vec2 uv) {
  Vec3Ref pixels = Vec3Ref(map.pixels);
  if (map.width * map.height == 1u) return pixels.items[0];
  const vec2 position = uv * vec2(map.width, map.height) - 0.5; // > -1
  const vec2 base = floor(position);
  const vec2 t = position - base;
  const uint column0 = base.x < 0.0 ? map.width - 1u : min(uint(base.x), map.width - 1u);
  const uint column1 = column0 + 1u == map.width ? 0u : column0 + 1u;
  const uint row0 = min(uint(max(base.y, 0.0)), map.height - 1u);
  const uint row1 = base.y < 0.0 ? 0u : min(row0 + 1u, map.height - 1u);
  const vec3 top = mix(pixels.items[row0 * map.width + column0], pixels.items[row0 * map.width + column1], t.x);
  const vec3 bottom = mix(pixels.items[row1 * map.width + column0], pixels.items[row1 * map.width + column1], t.x);
  return mix(top, bottom, t.y);
}

/// Radiance that arrives from `direction`.
///
/// @param direction  unit, world, away from the receiver
vec3 environmentRadiance(const SceneRef scene, vec3 direction) {
  const EnvironmentRecord map = scene.view.environment;
  return lookUpEnvironment(map, mapCoordinates(mapFromWorld(map, direction)));
}

/// Probability of sampling texel (column, row).
float texelProbability(const EnvironmentRecord map, uint column, uint row) {
  FloatRef marginal = FloatRef(map.marginal);
  FloatRef conditional = FloatRef(map.conditional);
  const uint first = row * (map.width + 1u) + column;
  return (marginal.items[row + 1u] - marginal.items[row]) * (conditional.items[first + 1u] - conditional.items[first]);
}

/// Density of sampleEnvironment at `direction`, per steradian.
float environmentPdfSolidAngle(const SceneRef scene, vec3 direction) {
  const EnvironmentRecord map = scene.view.environment;
  const vec2 texel = mapCoordinates(mapFromWorld(map, direction)) * vec2(map.width, map.height);
  const uint column = min(uint(texel.x), map.width - 1u);
  const uint row = min(uint(texel.y), map.height - 1u);
  return texelProbability(map, column, row) / texelSolidAngle(map, row);
}

/// The last i < count with sums[first + i] <= u: the bin of positive probability that u falls into.
uint findBin(const FloatRef sums, uint first, uint count, float u) {
  uint low = 0u;
  uint high = count;
  for (uint step = 0u; step < 32u && high - low > 1u; ++step) {
    const uint middle = (low + high) / 2u;
    if (sums.items[first + middle] <= u) {
      low = middle;
    } else {
      high = middle;
    }
  }
  return low;
}

/// Where u lies within its bin, in (0, 1): the middle of u's own 2^-24 step.
float placeInBin(const FloatRef sums, uint bin, float u) {
  return ((u - sums.items[bin]) + 2.9802322387695312e-8) / (sums.items[bin + 1u] - sums.items[bin]);
}

/// The direction, in the map's orientation, at `place` in texel (column, row).
///
/// Rows below the middle are mirrored, so that sin^2(theta / 2) keeps its relative precision at both poles.
vec3 directionInTexel(const EnvironmentRecord map, uint column, uint row, vec2 place) {
  const float height = float(map.height);
  const bool mirrored = 2u * row >= map.height && map.height > 1u;
  const uint fromPole = mirrored ? map.height - 1u - row : row;
  const float edge = sinCosPi(0.5 * float(fromPole) / height).x;
  const float extent = sinCosPi(0.5 / height).x * sinCosPi((float(fromPole) + 0.5) / height).x;
  // sin^2(theta / 2), linear in cos(theta)
  const float s = min(edge * edge + (mirrored ? 1.0 - place.y : place.y) * extent, 1.0);
  const float cosTheta = mirrored ? 2.0 * s - 1.0 : 1.0 - 2.0 * s;
  const float sinTheta = 2.0 * sqrt(s * (1.0 - s));
  const float width = float(map.width);
  const vec2 sinCosPhi = sinCosPi(float(2 * int(column) - int(map.width)) / width + 2.0 * place.x / width);
  return vec3(sinTheta * sinCosPhi.x, cosTheta, -sinTheta * sinCosPhi.y);
}

/// Samples directions by the density of upload/environment_density.hpp, positive wherever the radiance is.
///
/// @param u  multiples of 2^-24 in [0, 1)
/// @return   pdfSolidAngle > 0
EnvironmentSample sampleEnvironment(const SceneRef scene, vec2 u) {
  const EnvironmentRecord map = scene.view.environment;
  FloatRef marginal = FloatRef(map.marginal);
  FloatRef conditional = FloatRef(map.conditional);
  const uint row = findBin(marginal, 0u, map.height, u.y);
  const uint first = row * (map.width + 1u);
  const uint column = findBin(conditional, first, map.width, u.x);
  const vec2 place = vec2(placeInBin(conditional, first + column, u.x), placeInBin(marginal, row, u.y));
  const vec3 direction = directionInTexel(map, column, row, place);
  EnvironmentSample result;
  result.direction = worldFromMap(map, direction);
  result.radiance = lookUpEnvironment(map, mapCoordinates(direction));
  result.pdfSolidAngle = texelProbability(map, column, row) / texelSolidAngle(map, row);
  return result;
}

#endif
