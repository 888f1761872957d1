// A path at a surface: emission with MIS, one light sample to the shadow queue, one BSDF sample to the ray queue,
// Russian roulette.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "kernels/shade_surface.glsl"

void main() {
  uint slot;
  if (!takeSlot(kQueueSurface, itemIndex(), slot)) return;
  PathState path = PathRef(pc.paths).items[slot];
  const bool alive = shadeSurface(slot, path);
  PathRef(pc.paths).items[slot] = path;
  if (alive) {
    pushSlot(kQueueRay, slot);
  } else {
    pushSlot(kQueueFinished, slot);
  }
}
