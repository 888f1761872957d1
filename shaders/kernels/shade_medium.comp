// A path's ray inside a scattering medium: it scatters on its way (a light sample to the shadow queue, a new direction
// to the ray queue), or reaches the surface it would hit.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "kernels/shade_medium.glsl"

void main() {
  uint slot;
  if (!takeSlot(kQueueMedium, itemIndex(), slot)) return;
  PathState path = PathRef(pc.paths).items[slot];
  const uint next = shadeMedium(slot, path);
  PathRef(pc.paths).items[slot] = path;
  if (next == kQueueRay) {
    pushSlot(kQueueRay, slot);
  } else if (kHasSphereLights && next == kQueueEscaped) {
    pushSlot(kQueueEscaped, slot);
  } else if (next == kQueueSurface) {
    pushSlot(kQueueSurface, slot);
  } else {
    pushSlot(kQueueFinished, slot);
  }
}
