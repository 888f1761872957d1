// A path at a surface: emission with MIS, one light sample to the shadow queue, one BSDF sample to the ray queue,
// Russian roulette.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "bsdf/material.glsl"
#include "bsdf/surface_bsdf.glsl"
#include "film/aov.glsl"
#include "geometry/ray_offset.glsl"
#include "geometry/surface.glsl"
#include "kernels/mis.glsl"
#include "kernels/wavefront.glsl"
#include "light/emission.glsl"
#include "light/light_sample.glsl"
#include "math/frame.glsl"
#include "sampling/sampler.glsl"

// Pairs of random numbers of path vertex d start at kFirstVertexPair + kVertexPairs * d.
const uint kFirstVertexPair = 2u;
const uint kVertexPairs = 4u;

// Roulette starts at this depth, and never lets a path live with more than this probability: a lossless closed scene
// ends. At reflectance rho the weights of long paths have finite variance only where rho^2 is below this limit, so it
// must be close to 1: with 0.95 a closed room of reflectance 0.98 would never converge.
const uint kRouletteDepth = 3u;
const float kRouletteMaxSurvival = 0.999;

// Shadow rays end this share of the way to the light: a light in a coordinate plane has no error to be offset by, and t
// is rounded. 16 roundings; measured: without it such a light shadowed a third of its own samples.
const float kBeforeLight = 1.0 - 9.5367431640625e-7;

const bool kHasLights = kHasEmissiveTriangles || kHasPunctualLights || kHasEnvironment;

// Whether the probability of a light depends on where it was chosen for, and a ray may find lights.
bool keepsReceivers() { return kHasLightTree && kHasEmissiveTriangles && pc.receivers != 0ul; }

// A light's contribution at the surface, put up for the visibility test.
void sampleDirectLight(const SceneRef scene, const SurfaceHit surface, const SurfaceMaterial material,
                       const Frame frame, const vec3 woLocal, const LightReceiver receiver, const SampleKey key,
                       const uint pair, const uint slot, const vec3 beta) {
  const LightSample light = sampleLight(scene, receiver, sampleBits2d(key, pair + 1u), sample2d(key, pair));
  if (!light.valid || (kLightSampling == 2u && !light.delta)) return;
  const vec3 wiLocal = toLocal(frame, light.wi);
  // Both normals must agree on the side.
  if (wiLocal.z * dot(surface.ng, light.wi) <= 0.0 || (!kHasTransmission && wiLocal.z < 0.0)) return;
  const BsdfValue bsdf = evaluateBsdf(scene, material.bsdf, woLocal, wiLocal);
  float weight = 1.0;
  if (kLightSampling == 0u && !light.delta) weight = misWeight(light.pdfSolidAngle, bsdf.pdfSolidAngle);
  const vec3 contribution = beta * bsdf.fCos * light.radiance * (weight / light.pdfSolidAngle);
  if (all(equal(contribution, vec3(0.0)))) return;

  // Direction and length are taken between the offset points: at grazing angles the surface point's own would pass
  // below the light.
  const vec3 origin = offsetRayOrigin(surface.p, surface.pError, surface.ng, light.wi);
  vec3 direction = light.wi;
  float tMax = kRayInfinity;
  if (!light.atInfinity) {
    const vec3 target =
        light.delta ? light.point : offsetRayOrigin(light.point, light.pointError, light.ngLight, -light.wi);
    direction = target - origin; // not normalised: t runs from 0 to 1
    tMax = kBeforeLight;
  }
  ShadowRef(pc.shadows).items[slot] = ShadowState(origin, tMax, direction, 0.0, contribution);
  pushSlot(kQueueShadow, slot);
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
bool continuePath(const SceneRef scene, const SurfaceHit surface, const SurfaceMaterial material, const Frame frame,
                  const vec3 woLocal, const SampleKey key, const uint pair, const uint slot, inout PathState path) {
  const vec2 choice = sample2d(key, pair + 3u);
  const BsdfSample bsdf = sampleBsdf(scene, material.bsdf, woLocal, choice.x, sample2d(key, pair + 2u));
  if (!bsdf.valid) return false;
  const vec3 wi = toWorld(frame, bsdf.wiLocal);
  if (bsdf.wiLocal.z * dot(surface.ng, wi) <= 0.0) return false;
  path.beta *= bsdf.weight;
  path.depth += 1u;
  float brightest = max(path.beta.x, max(path.beta.y, path.beta.z));
  float power = brightest; // without the squared indices of radiance, which refraction back out will undo
  if (kHasTransmission) power *= etaScaleBehind(slot, bsdf.eta);
  if (kRussianRoulette == 1u && path.depth >= kRouletteDepth) {
    const float survival = min(power, kRouletteMaxSurvival);
    if (choice.y >= survival) return false;
    path.beta /= survival;
    brightest /= survival;
  }
  if (!(brightest > 0.0)) return false;
  path.pdfSolidAngle = bsdf.delta ? 0.0 : bsdf.pdfSolidAngle;
  RayRef(pc.rays).items[slot] =
      RayState(offsetRayOrigin(surface.p, surface.pError, surface.ng, wi), 0.0, wi, kRayInfinity);
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
    LightReceiver receiver = LightReceiver(ray.origin, vec3(0.0));
    if (keepsReceivers()) receiver = ReceiverRef(pc.receivers).items[slot];
    pdfLight = emitterPdfSolidAngle(scene, surface, abs(dot(surface.ng, ray.direction)),
                                    distance(surface.p, ray.origin), receiver);
  }
  return Le * emissionWeight(path.pdfSolidAngle, pdfLight);
}

