// The equirectangular environment: radiance, density, sampling. See EnvironmentRecord in shared/light_types.h.
// The density follows the bilinear lookup: a cell between four texel centers is chosen, and within it a point in
// proportion to their mixed luminances, linear in azimuth and in cos(theta) instead of theta, which makes it exactly
// normalized per steradian, at the poles too.
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

/// Probability of sampling cell (column, row).
float cellProbability(const EnvironmentRecord map, uint column, uint row) {
  FloatRef marginal = FloatRef(map.marginal);
  FloatRef conditional = FloatRef(map.conditional);
  const uint first = row * (map.width + 1u) + column;
  return (marginal.items[row + 1u] - marginal.items[row]) * (conditional.items[first + 1u] - conditional.items[first]);
}

/// Where a row of cells lies, seen from the pole that is nearer: rows below the middle are mirrored, so that
/// sin^2(theta / 2), which is linear in cos(theta), keeps its relative precision at both.
struct CellRow {
  bool mirrored;
  float edge;   // sin^2(theta / 2) at the edge nearer to the pole
  float extent; // what it grows by up to the other edge, a product, exact to rounding at the poles
};

CellRow cellRow(const EnvironmentRecord map, const uint row) {
  const float height = float(map.height);
  CellRow result;
  result.mirrored = 2u * row > map.height;
  const float fromPole = float(result.mirrored ? map.height - row : row);
  const float edge = sinCosPi(0.5 * max(fromPole - 0.5, 0.0) / height).x;
  result.edge = edge * edge;
  const vec2 halves = fromPole == 0.0 ? vec2(0.25) : vec2(fromPole, 0.5); // of the edges' sum and difference
  result.extent = sinCosPi(halves.x / height).x * sinCosPi(halves.y / height).x;
  return result;
}

/// Luminances of the texels around a cell: left and right above, left and right below.
vec4 cellCorners(const EnvironmentRecord map, const uint column, const uint row) {
  Vec3Ref pixels = Vec3Ref(map.pixels);
  const uint next = column + 1u == map.width ? 0u : column + 1u;
  const uint above = row == 0u ? 0u : row - 1u;
  const uint below = min(row, map.height - 1u);
  const vec3 luminance = vec3(0.2126, 0.7152, 0.0722);
  return vec4(
      dot(pixels.items[above * map.width + column], luminance), dot(pixels.items[above * map.width + next], luminance),
      dot(pixels.items[below * map.width + column], luminance), dot(pixels.items[below * map.width + next], luminance));
}

/// Density per steradian at `place` in a cell: x to the right, y downwards, in [0, 1].
float cellPdfSolidAngle(const EnvironmentRecord map, const uint column, const uint row, const vec4 corners,
                        const float extent, const vec2 place) {
  const float sum = corners.x + corners.y + corners.z + corners.w;
  const vec2 sides = mix(corners.xy, corners.zw, place.y);
  const float shape = sum > 0.0 ? 4.0 * mix(sides.x, sides.y, place.x) / sum : 1.0;
  return cellProbability(map, column, row) * shape * float(map.width) / (4.0 * kPi * extent);
}

/// Density of sampleEnvironment at `direction`, per steradian.
float environmentPdfSolidAngle(const SceneRef scene, vec3 direction) {
  const EnvironmentRecord map = scene.view.environment;
  const vec3 d = mapFromWorld(map, direction);
  const vec2 position = mapCoordinates(d) * vec2(map.width, map.height) + vec2(-0.5, 0.5);
  const float left = floor(position.x);
  const uint column = left < 0.0 ? map.width - 1u : min(uint(left), map.width - 1u);
  const uint row = min(uint(position.y), map.height);
  const CellRow cells = cellRow(map, row);
  const float up = cells.mirrored ? -d.y : d.y;
  const float s = up > 0.0 ? dot(d.xz, d.xz) / (2.0 * (1.0 + up)) : 0.5 * (1.0 - up);
  const float fromPole = clamp((s - cells.edge) / cells.extent, 0.0, 1.0);
  const vec2 place = vec2(position.x - left, cells.mirrored ? 1.0 - fromPole : fromPole);
  return cellPdfSolidAngle(map, column, row, cellCorners(map, column, row), cells.extent, place);
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

/// A point of [0, 1] whose density grows linearly from a to b, neither negative.
///
/// @param u  in (0, 1)
float sampleLinear(const float u, const float a, const float b) {
  const float largest = max(a, b);
  if (!(largest > 0.0)) return u;
  const float low = a / largest;
  const float high = b / largest;
  return min(u * (low + high) / (low + sqrt(mix(low * low, high * high, u))), 1.0);
}

/// The direction, in the map's orientation, at `place` in a cell.
vec3 directionInCell(const EnvironmentRecord map, const uint column, const CellRow cells, const vec2 place) {
  const float s = min(cells.edge + (cells.mirrored ? 1.0 - place.y : place.y) * cells.extent, 1.0);
  const float cosTheta = cells.mirrored ? 2.0 * s - 1.0 : 1.0 - 2.0 * s;
  const float sinTheta = 2.0 * sqrt(s * (1.0 - s));
  const float width = float(map.width);
  float halfTurns = float(2 * int(column) + 1 - int(map.width)) / width + 2.0 * place.x / width;
  if (halfTurns > 1.0) halfTurns -= 2.0;
  const vec2 sinCosPhi = sinCosPi(halfTurns);
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
  const uint row = findBin(marginal, 0u, map.height + 1u, u.y);
  const uint first = row * (map.width + 1u);
  const uint column = findBin(conditional, first, map.width, u.x);
  const vec4 corners = cellCorners(map, column, row);
  vec2 place;
  place.y = sampleLinear(placeInBin(marginal, row, u.y), corners.x + corners.y, corners.z + corners.w);
  const vec2 sides = mix(corners.xy, corners.zw, place.y);
  place.x = sampleLinear(placeInBin(conditional, first + column, u.x), sides.x, sides.y);
  const CellRow cells = cellRow(map, row);
  const vec3 direction = directionInCell(map, column, cells, place);
  EnvironmentSample result;
  result.direction = worldFromMap(map, direction);
  result.radiance = lookUpEnvironment(map, mapCoordinates(direction));
  result.pdfSolidAngle = cellPdfSolidAngle(map, column, row, corners, cells.extent, place);
  return result;
}

#endif
