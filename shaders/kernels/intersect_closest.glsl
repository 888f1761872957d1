// What a path's ray meets, and which stage that is for.
#ifndef ISOPHOTE_KERNELS_INTERSECT_CLOSEST_GLSL
#define ISOPHOTE_KERNELS_INTERSECT_CLOSEST_GLSL

#include "geometry/traverse.glsl"
#include "kernels/wavefront.glsl"
#include "medium/medium_stack.glsl"

bool isInScatteringMedium(const uint slot) {
  SceneRef scene = SceneRef(pc.scene);
  return scatters(mediumOf(scene, currentMedium(scene, MediaRef(pc.media).items[slot].path)));
}

/// Finds the nearest surface or sphere light on the ray.
///
/// @param path  which one it is and how deep, for decisions about alpha
/// @param hit   of the instance kInvalidIndex where there is none
/// @return the queue of the path's next stage: surface, medium, escaped (a sphere light, or what shines from outside),
///         or finished where nothing does
uint intersectPath(const uint slot, const RayState ray, const PathState path, out HitState hit) {
  AlphaKey key = AlphaKey(0u, 0u, uvec2(0u), 0u);
  if (kHasAlpha) key = AlphaKey(path.pixel, path.sampleIndex, RenderRef(pc.render).view.seed, path.depth);
  const RayHit found =
      traceClosest(SceneRef(pc.scene), ray.origin, ray.direction, ray.tMin, ray.tMax, key, kInvalidIndex);
  if (found.stackOverflow) countStatus(kStatusStackOverflow);
  hit = HitState(found.found ? found.instance : kInvalidIndex, found.triangle, found.barycentrics);
  if (!found.found) return kHasEnvironment || kHasSuns ? kQueueEscaped : kQueueFinished;
  if (kHasVolumes) MediaRef(pc.media).items[slot].hitDistance = found.t;
  if (kHasScatteringMedia && isInScatteringMedium(slot)) return kQueueMedium;
  return kHasSphereLights && found.triangle == kInvalidIndex ? kQueueEscaped : kQueueSurface;
}

#endif
