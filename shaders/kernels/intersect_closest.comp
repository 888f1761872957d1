// RayQueue -> surface queue | medium queue | escaped queue: rays that met a sphere light or nothing (straight to
// finished where nothing shines from outside).
#version 460
#extension GL_GOOGLE_include_directive : require

#include "kernels/intersect_closest.glsl"

void main() {
  uint slot;
  if (!takeSlot(kQueueRay, itemIndex(), slot)) return;
  const uint next = intersectPath(slot, PathRef(pc.paths).items[slot]);
  if (kHasScatteringMedia && next == kQueueMedium) {
    pushSlot(kQueueMedium, slot);
  } else if (shinesBeyondSurfaces() && next == kQueueEscaped) {
    pushSlot(kQueueEscaped, slot);
  } else if (next == kQueueSurface) {
    pushSlot(kQueueSurface, slot);
  } else {
    pushSlot(kQueueFinished, slot);
  }
}
