// Rays that left the scene see the environment.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "kernels/mis.glsl"
#include "kernels/wavefront.glsl"
#include "light/environment.glsl"
#include "light/light_sample.glsl"

void main() {
  uint slot;
  if (!takeSlot(kQueueEscaped, itemIndex(), slot)) return;
  SceneRef scene = SceneRef(pc.scene);
  PathRef paths = PathRef(pc.paths);
  const vec3 direction = RayRef(pc.rays).items[slot].direction;
  const float pdfBsdf = paths.items[slot].pdfSolidAngle;
  const float pdfLight = pdfBsdf > 0.0 ? environmentHitPdf(scene, direction) : 0.0;
  if (scene.view.environment.width != 0u) { // absent under an all-features kernel
    const vec3 Le = environmentRadiance(scene, direction);
    paths.items[slot].radiance += paths.items[slot].beta * Le * emissionWeight(pdfBsdf, pdfLight);
  }
  pushSlot(kQueueFinished, slot);
}
