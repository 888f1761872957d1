// Light samples on their way to the visibility test.
#ifndef ISOPHOTE_KERNELS_SHADOW_RAY_GLSL
#define ISOPHOTE_KERNELS_SHADOW_RAY_GLSL

#include "geometry/ray_offset.glsl"
#include "kernels/handover.glsl"
#include "light/light_sample.glsl"

// Shadow rays end this share of the way to the light: a light in a coordinate plane has no error to be offset by, and t
// is rounded. 16 roundings; measured: without it such a light shadowed a third of its own samples.
const float kBeforeLight = 1.0 - 9.5367431640625e-7;

/// Sends the ray from `origin` to a light sample on its way.
///
/// @param origin        off the surface that it leaves
/// @param contribution  complete, but for what is between the two
void sendShadowRay(const uint slot, const vec3 origin, const LightSample light, const vec3 contribution) {
  // Direction and length are taken between the offset points: at grazing angles the surface point's own would pass
  // below the light.
  vec3 direction = light.wi;
  float tMax = kRayInfinity;
  if (!light.atInfinity) {
    const vec3 target =
        light.delta ? light.point : offsetRayOrigin(light.point, light.pointError, light.ngLight, -light.wi);
    direction = target - origin; // not normalised: t runs from 0 to 1
    tMax = kBeforeLight;
  }
  handShadowRay(slot, ShadowState(origin, tMax, direction, light.target, contribution));
}

#endif
