// What a path receives on a ray that met no surface: from a sphere light, or from the suns and the environment.
#ifndef ISOPHOTE_KERNELS_SHADE_ESCAPED_GLSL
#define ISOPHOTE_KERNELS_SHADE_ESCAPED_GLSL

#include "film/aov.glsl"
#include "geometry/ray_sphere.glsl"
#include "kernels/absorption.glsl"
#include "kernels/handover.glsl"
#include "kernels/straight_shadow.glsl"
#include "kernels/wavefront.glsl"
#include "light/environment.glsl"
#include "light/light_sample.glsl"

// What the path receives from the sphere light that its ray has hit. To the camera it is a black surface that shines.
vec3 sphereLightEmission(const SceneRef scene, const RayState ray, const uint instance, const uint slot,
                         inout PathState path) {
  const uint light = InstanceRef(scene.view.instances).items[instance].firstEmitter;
  const PunctualLightRecord sphere =
      PunctualLightRef(scene.view.punctualLights).items[light - scene.view.emissiveTriangleCount];
  if (path.depth == 0u) {
    const SphereHit hit = intersectSphere(ray.origin, ray.direction, sphere.position, sphere.size, ray.tMin);
    const vec3 p = ray.origin + hit.t * ray.direction;
    const vec3 outward = (p - sphere.position) / sphere.size;
    const vec3 normal = dot(outward, ray.direction) > 0.0 ? -outward : outward;
    path.hit = 1u;
    addAovs(RenderRef(pc.render), path, vec3(0.0), normal, p);
  }
  const vec3 from = lastScattering(slot, ray);
  float pdfLight = 0.0;
  if (path.pdfSolidAngle > 0.0) {
    pdfLight = sphereLightHitPdf(scene, light, sphere, from, ray.direction, receiverOf(slot, from));
  }
  const vec3 Le = sphereLightRadiance(sphere, from, ray.direction);
  return path.beta * Le * foundWeight(slot, path.pdfSolidAngle, pdfLight);
}

vec3 sunEmission(const SceneRef scene, const vec3 direction, const uint slot, const PathState path) {
  vec3 sum = vec3(0.0);
  for (uint i = 0u; i < scene.view.sunCount; ++i) {
    const PunctualLightRecord sun = PunctualLightRef(scene.view.punctualLights).items[i];
    if (!meetsSun(sun, direction)) continue;
    const float pdfLight = path.pdfSolidAngle > 0.0 ? sunHitPdf(scene, i, sun) : 0.0;
    sum += path.beta * sun.intensity * foundWeight(slot, path.pdfSolidAngle, pdfLight);
  }
  return sum;
}

vec3 environmentEmission(const SceneRef scene, const vec3 direction, const uint slot, const PathState path) {
  if (scene.view.environment.width == 0u) return vec3(0.0); // absent under an all-features kernel
  const float pdfLight = path.pdfSolidAngle > 0.0 ? environmentHitPdf(scene, direction) : 0.0;
  return path.beta * environmentRadiance(scene, direction) * foundWeight(slot, path.pdfSolidAngle, pdfLight);
}

/// Adds to a path what it receives from where its ray has gone.
void shadeEscaped(const uint slot, inout PathState path) {
  SceneRef scene = SceneRef(pc.scene);
  const RayState ray = rayOf(slot);
  const uint instance = kHasSphereLights ? hitOf(slot).instance : kInvalidIndex;
  vec3 received = vec3(0.0);
  if (kHasSphereLights && instance != kInvalidIndex) {
    if (kHasVolumes) absorbAlongRay(scene, slot, path);
    received = sphereLightEmission(scene, ray, instance, slot, path);
  } else {
    if (kHasSuns) received += sunEmission(scene, ray.direction, slot, path);
    if (kHasEnvironment) received += environmentEmission(scene, ray.direction, slot, path);
  }
  path.radiance += received;
}

#endif
