// Light samples on their way to the visibility test.
#ifndef ISOPHOTE_KERNELS_SHADOW_RAY_GLSL
#define ISOPHOTE_KERNELS_SHADOW_RAY_GLSL

#include "geometry/ray_offset.glsl"
#include "kernels/vertex.glsl"
#include "kernels/wavefront.glsl"
#include "light/light_sample.glsl"

// Shadow rays end this share of the way to the light: a light in a coordinate plane has no error to be offset by, and t
// is rounded. 16 roundings; measured: without it such a light shadowed a third of its own samples.
const float kBeforeLight = 1.0 - 9.5367431640625e-7;

ShadowState noShadowRay() { return ShadowState(vec3(0.0), 0.0, vec3(0.0), kInvalidIndex, vec3(0.0)); }

/// Whether there is one: it carries something.
bool isSent(const ShadowState shadow) { return any(notEqual(shadow.contribution, vec3(0.0))); }

/// The ray from `origin` to a light sample.
///
/// @param origin        off the surface that it leaves
/// @param contribution  complete, but for what is between the two
ShadowState shadowRay(const vec3 origin, const LightSample light, const vec3 contribution) {
  // Direction and length are taken between the offset points: at grazing angles the surface point's own would pass
  // below the light.
  if (light.atInfinity) return ShadowState(origin, kRayInfinity, light.wi, light.target, contribution);
  const vec3 target =
      light.delta ? light.point : offsetRayOrigin(light.point, light.pointError, light.ngLight, -light.wi);
  // Not normalised: t runs from 0 to 1.
  return ShadowState(origin, kBeforeLight, target - origin, light.target, contribution);
}

/// Puts a vertex's shadow ray, if there is one, up for the visibility test.
void queueShadowRay(const uint slot, const ShadowState shadow) {
  if (!kSamplesLights || !isSent(shadow)) return;
  ShadowRef(pc.shadows).items[slot] = shadow;
  pushSlot(kQueueShadow, slot);
}

#endif
