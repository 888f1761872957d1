// A path at a surface: emission with MIS, one light sample, one BSDF sample, Russian roulette.
#ifndef ISOPHOTE_KERNELS_SHADE_SURFACE_GLSL
#define ISOPHOTE_KERNELS_SHADE_SURFACE_GLSL

#include "bsdf/direction_sampling.glsl"
#include "bsdf/material.glsl"
#include "bsdf/surface_bsdf.glsl"
#include "film/aov.glsl"
#include "geometry/ray_offset.glsl"
#include "geometry/surface.glsl"
#include "kernels/absorption.glsl"
#include "kernels/handover.glsl"
#include "kernels/mis.glsl"
#include "kernels/shadow_ray.glsl"
#include "kernels/straight_shadow.glsl"
#include "kernels/vertex.glsl"
#include "kernels/wavefront.glsl"
#include "light/emission.glsl"
#include "light/light_sample.glsl"
#include "math/frame.glsl"
#include "medium/medium_stack.glsl"
#include "sampling/sampler.glsl"

// The pair of random numbers whose first chooses a path's color channel, beyond those of any vertex.
const uint kChannelPair = (1u << 29) - 1u;

// A light's contribution at the surface, put up for the visibility test.
void sampleDirectLight(const SceneRef scene, const SurfaceHit surface, const SurfaceMaterial material,
                       const BsdfAtWo at, const Frame frame, const vec3 woLocal, const MediumCrossing crossing,
                       const LightReceiver receiver, const SampleKey key, const uint pair, const uint slot,
                       const vec3 beta) {
  const LightSample light = sampleLight(scene, receiver, sampleBits2d(key, pair + 1u), sample2d(key, pair));
  if (!light.valid || (kLightSampling == 2u && !light.delta)) return;
  const vec3 wiLocal = toLocal(frame, light.wi);
  // Both normals must agree on the side.
  if (wiLocal.z * dot(surface.ng, light.wi) <= 0.0 || (!kHasFarSide && wiLocal.z < 0.0)) return;
  const BsdfValue bsdf = evaluateDirection(scene, material.bsdf, at, woLocal, wiLocal);
  float weight = 1.0;
  if (kLightSampling == 0u && !light.delta) weight = misWeight(light.pdfSolidAngle, bsdf.pdfSolidAngle);
  const bool glass = isGlass(material.bsdf);
  if (glass && wiLocal.z < 0.0 && isCountedBehindGlass(slot)) return;
  const vec3 contribution = beta * bsdf.fCos * light.radiance * (weight / light.pdfSolidAngle);
  if (all(equal(contribution, vec3(0.0)))) return;

  keepLightWeight(slot, glass ? 0.0 : weight);
  if (kHasVolumes) MediaRef(pc.media).items[slot].shadow = wiLocal.z < 0.0 ? crossing.across : crossing.here;
  const vec3 origin = offsetRayOrigin(surface.p, surface.pError, surface.ng, light.wi);
  sendShadowRay(slot, origin, light, contribution);
}

// Index of the color channel that a path has at dispersive glass. The first one it meets chooses it, and the path goes
// on with three times its light in that channel alone; elsewhere the nominal index, green's.
uint dispersedChannel(const SceneRef scene, const SurfaceHit surface, const SampleKey key, const uint slot,
                      out vec3 kept) {
  kept = vec3(1.0);
  if (!kHasDispersion || !isDispersive(MaterialRef(scene.view.materials).items[surface.material])) return 1u;
  InteriorRef interiors = InteriorRef(pc.interiors);
  uint channel = interiors.items[slot].channel;
  if (channel == 0u) {
    channel = 1u + min(uint(3.0 * sample2d(key, kChannelPair).x), 2u);
    interiors.items[slot].channel = channel;
    kept = vec3(equal(uvec3(1u, 2u, 3u), uvec3(channel))) * 3.0;
  }
  return channel - 1u;
}

// Squared index of the medium a path enters, over that at the camera; its state follows.
float etaScaleBehind(const uint slot, const float eta) {
  InteriorRef interiors = InteriorRef(pc.interiors);
  float scale = interiors.items[slot].etaScale;
  if (eta != 1.0) {
    scale *= eta * eta;
    interiors.items[slot].etaScale = scale;
  }
  return scale;
}

// Continues the path by a BSDF sample; false where it ends.
bool continuePath(const SceneRef scene, const SurfaceHit surface, const SurfaceMaterial material, const BsdfAtWo at,
                  const Frame frame, const vec3 woLocal, const MediumCrossing crossing, const SampleKey key,
                  const uint pair, const uint slot, inout PathState path) {
  const vec2 choice = sample2d(key, pair + 3u);
  const BsdfSample bsdf = sampleDirection(scene, material.bsdf, at, woLocal, choice.x, sample2d(key, pair + 2u));
  if (!bsdf.valid) return false;
  const vec3 wi = toWorld(frame, bsdf.wiLocal);
  if (bsdf.wiLocal.z * dot(surface.ng, wi) <= 0.0) return false;
  path.beta *= bsdf.weight;
  path.depth += 1u;
  const float brightest = max(path.beta.x, max(path.beta.y, path.beta.z));
  if (!(brightest > 0.0)) return false;
  float power = brightest; // without the squared indices of radiance, which refraction back out will undo
  if (kHasTransmission) power *= etaScaleBehind(slot, bsdf.eta);
  if (!survivesRoulette(power, choice.y, path)) return false;
  path.pdfSolidAngle = bsdf.delta ? 0.0 : bsdf.pdfSolidAngle;
  followGlass(slot, isGlass(material.bsdf), bsdf);
  if (kHasVolumes) {
    MediaRef(pc.media).items[slot].travelled = 0.0;
    if (bsdf.wiLocal.z < 0.0) MediaRef(pc.media).items[slot].path = crossing.across;
  }
  handRay(slot, RayState(offsetRayOrigin(surface.p, surface.pError, surface.ng, wi), 0.0, wi, kRayInfinity));
  return true;
}