void main() {
  uint slot;
  if (!takeSlot(kQueueSurface, itemIndex(), slot)) return;
  SceneRef scene = SceneRef(pc.scene);
  RenderRef render = RenderRef(pc.render);
  const RayState ray = RayRef(pc.rays).items[slot];
  const HitState hit = HitRef(pc.hits).items[slot];
  PathState path = PathRef(pc.paths).items[slot];
  const vec3 wo = -ray.direction;

  const SurfaceHit surface = surfaceAt(scene, hit.instance, hit.triangle, hit.barycentrics, wo);
  const SurfaceMaterial material = materialAt(scene, surface);
  const vec3 ns = shadingNormal(scene, surface, wo);
  if (path.depth == 0u) {
    path.hit = 1u;
    addAovs(render, path, material.baseColor, ns, surface.p);
  }
  bool alive = path.depth < render.view.maxDepth;
  if (kHasUnlit && material.unlit) {
    path.radiance += path.beta * material.baseColor;
    alive = false;
  } else {
    path.radiance += path.beta * emissionAt(scene, surface, ray, path, slot);
  }
  if (alive) {
    const Frame frame = frameFromNormal(ns);
    const vec3 woLocal = toLocal(frame, wo);
    const SampleKey key = SampleKey(path.pixel, path.sampleIndex, render.view.seed);
    const uint pair = kFirstVertexPair + kVertexPairs * path.depth;
    if (kHasLights && (kLightSampling != 2u || kHasPunctualLights)) {
      // Lights on the far side of glass are sampled too.
      const LightReceiver receiver = LightReceiver(surface.p, transmits(material.bsdf) ? vec3(0.0) : ns);
      if (keepsReceivers()) ReceiverRef(pc.receivers).items[slot] = receiver;
      sampleDirectLight(scene, surface, material, frame, woLocal, receiver, key, pair, slot, path.beta);
    }
    alive = continuePath(scene, surface, material, frame, woLocal, key, pair, slot, path);
  }
  PathRef(pc.paths).items[slot] = path;
  if (alive) {
    pushSlot(kQueueRay, slot);
  } else {
    pushSlot(kQueueFinished, slot);
  }
}
