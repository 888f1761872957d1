// Visibility of the light samples; what they contribute is already known.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "geometry/traverse.glsl"
#include "kernels/wavefront.glsl"

void main() {
  uint slot;
  if (!takeSlot(kQueueShadow, itemIndex(), slot)) return;
  const ShadowState shadow = ShadowRef(pc.shadows).items[slot];
  PathRef paths = PathRef(pc.paths);
  AlphaKey key = AlphaKey(0u, 0u, uvec2(0u), 0u);
  if (kHasAlpha) {
    // The high bit keeps a shadow ray's decisions independent of those of the ray that continues the path.
    key = AlphaKey(paths.items[slot].pixel, paths.items[slot].sampleIndex, RenderRef(pc.render).view.seed,
                   paths.items[slot].depth | 0x80000000u);
  }
  bool stackOverflow;
  if (!traceOccluded(SceneRef(pc.scene), shadow.origin, shadow.direction, 0.0, shadow.tMax, key, shadow.target,
                     stackOverflow)) {
    paths.items[slot].radiance += shadow.contribution;
  }
  if (stackOverflow) countStatus(kStatusStackOverflow);
}
