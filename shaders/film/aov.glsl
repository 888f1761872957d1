// Auxiliary layers of the first hit.
#ifndef ISOPHOTE_FILM_AOV_GLSL
#define ISOPHOTE_FILM_AOV_GLSL

#include "film/fixed_point.glsl"
#include "kernels/wavefront.glsl"
#include "sampling/hash.glsl"

// Adds the first hit of a sample to its pixel's layers; later samples than kAovSampleCount leave them as they are.
void addAovs(const RenderRef render, const PathState path, const vec3 albedo, const vec3 normal, const vec3 p) {
  if (render.view.aovs == 0ul || path.sampleIndex >= kAovSampleCount) return;
  const uvec2 cropPixel = uvec2(path.pixel & 0xffffu, path.pixel >> 16u) - render.view.cropOrigin;
  const uint pixel = cropPixel.y * render.view.cropSize.x + cropPixel.x;
  AovRef aovs = AovRef(render.view.aovs);
  const uint dither = pcg4d(uvec4(path.pixel, path.sampleIndex, render.view.seed)).w;
  const float unit = float(1ul << kRadianceFractionBits);
  for (uint c = 0u; c < 3u; ++c) {
    atomicAdd(aovs.items[pixel].albedo[c], toFixedPoint(albedo[c] * unit, dither));
    atomicAdd(aovs.items[pixel].normal[c], toFixedPoint(normal[c] * unit, dither));
    atomicAdd(aovs.items[pixel].position[c], toFixedPoint(p[c] * render.view.distanceScale, dither));
  }
  const vec3 fromCamera = p - render.view.camera.position;
  const bool panorama = kHasPanorama && render.view.camera.kind == kCameraPanorama;
  const float depth = panorama ? length(fromCamera) : dot(fromCamera, render.view.camera.forward);
  atomicAdd(aovs.items[pixel].depth, toFixedPoint(depth * render.view.distanceScale, dither));
  atomicAdd(aovs.items[pixel].count, 1u);
}

#endif
