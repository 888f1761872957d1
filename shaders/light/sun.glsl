// Disks at infinity: directional lights with an angular radius. PunctualLightRecord.size is 1 - cos of it.
#ifndef ISOPHOTE_LIGHT_SUN_GLSL
#define ISOPHOTE_LIGHT_SUN_GLSL

#include "light/punctual.glsl"
#include "math/frame.glsl"
#include "sampling/warp.glsl"
#include "shared/constants.glsl"

bool isSun(const PunctualLightRecord light) { return kHasSuns && light.kind == kLightDirectional && light.size > 0.0; }

/// Whether a ray that leaves the scene meets the disk. The squared chord is 2 (1 - cos), without its cancellation.
///
/// @param direction  unit, away from the receiver
bool meetsSun(const PunctualLightRecord sun, vec3 direction) {
  const vec3 chord = direction + sun.direction;
  return dot(chord, chord) <= 2.0 * sun.size;
}

/// Samples the disk's directions uniformly; the density is pdfUniformCone(sun.size).
vec3 sampleSun(const PunctualLightRecord sun, vec2 u) {
  return toWorld(frameFromNormal(-sun.direction), sampleUniformCone(u, sun.size));
}

#endif
