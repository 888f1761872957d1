// Visibility of the light samples; what they contribute is already known.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "kernels/intersect_shadow.glsl"

void main() {
  uint slot;
  if (!takeSlot(kQueueShadow, itemIndex(), slot)) return;
  PathRef paths = PathRef(pc.paths);
  const vec3 arriving = arrivingLight(slot, ShadowRef(pc.shadows).items[slot], paths.items[slot]);
  if (any(notEqual(arriving, vec3(0.0)))) paths.items[slot].radiance += arriving;
}
