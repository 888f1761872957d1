// A path's ray inside a scattering medium: it scatters on its way (a light sample, a new direction), or reaches the
// surface it would hit.
#ifndef ISOPHOTE_KERNELS_SHADE_MEDIUM_GLSL
#define ISOPHOTE_KERNELS_SHADE_MEDIUM_GLSL

#include "geometry/surface.glsl"
#include "kernels/handover.glsl"
#include "kernels/mis.glsl"
#include "kernels/shadow_ray.glsl"
#include "kernels/straight_shadow.glsl"
#include "kernels/vertex.glsl"
#include "medium/henyey_greenstein.glsl"
#include "medium/medium_stack.glsl"
#include "sampling/sampler.glsl"

// Pairs of random numbers of the free paths: beyond those of 2^26 vertices.
const uint kFirstSegmentPair = 1u << 28u;

// A scattering this close to the hit, relative to the coordinates, is moved to the hit's own safe side: rounding might
// put it on the other one.
const float kCloseToSurface = 1e-5;

vec3 scatteringPoint(const SceneRef scene, const uint slot, const RayState ray, const float distance,
                     const float hitDistance) {
  const vec3 p = ray.origin + distance * ray.direction;
  const vec3 size = max(abs(ray.origin), abs(p));
  if (hitDistance - distance > kCloseToSurface * max(size.x, max(size.y, size.z))) return p;
  const HitState hit = hitOf(slot);
  if (kHasSphereLights && hit.triangle == kInvalidIndex) return p;
  const SurfaceHit surface = surfaceAt(scene, hit.instance, hit.triangle, hit.barycentrics, -ray.direction);
  const vec3 limit = offsetRayOrigin(surface.p, surface.pError, surface.ng, -ray.direction);
  return dot(p - limit, surface.ng) < 0.0 ? limit : p;
}

void sampleLightFromMedium(const SceneRef scene, const vec3 p, const vec3 wo, const float g, const SampleKey key,
                           const uint pair, const uint slot, const vec3 beta) {
  const LightReceiver receiver = LightReceiver(p, vec3(0.0)); // it has no normal
  if (keepsReceivers()) ReceiverRef(pc.receivers).items[slot] = receiver;
  const LightSample light = sampleLight(scene, receiver, sampleBits2d(key, pair + 1u), sample2d(key, pair));
  if (!light.valid || (kLightSampling == 2u && !light.delta)) return;
  const float phase = evalHenyeyGreenstein(wo, light.wi, g);
  float weight = 1.0;
  if (kLightSampling == 0u && !light.delta) weight = misWeight(light.pdfSolidAngle, phase);
  const vec3 contribution = beta * phase * light.radiance * (weight / light.pdfSolidAngle);
  if (all(equal(contribution, vec3(0.0)))) return;
  keepLightWeight(slot, weight);
  MediaRef(pc.media).items[slot].shadow = MediaRef(pc.media).items[slot].path;
  sendShadowRay(slot, p, light, contribution);
}

// Scatters at p; false where the path ends.
bool scatter(const SceneRef scene, const vec3 p, const vec3 wo, const float g, const uint slot, const SampleKey key,
             inout PathState path) {
  if (!scattersHere(slot, path)) return false;
  const uint pair = kFirstVertexPair + kVertexPairs * path.depth;
  if (samplesLights()) {
    sampleLightFromMedium(scene, p, wo, g, key, pair, slot, path.beta);
  }
  const vec3 wi = sampleHenyeyGreenstein(wo, g, sample2d(key, pair + 2u));
  path.depth += 1u;
  path.pdfSolidAngle = evalHenyeyGreenstein(wo, wi, g);
  float power = max(path.beta.x, max(path.beta.y, path.beta.z));
  if (kHasTransmission) power *= InteriorRef(pc.interiors).items[slot].etaScale;
  if (!survivesRoulette(power, sample2d(key, pair + 3u).y, path)) return false;
  if (kStraightShadows) StraightRef(pc.straight).items[slot].path = kStraightSampled;
  handRay(slot, RayState(p, 0.0, wi, kRayInfinity));
  MediaRef(pc.media).items[slot].travelled = 0.0;
  return true;
}

/// Takes a path through a scattering medium, up to what its ray has met: the rays that leave where it scatters are
/// handed over.
///
/// @return the queue of the path's next stage
uint shadeMedium(const uint slot, inout PathState path) {
  SceneRef scene = SceneRef(pc.scene);
  MediaRef media = MediaRef(pc.media);
  const RayState ray = rayOf(slot);
  const Medium medium = mediumOf(scene, currentMedium(scene, media.items[slot].path));
  const SampleKey key = SampleKey(path.pixel, path.sampleIndex, RenderRef(pc.render).view.seed);
  const uint segment = media.items[slot].segments;
  media.items[slot].segments = segment + 1u;
  const float hitDistance = media.items[slot].hitDistance;

  const DistanceSample found =
      sampleDistance(medium, path.beta, hitDistance, sampleBits2d(key, kFirstSegmentPair + segment));
  path.beta *= found.weight;
  bool alive = any(greaterThan(path.beta, vec3(0.0)));
  if (alive && found.scattered) {
    if (path.depth == 0u) path.hit = 1u;
    const vec3 p = scatteringPoint(scene, slot, ray, found.distance, hitDistance);
    alive = scatter(scene, p, -ray.direction, medium.anisotropy, slot, key, path);
  }
  if (!alive) return kQueueFinished;
  if (found.scattered) return kQueueRay;
  return kHasSphereLights && hitOf(slot).triangle == kInvalidIndex ? kQueueEscaped : kQueueSurface;
}

#endif
