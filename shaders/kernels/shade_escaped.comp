// Rays that met no surface see what lies there: a sphere light, or the suns and the environment.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "kernels/shade_escaped.glsl"

void main() {
  uint slot;
  if (!takeSlot(kQueueEscaped, itemIndex(), slot)) return;
  PathRef paths = PathRef(pc.paths);
  PathState path = paths.items[slot];
  shadeEscaped(slot, path);
  paths.items[slot].radiance = path.radiance;
  if (kHasSphereLights) paths.items[slot].hit = path.hit;
  pushSlot(kQueueFinished, slot);
}
