// What a path's ray meets, and which stage that is for.
#ifndef ISOPHOTE_KERNELS_INTERSECT_CLOSEST_GLSL
#define ISOPHOTE_KERNELS_INTERSECT_CLOSEST_GLSL

#include "geometry/traverse.glsl"
#include "kernels/handover.glsl"
#include "kernels/wavefront.glsl"
#include "medium/medium_stack.glsl"

bool isInScatteringMedium(const uint slot) {
  SceneRef scene = SceneRef(pc.scene);
  return scatters(mediumOf(scene, currentMedium(scene, MediaRef(pc.media).items[slot].path)));
}

// Whether rays may end elsewhere than on a surface, and see something there.
bool shinesBeyondSurfaces() { return kHasEnvironment || kHasSuns || kHasSphereLights; }

/// Finds the nearest surface or sphere light on the path's ray; the hit is handed over.
///
/// @param path  which one it is and how deep, for decisions about alpha
/// @return the queue of the path's next stage: surface, medium, escaped (a sphere light, or what shines from outside),
///         or finished where nothing does
uint intersectPath(const uint slot, const PathState path) {
  const RayState ray = rayOf(slot);
  AlphaKey key = AlphaKey(0u, 0u, uvec2(0u), 0u);
  if (kHasAlpha) key = AlphaKey(path.pixel, path.sampleIndex, RenderRef(pc.render).view.seed, path.depth);
  const RayHit hit =
      traceClosest(SceneRef(pc.scene), ray.origin, ray.direction, ray.tMin, ray.tMax, key, kInvalidIndex);
  if (hit.stackOverflow) countStatus(kStatusStackOverflow);
  if (hit.found) {
    handHit(slot, HitState(hit.instance, hit.triangle, hit.barycentrics));
    if (kHasVolumes) MediaRef(pc.media).items[slot].hitDistance = hit.t;
    if (kHasScatteringMedia && isInScatteringMedium(slot)) return kQueueMedium;
    return kHasSphereLights && hit.triangle == kInvalidIndex ? kQueueEscaped : kQueueSurface;
  }
  // Whether an escaped ray met a sphere light is asked of its hit.
  if (kHasSphereLights) handHit(slot, HitState(kInvalidIndex, kInvalidIndex, vec2(0.0)));
  return kHasEnvironment || kHasSuns ? kQueueEscaped : kQueueFinished;
}

#endif
