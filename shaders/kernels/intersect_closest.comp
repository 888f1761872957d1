// RayQueue -> surface queue | medium queue | escaped queue: rays that met a sphere light or nothing (straight to
// finished where nothing shines from outside).
#version 460
#extension GL_GOOGLE_include_directive : require

#include "geometry/traverse.glsl"
#include "kernels/wavefront.glsl"
#include "medium/medium_stack.glsl"

bool isInScatteringMedium(const uint slot) {
  SceneRef scene = SceneRef(pc.scene);
  return scatters(mediumOf(scene, currentMedium(scene, MediaRef(pc.media).items[slot].path)));
}

void main() {
  uint slot;
  if (!takeSlot(kQueueRay, itemIndex(), slot)) return;
  const RayState ray = RayRef(pc.rays).items[slot];
  PathRef paths = PathRef(pc.paths);
  AlphaKey key = AlphaKey(0u, 0u, uvec2(0u), 0u);
  if (kHasAlpha) {
    key = AlphaKey(paths.items[slot].pixel, paths.items[slot].sampleIndex, RenderRef(pc.render).view.seed,
                   paths.items[slot].depth);
  }
  const RayHit hit =
      traceClosest(SceneRef(pc.scene), ray.origin, ray.direction, ray.tMin, ray.tMax, key, kInvalidIndex);
  if (hit.stackOverflow) countStatus(kStatusStackOverflow);
  if (hit.found) {
    HitRef(pc.hits).items[slot] = HitState(hit.instance, hit.triangle, hit.barycentrics);
    if (kHasVolumes) MediaRef(pc.media).items[slot].hitDistance = hit.t;
    if (kHasScatteringMedia && isInScatteringMedium(slot)) {
      pushSlot(kQueueMedium, slot);
    } else if (kHasSphereLights && hit.triangle == kInvalidIndex) {
      pushSlot(kQueueEscaped, slot);
    } else {
      pushSlot(kQueueSurface, slot);
    }
  } else if (kHasEnvironment || kHasSuns) {
    if (kHasSphereLights) HitRef(pc.hits).items[slot].instance = kInvalidIndex;
    pushSlot(kQueueEscaped, slot);
  } else {
    pushSlot(kQueueFinished, slot);
  }
}
