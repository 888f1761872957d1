// One light, one point or direction on it, and the densities that multiple importance sampling needs.
// Light indices run: emissive triangles, punctual lights, environment (shared/light_types.h).
#ifndef ISOPHOTE_LIGHT_LIGHT_SAMPLE_GLSL
#define ISOPHOTE_LIGHT_LIGHT_SAMPLE_GLSL

#include "light/emission.glsl"
#include "light/environment.glsl"
#include "light/light_choice.glsl"
#include "light/punctual.glsl"
#include "sampling/warp.glsl"

struct LightSample {
  vec3 point;          // on the light; unset where atInfinity
  vec3 pointError;     // half extents of the box that holds the exact point; 0 for punctual lights
  vec3 ngLight;        // unit geometric normal of the light's surface; 0 where it has none
  vec3 wi;             // unit, from the receiver to the light
  float distance;      // kRayInfinity where atInfinity
  vec3 radiance;       // of delta lights the irradiance on a surface facing wi
  float pdfSolidAngle; // per steradian, choice of the light included; of delta lights the probability of the choice
  bool delta;          // no other technique can find it
  bool atInfinity;
  bool valid; // false: nothing arrives, the other members are unspecified
};

// The smallest projected area, times distance 1, that a density is formed with; below it triangles count as seen
// edge-on.
const float kSmallestProjectedArea = 1e-37;

/// Converts the density of points on a surface to directions.
///
/// @return per steradian; 0 where the surface is seen edge-on, in sampling and hit alike
float areaToSolidAngle(float area, float cosLight, float distance) {
  const float projected = area * cosLight;
  return projected > kSmallestProjectedArea ? distance * (distance / projected) : 0.0;
}

LightSample noLightSample() {
  return LightSample(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), 0.0, vec3(0.0), 0.0, false, false, false);
}

LightSample sampleEmissiveTriangle(const SceneRef scene, uint emitter, float pmf, vec3 p, vec2 u) {
  const EmissiveTriangle light = EmissiveTriangleRef(scene.view.emissiveTriangles).items[emitter];
  const vec3 weights = sampleUniformTriangle(u);
  SurfaceHit surface = surfaceAt(scene, light.instance, light.triangle, weights.xy);
  const vec3 toLight = surface.p - p;
  LightSample result = noLightSample();
  result.distance = length(toLight);
  if (!(result.distance > 0.0)) return result;
  result.wi = toLight / result.distance;
  const float cosLight = -dot(surface.ng, result.wi);
  surface.frontFace = cosLight >= 0.0;
  result.point = surface.p;
  result.pointError = surface.pError;
  result.ngLight = surface.ng;
  result.pdfSolidAngle = pmf * areaToSolidAngle(surface.area, abs(cosLight), result.distance);
  result.radiance = emittedRadiance(scene, surface) * surfaceCoverage(scene, surface);
  result.valid = result.pdfSolidAngle > 0.0 && any(greaterThan(result.radiance, vec3(0.0)));
  return result;
}

LightSample samplePunctualLight(const SceneRef scene, uint index, float pmf, vec3 p) {
  const PunctualLightRecord light = PunctualLightRef(scene.view.punctualLights).items[index];
  const PunctualSample incident = punctualLightAt(light, p);
  LightSample result = noLightSample();
  result.point = light.position;
  result.wi = incident.wi;
  result.distance = incident.distance;
  result.radiance = incident.irradiance;
  result.pdfSolidAngle = pmf;
  result.delta = true;
  result.atInfinity = light.kind == kLightDirectional;
  result.valid = any(greaterThan(result.radiance, vec3(0.0)));
  return result;
}

LightSample sampleEnvironmentLight(const SceneRef scene, float pmf, vec2 u) {
  const EnvironmentSample incident = sampleEnvironment(scene, u);
  LightSample result = noLightSample();
  result.wi = incident.direction;
  result.distance = kRayInfinity;
  result.radiance = incident.radiance;
  result.pdfSolidAngle = pmf * incident.pdfSolidAngle;
  result.atInfinity = true;
  result.valid = result.pdfSolidAngle > 0.0 && any(greaterThan(result.radiance, vec3(0.0)));
  return result;
}

/// Samples the light that arrives at a receiver, visibility left open.
///
/// @param choiceBits  which light
/// @param u           where on it, multiples of 2^-24 in [0, 1)
LightSample sampleLight(const SceneRef scene, const LightReceiver receiver, uvec2 choiceBits, vec2 u) {
  if (scene.view.lightCount == 0u) return noLightSample();
  const LightChoice choice = chooseLight(scene, receiver, choiceBits);
  if (choice.pmf <= 0.0) return noLightSample();
  const uint triangleCount = kHasEmissiveTriangles ? scene.view.emissiveTriangleCount : 0u;
  const uint punctualCount = kHasPunctualLights ? scene.view.punctualLightCount : 0u;
  if (kHasEmissiveTriangles && choice.index < triangleCount) {
    return sampleEmissiveTriangle(scene, choice.index, choice.pmf, receiver.p, u);
  }
  if (kHasPunctualLights && choice.index < triangleCount + punctualCount) {
    return samplePunctualLight(scene, choice.index - triangleCount, choice.pmf, receiver.p);
  }
  if (kHasEnvironment) return sampleEnvironmentLight(scene, choice.pmf, u);
  return noLightSample();
}

/// Density per steradian with which sampleLight finds the point of an emissive triangle that a ray has hit.
///
/// @param surface   the hit; its flags hold kTriangleEmissive
/// @param cosLight  |cosine| between the ray and the surface's normal
/// @param distance  from the ray's origin to the hit
/// @param receiver  what sampleLight was given where the ray starts
float emitterPdfSolidAngle(const SceneRef scene, const SurfaceHit surface, float cosLight, float distance,
                           const LightReceiver receiver) {
  if (!kHasEmissiveTriangles || (surface.flags & kTriangleEmissive) == 0u) return 0.0;
  const uint firstEmitter = InstanceRef(scene.view.instances).items[surface.instance].firstEmitter;
  const uint firstEmissive = GeometryRef(scene.view.geometries).items[surface.geometry].firstEmissive;
  const float pmf = lightPmf(scene, receiver, firstEmitter + firstEmissive + surface.primitiveIndex);
  return pmf * areaToSolidAngle(surface.area, cosLight, distance);
}

/// Density per steradian with which sampleLight finds `direction` on the environment. Lights without a place have the
/// same probability everywhere, so there is no receiver.
float environmentHitPdf(const SceneRef scene, vec3 direction) {
  if (!kHasEnvironment) return 0.0;
  const float pmf = lightPmf(scene, LightReceiver(vec3(0.0), vec3(0.0)),
                             scene.view.emissiveTriangleCount + scene.view.punctualLightCount);
  return pmf > 0.0 ? pmf * environmentPdfSolidAngle(scene, direction) : 0.0;
}

#endif
