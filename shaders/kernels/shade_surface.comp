// A path at a surface: emission with MIS, one light sample to the shadow queue, one BSDF sample to the ray queue,
// Russian roulette.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "kernels/shade_surface.glsl"

void main() {
  uint slot;
  if (!takeSlot(kQueueSurface, itemIndex(), slot)) return;
  RayState ray = RayRef(pc.rays).items[slot];
  PathState path = PathRef(pc.paths).items[slot];
  ShadowState shadow = noShadowRay();
  const bool alive = shadeSurface(slot, HitRef(pc.hits).items[slot], ray, path, shadow);
  PathRef(pc.paths).items[slot] = path;
  queueShadowRay(slot, shadow);
  if (alive) {
    RayRef(pc.rays).items[slot] = ray;
    pushSlot(kQueueRay, slot);
  } else {
    pushSlot(kQueueFinished, slot);
  }
}
