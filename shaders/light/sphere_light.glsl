// Spheres that shine: point and spot lights with a radius. They reflect nothing and let nothing through.
#ifndef ISOPHOTE_LIGHT_SPHERE_LIGHT_GLSL
#define ISOPHOTE_LIGHT_SPHERE_LIGHT_GLSL

#include "geometry/ray_sphere.glsl"
#include "light/area_measure.glsl"
#include "light/punctual.glsl"
#include "math/frame.glsl"
#include "sampling/warp.glsl"
#include "shared/constants.glsl"

const uint kSphereByCone = 0u; // values of kSphereLightSampling, as isophote::SphereLightSampling
const uint kSphereByArea = 1u;

// Below this squared sine of its half angle a sphere counts as too far to be seen: the density of its cone would leave
// the range of float.
const float kSmallestSinSquared = 1e-36;

struct SphereSample {
  vec3 normal; // unit, outward
  vec3 wi;     // unit, towards the point
  float distance;
  float pdfSolidAngle; // 0: the point is not seen
};

bool isSphereLight(const PunctualLightRecord light) {
  return kHasSphereLights && light.kind != kLightDirectional && light.size > 0.0;
}

/// Radiance that arrives at p from a sphere light in direction wi, inside and outside alike: per direction the
/// intensity of the point light over the sphere's cross section.
///
/// @param wi  unit, from p towards the light
vec3 sphereLightRadiance(const PunctualLightRecord light, vec3 p, vec3 wi) {
  float attenuation = rangeWindow(distance(light.position, p), light.range);
  if (light.kind == kLightSpot) attenuation *= spotFalloff(-dot(wi, light.direction), light.cosInner, light.cosOuter);
  return light.intensity * attenuation;
}

/// 1 - cos of the half angle under which a sphere is seen, with its relative precision kept from afar; 2, every
/// direction, from inside.
float sphereOneMinusCos(float centerDistance, float radius) {
  if (centerDistance <= radius) return 2.0;
  const float sine = radius / centerDistance;
  return oneMinusCosFromSinSquared(sine * sine);
}

/// Samples the directions in which a sphere is seen, uniformly in solid angle.
///
/// Source: Pharr, Jakob, Humphreys 2023, "Physically Based Rendering" 4ed, section 6.2.4, with the point found without
/// differences of distances: relative to the center, the ray passes nearest at d sin(theta) (cos(theta) e - sin(theta)
/// c) for center distance d, center direction c and e the direction across it.
SphereSample sampleSphereByCone(vec3 center, float radius, vec3 p, vec2 u) {
  const vec3 toCenter = center - p;
  const float centerDistance = length(toCenter);
  const float oneMinusCosMax = sphereOneMinusCos(centerDistance, radius);
  const Frame frame = frameFromNormal(centerDistance > 0.0 ? toCenter / centerDistance : vec3(0.0, 0.0, 1.0));
  const vec3 w = sampleUniformCone(u, oneMinusCosMax);
  const vec3 nearest = (centerDistance / radius) * vec3(w.z * w.xy, -dot(w.xy, w.xy));
  const float halfChord = sqrt(max(1.0 - dot(nearest, nearest), 0.0));
  const float side = centerDistance <= radius ? 1.0 : -1.0; // from inside the ray ends where it leaves the sphere
  SphereSample result;
  result.normal = toWorld(frame, nearest + (side * halfChord) * w);
  result.wi = toWorld(frame, w);
  result.distance = centerDistance * w.z + side * halfChord * radius;
  result.pdfSolidAngle = oneMinusCosMax > kSmallestSinSquared ? pdfUniformCone(oneMinusCosMax) : 0.0;
  return result;
}

float sphereArea(float radius) { return 4.0 * kPi * radius * radius; }

/// Samples the sphere's area uniformly. What is on the far side as seen from outside has no density.
SphereSample sampleSphereByArea(vec3 center, float radius, vec3 p, vec2 u) {
  SphereSample result;
  result.normal = sampleUniformSphere(u);
  const vec3 toPoint = (center - p) + radius * result.normal;
  result.distance = length(toPoint);
  result.wi = result.distance > 0.0 ? toPoint / result.distance : result.normal;
  const float cosLight = dot(result.normal, result.wi);
  const bool seen = cosLight < 0.0 || distance(center, p) <= radius;
  result.pdfSolidAngle = seen ? areaToSolidAngle(sphereArea(radius), abs(cosLight), result.distance) : 0.0;
  return result;
}

SphereSample sampleSphere(vec3 center, float radius, vec3 p, vec2 u) {
  if (kSphereLightSampling == kSphereByArea) return sampleSphereByArea(center, radius, p, u);
  return sampleSphereByCone(center, radius, p, u);
}

/// Density per steradian with which sampleSphere from p finds a direction in which the sphere is seen.
///
/// @param wi  unit; a ray from p along it meets the sphere
float spherePdfSolidAngle(vec3 center, float radius, vec3 p, vec3 wi) {
  if (kSphereLightSampling == kSphereByArea) {
    const SphereHit hit = intersectSphere(p, wi, center, radius, 0.0);
    return areaToSolidAngle(sphereArea(radius), hit.halfChord / radius, hit.t);
  }
  const float oneMinusCosMax = sphereOneMinusCos(distance(center, p), radius);
  return oneMinusCosMax > kSmallestSinSquared ? pdfUniformCone(oneMinusCosMax) : 0.0;
}

#endif
