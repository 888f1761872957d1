// Visibility of the light samples; what they contribute is already known.
#ifndef ISOPHOTE_KERNELS_INTERSECT_SHADOW_GLSL
#define ISOPHOTE_KERNELS_INTERSECT_SHADOW_GLSL

#include "geometry/surface.glsl"
#include "geometry/traverse.glsl"
#include "kernels/straight_shadow.glsl"
#include "kernels/wavefront.glsl"
#include "medium/medium_stack.glsl"

// Boundaries that one shadow ray may pass; behind more it counts as blocked.
const uint kMostBoundaries = 4096u;

// What media and, where shadow rays cross it, glass leave of the light; 0 where anything else that can be seen lies
// between. Boundaries that do nothing are passed. A ray that meets nothing any more has left every closed mesh, so that
// nothing absorbs on its last part.
vec3 shadowTransmittance(const SceneRef scene, const ShadowState shadow, const uint slot, const AlphaKey key,
                         inout bool stackOverflow) {
  vec3 left = vec3(1.0);
  vec3 origin = shadow.origin;
  vec3 direction = shadow.direction;
  const vec3 target = shadow.origin + shadow.direction; // of bounded rays, whose t runs to almost 1
  const bool bounded = shadow.tMax < kRayInfinity;
  MediumStack stack = noMedia();
  if (kHasVolumes) stack = MediaRef(pc.media).items[slot].shadow;
  bool behindGlass = false;
  for (uint i = 0u; i < kMostBoundaries; ++i) {
    const RayHit hit = traceClosest(scene, origin, direction, 0.0, shadow.tMax, key, shadow.target);
    stackOverflow = stackOverflow || hit.stackOverflow;
    vec3 extinction = vec3(0.0);
    if (kHasVolumes) extinction = mediumOf(scene, currentMedium(scene, stack)).extinction;
    if (!hit.found) return bounded ? left * transmittance(extinction, length(direction)) : left;
    if (kHasSphereLights && hit.triangle == kInvalidIndex) return vec3(0.0);
    const SurfaceHit surface = surfaceAt(scene, hit.instance, hit.triangle, hit.barycentrics, -direction);
    const bool boundary = kHasVolumes && isVolumeBoundary(scene, surface.material);
    MediumCrossing crossing;
    if (boundary) {
      crossing = crossBoundary(scene, stack, surface.material, surface.frontFace);
    } else {
      crossing = noCrossing(scene, stack);
    }
    if (!boundary || !isInvisible(scene, crossing, surface.material)) {
      if (!kStraightShadows) return vec3(0.0);
      const float weight = StraightRef(pc.straight).items[slot].lightWeight;
      if (weight == 0.0) return vec3(0.0);
      left *= straightTransmittance(scene, surface, crossing, -normalize(direction));
      if (all(equal(left, vec3(0.0)))) return vec3(0.0);
      if (!behindGlass) left /= weight;
      behindGlass = true;
    }
    left *= transmittance(extinction, hit.t * length(direction));
    stack = crossing.across;
    origin = offsetRayOrigin(surface.p, surface.pError, surface.ng, direction);
    if (bounded) direction = target - origin;
  }
  return vec3(0.0);
}

/// What arrives of a shadow ray's contribution.
///
/// @param path  which one it is and how deep, for decisions about alpha
vec3 arrivingLight(const uint slot, const ShadowState shadow, const PathState path) {
  AlphaKey key = AlphaKey(0u, 0u, uvec2(0u), 0u);
  if (kHasAlpha) {
    // The high bit keeps a shadow ray's decisions independent of those of the ray that continues the path.
    key = AlphaKey(path.pixel, path.sampleIndex, RenderRef(pc.render).view.seed, path.depth | 0x80000000u);
  }
  vec3 arriving = vec3(0.0);
  bool stackOverflow = false;
  if (kHasVolumes || kStraightShadows) {
    arriving = shadow.contribution * shadowTransmittance(SceneRef(pc.scene), shadow, slot, key, stackOverflow);
  } else if (!traceOccluded(SceneRef(pc.scene), shadow.origin, shadow.direction, 0.0, shadow.tMax, key, shadow.target,
                            stackOverflow)) {
    arriving = shadow.contribution;
  }
  if (stackOverflow) countStatus(kStatusStackOverflow);
  return arriving;
}

#endif