// Radiance that the surface itself sends towards wo, weighted against light sampling.
vec3 emissionAt(const SceneRef scene, const SurfaceHit surface, const RayState ray, const PathState path,
                const uint slot) {
  if (!kHasEmissiveTriangles) return vec3(0.0);
  const vec3 Le = emittedRadiance(scene, surface);
  if (all(equal(Le, vec3(0.0)))) return vec3(0.0);
  float pdfLight = 0.0;
  if (path.pdfSolidAngle > 0.0) {
    const vec3 from = lastScattering(slot, ray);
    pdfLight = emitterPdfSolidAngle(scene, surface, abs(dot(surface.ng, ray.direction)), distance(surface.p, from),
                                    receiverOf(slot, from));
  }
  return Le * foundWeight(slot, path.pdfSolidAngle, pdfLight);
}

// The media on the other side of the surface; where it bounds none, those on this side.
MediumCrossing crossSurface(const SceneRef scene, const SurfaceHit surface, const uint slot) {
  const MediumStack here = MediaRef(pc.media).items[slot].path;
  if (!isVolumeBoundary(scene, surface.material)) return noCrossing(scene, here);
  if (surface.frontFace && isFull(here)) countStatus(kStatusMediumOverflow);
  return crossBoundary(scene, here, surface.material, surface.frontFace);
}

// Index behind the surface over that in front: of a boundary those of the two media, else the material's own behind.
float etaAt(const SceneRef scene, const SurfaceHit surface, const MediumCrossing crossing, const uint channel) {
  const float ior = materialIor(MaterialRef(scene.view.materials).items[surface.material], channel);
  if (ior < 1.0) return ior;
  const bool boundary = isVolumeBoundary(scene, surface.material);
  if (boundary && refracts(scene, surface.material)) return etaAcross(scene, crossing, channel);
  const uint outside = boundary && !surface.frontFace ? crossing.beyond : crossing.before;
  return ior / mediumIor(scene, outside, channel);
}

// Sends the path straight on, where the surface is a boundary that does nothing.
bool passesInvisibly(const SceneRef scene, const SurfaceHit surface, const RayState ray, const MediumCrossing crossing,
                     const uint slot) {
  if (!isVolumeBoundary(scene, surface.material) || !isInvisible(scene, crossing, surface.material)) return false;
  MediaRef media = MediaRef(pc.media);
  const float hitDistance = media.items[slot].hitDistance;
  media.items[slot].path = crossing.across;
  media.items[slot].travelled += hitDistance;
  handRay(slot, RayState(offsetRayOrigin(surface.p, surface.pError, surface.ng, ray.direction), 0.0, ray.direction,
                         ray.tMax - hitDistance));
  return true;
}

/// Takes a path through the surface that its ray has met: the rays that leave it are handed over.
///
/// @return whether the path goes on
bool shadeSurface(const uint slot, inout PathState path) {
  SceneRef scene = SceneRef(pc.scene);
  RenderRef render = RenderRef(pc.render);
  const RayState ray = rayOf(slot);
  const HitState hit = hitOf(slot);
  const vec3 wo = -ray.direction;

  const SurfaceHit surface = surfaceAt(scene, hit.instance, hit.triangle, hit.barycentrics, wo);
  MediumCrossing crossing;
  if (kHasVolumes) {
    absorbAlongRay(scene, slot, path);
    crossing = crossSurface(scene, surface, slot);
    if (passesInvisibly(scene, surface, ray, crossing, slot)) return true;
  }
  const SampleKey key = SampleKey(path.pixel, path.sampleIndex, render.view.seed);
  vec3 kept;
  const uint channel = dispersedChannel(scene, surface, key, slot, kept);
  float eta = 1.0;
  if (kHasVolumes) {
    eta = etaAt(scene, surface, crossing, channel);
  } else if (kHasSpecular) {
    eta = etaInAir(scene, surface, channel);
  }
  SurfaceMaterial material = materialAt(scene, surface, eta, channel);
  const vec3 ns = shadingNormal(scene, surface, wo);
  if (path.depth == 0u) {
    path.hit = 1u;
    addAovs(render, path, material.baseColor, ns, surface.p);
  }
  bool alive = false;
  if (kHasUnlit && material.unlit) {
    path.radiance += path.beta * material.baseColor;
  } else {
    path.radiance += path.beta * emissionAt(scene, surface, ray, path, slot);
    alive = scattersHere(slot, path);
  }
  if (kHasDispersion) path.beta *= kept;
  if (alive) {
    const Frame frame = shadingFrame(scene, surface, ns);
    const vec3 woLocal = toLocal(frame, wo);
    if (kHasClearcoat) setClearcoatNormal(material, scene, surface, wo, frame);
    const BsdfAtWo at = bsdfAtWo(scene, material.bsdf, woLocal);
    const uint pair = kFirstVertexPair + kVertexPairs * path.depth;
    if (samplesLights()) {
      // Lights on the far side of what lets light through are sampled too.
      const LightReceiver receiver = LightReceiver(surface.p, transmits(material.bsdf) ? vec3(0.0) : ns);
      if (keepsReceivers()) ReceiverRef(pc.receivers).items[slot] = receiver;
      sampleDirectLight(scene, surface, material, at, frame, woLocal, crossing, receiver, key, pair, slot, path.beta);
    }
    alive = continuePath(scene, surface, material, at, frame, woLocal, crossing, key, pair, slot, path);
  }
  return alive;
}

#endif
