// RayQueue -> surface queue | medium queue | escaped queue: rays that met a sphere light or nothing (straight to
// finished where nothing shines from outside).
#version 460
#extension GL_GOOGLE_include_directive : require

#include "kernels/intersect_closest.glsl"

void main() {
  uint slot;
  if (!takeSlot(kQueueRay, itemIndex(), slot)) return;
  HitState hit;
  const uint next = intersectPath(slot, RayRef(pc.rays).items[slot], PathRef(pc.paths).items[slot], hit);
  // Whether an escaped ray met a sphere light is asked of its hit.
  if (kHasSphereLights || hit.instance != kInvalidIndex) HitRef(pc.hits).items[slot] = hit;
  if (next == kQueueMedium) {
    pushSlot(kQueueMedium, slot);
  } else if (next == kQueueEscaped) {
    pushSlot(kQueueEscaped, slot);
  } else if (next == kQueueSurface) {
    pushSlot(kQueueSurface, slot);
  } else {
    pushSlot(kQueueFinished, slot);
  }
}
