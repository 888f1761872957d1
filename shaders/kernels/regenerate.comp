// Free path slots take their next (pixel, sample) and a camera ray.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "kernels/regenerate.glsl"

void main() {
  WaveRef wave = WaveRef(pc.wave);
  const uint item = itemIndex();
  if (item >= wave.state.regenerateCount) return;
  const uint slot = queueSlots(kQueueFree).slots[wave.state.counts[kQueueFree] + item];
  PathState path;
  if (!startPath(slot, item, path)) {
    // The freed slot waits in the finished queue, because the free queue is being read.
    PathRef(pc.paths).items[slot].sampleIndex = kNoSample;
    pushSlot(kQueueFinished, slot);
    return;
  }
  PathRef(pc.paths).items[slot] = path;
  pushSlot(kQueueRay, slot);
}
