// One light, one point or direction on it, and the densities that multiple importance sampling needs.
// Light indices run: emissive triangles, lights of KHR_lights_punctual, environment (shared/light_types.h).
#ifndef ISOPHOTE_LIGHT_LIGHT_SAMPLE_GLSL
#define ISOPHOTE_LIGHT_LIGHT_SAMPLE_GLSL

#include "light/area_measure.glsl"
#include "light/emission.glsl"
#include "light/environment.glsl"
#include "light/light_choice.glsl"
#include "light/punctual.glsl"
#include "light/sphere_light.glsl"
#include "light/spherical_triangle.glsl"
#include "light/sun.glsl"
#include "sampling/warp.glsl"

struct LightSample {
  vec3 point;          // on the light; unset where atInfinity
  vec3 pointError;     // half extents of the box that holds the exact point; 0 for punctual lights
  vec3 ngLight;        // unit geometric normal of the light's surface; 0 where it has none
  vec3 wi;             // unit, from the receiver to the light
  float distance;      // kRayInfinity where atInfinity
  vec3 radiance;       // of delta lights the irradiance on a surface facing wi
  float pdfSolidAngle; // per steradian, choice of the light included; of delta lights the probability of the choice
  uint target;         // instance that the shadow ray ends on and that does not block it: of a sphere light, else
                       // kInvalidIndex
  bool delta;          // no other technique can find it
  bool atInfinity;
  bool valid; // false: nothing arrives, the other members are unspecified
};

LightSample noLightSample() {
  return LightSample(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), 0.0, vec3(0.0), 0.0, kInvalidIndex, false, false,
                     false);
}

const uint kTriangleBySolidAngle = 1u; // value of kTriangleLightSampling, as isophote::TriangleLightSampling

SphericalTriangle emitterSeenFrom(const SceneRef scene, uint instance, uint triangle, vec3 p) {
  BvhTriangleRef triangles = BvhTriangleRef(scene.view.triangles);
  const Affine worldFromObject = worldFromObjectOf(InstanceRef(scene.view.instances), instance);
  return sphericalTriangle(p, transformPoint(worldFromObject, triangles.items[triangle].v0),
                           transformPoint(worldFromObject, triangles.items[triangle].v1),
                           transformPoint(worldFromObject, triangles.items[triangle].v2));
}

LightSample sampleEmissiveTriangle(const SceneRef scene, uint emitter, float pmf, vec3 p, vec2 u) {
  const EmissiveTriangle light = EmissiveTriangleRef(scene.view.emissiveTriangles).items[emitter];
  vec2 barycentrics = sampleUniformTriangle(u).xy;
  float pdfSpherical = 0.0; // 0: sampled by area
  if (kTriangleLightSampling == kTriangleBySolidAngle) {
    const SphericalTriangle seen = emitterSeenFrom(scene, light.instance, light.triangle, p);
    if (isStable(seen)) {
      barycentrics = sampleSphericalTriangle(seen, u).yz;
      pdfSpherical = 1.0 / seen.solidAngle;
    }
  }
  SurfaceHit surface = surfaceAt(scene, light.instance, light.triangle, barycentrics);
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
  result.pdfSolidAngle =
      pmf * (pdfSpherical > 0.0 ? pdfSpherical : areaToSolidAngle(surface.area, abs(cosLight), result.distance));
  result.radiance = emittedRadiance(scene, surface) * surfaceCoverage(scene, surface);
  result.valid = result.pdfSolidAngle > 0.0 && any(greaterThan(result.radiance, vec3(0.0)));
  return result;
}

LightSample sampleSphereLight(const PunctualLightRecord light, float pmf, vec3 p, vec2 u) {
  const SphereSample point = sampleSphere(light.position, light.size, p, u);
  LightSample result = noLightSample();
  result.point = light.position + light.size * point.normal;
  // One rounding of the sum, and what the frame and the square root leave of the normal's precision.
  result.pointError = kRoundingError * (abs(result.point) + 16.0 * light.size);
  result.ngLight = point.normal;
  result.wi = point.wi;
  result.distance = point.distance;
  result.radiance = sphereLightRadiance(light, p, point.wi);
  result.pdfSolidAngle = pmf * point.pdfSolidAngle;
  result.target = light.instance;
  result.valid = result.pdfSolidAngle > 0.0 && any(greaterThan(result.radiance, vec3(0.0)));
  return result;
}

LightSample sampleSunLight(const PunctualLightRecord sun, float pmf, vec2 u) {
  LightSample result = noLightSample();
  result.wi = sampleSun(sun, u);
  result.distance = kRayInfinity;
  result.radiance = sun.intensity;
  result.pdfSolidAngle = pmf * pdfUniformCone(sun.size);
  result.atInfinity = true;
  result.valid = result.pdfSolidAngle > 0.0 && any(greaterThan(result.radiance, vec3(0.0)));
  return result;
}

LightSample samplePunctualLight(const SceneRef scene, uint index, float pmf, vec3 p, vec2 u) {
  const PunctualLightRecord light = PunctualLightRef(scene.view.punctualLights).items[index];
  if (isSphereLight(light)) return sampleSphereLight(light, pmf, p, u);
  if (isSun(light)) return sampleSunLight(light, pmf, u);
  if (!kHasPunctualLights) return noLightSample();
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
  const bool hasPunctual = kHasPunctualLights || kHasSphereLights || kHasSuns;
  const uint punctualCount = hasPunctual ? scene.view.punctualLightCount : 0u;
  if (kHasEmissiveTriangles && choice.index < triangleCount) {
    return sampleEmissiveTriangle(scene, choice.index, choice.pmf, receiver.p, u);
  }
  if (hasPunctual && choice.index < triangleCount + punctualCount) {
    return samplePunctualLight(scene, choice.index - triangleCount, choice.pmf, receiver.p, u);
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
  if (kTriangleLightSampling == kTriangleBySolidAngle) {
    const SphericalTriangle seen = emitterSeenFrom(scene, surface.instance, surface.triangle, receiver.p);
    if (isStable(seen)) return pmf / seen.solidAngle;
  }
  return pmf * areaToSolidAngle(surface.area, cosLight, distance);
}

/// Density per steradian with which sampleLight finds the point of sphere light `light`, a light index, that a ray has
/// hit.
///
/// @param p, wi     the ray's origin and unit direction
/// @param receiver  what sampleLight was given where the ray starts
float sphereLightHitPdf(const SceneRef scene, uint light, const PunctualLightRecord sphere, vec3 p, vec3 wi,
                        const LightReceiver receiver) {
  return lightPmf(scene, receiver, light) * spherePdfSolidAngle(sphere.position, sphere.size, p, wi);
}

// Lights without a place have the same probability everywhere: any receiver will do.
const LightReceiver kAnyReceiver = LightReceiver(vec3(0.0), vec3(0.0));

/// Density per steradian with which sampleLight finds a direction on sun number `index`.
float sunHitPdf(const SceneRef scene, uint index, const PunctualLightRecord sun) {
  return lightPmf(scene, kAnyReceiver, scene.view.emissiveTriangleCount + index) * pdfUniformCone(sun.size);
}

/// Density per steradian with which sampleLight finds `direction` on the environment.
float environmentHitPdf(const SceneRef scene, vec3 direction) {
  if (!kHasEnvironment) return 0.0;
  const float pmf = lightPmf(scene, kAnyReceiver, scene.view.emissiveTriangleCount + scene.view.punctualLightCount);
  return pmf > 0.0 ? pmf * environmentPdfSolidAngle(scene, direction) : 0.0;
}

#endif
