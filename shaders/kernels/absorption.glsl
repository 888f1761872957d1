// Absorption between the vertices of a path.
#ifndef ISOPHOTE_KERNELS_ABSORPTION_GLSL
#define ISOPHOTE_KERNELS_ABSORPTION_GLSL

#include "kernels/wavefront.glsl"
#include "medium/medium_stack.glsl"

/// What the medium between the ray's origin and what it hit leaves of the throughput; sampling did that already where
/// it scatters.
void absorbAlongRay(const SceneRef scene, const uint slot, inout PathState path) {
  MediaRef media = MediaRef(pc.media);
  const uint material = currentMedium(scene, media.items[slot].path);
  if (material == kInvalidIndex) return;
  const Medium medium = mediumOf(scene, material);
  if (!scatters(medium)) path.beta *= transmittance(medium.extinction, media.items[slot].hitDistance);
}

#endif
