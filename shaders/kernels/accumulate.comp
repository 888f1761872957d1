// Finished samples -> Film; their slots become free.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "kernels/accumulate.glsl"

void main() {
  uint slot;
  if (!takeSlot(kQueueFinished, itemIndex(), slot)) return;
  const PathState path = PathRef(pc.paths).items[slot];
  if (path.sampleIndex != kNoSample) addSample(slot, path);
  pushSlot(kQueueFree, slot);
}
