// Finished samples -> Film; their slots become free.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "film/fixed_point.glsl"
#include "kernels/wavefront.glsl"
#include "math/float_bits.glsl"
#include "sampling/hash.glsl"

void addSample(const PathState path) {
  RenderRef render = RenderRef(pc.render);
  const uvec2 cropPixel = uvec2(path.pixel & 0xffffu, path.pixel >> 16u) - render.view.cropOrigin;
  const uint pixel = cropPixel.y * render.view.cropSize.x + cropPixel.x;
  const uint index = pixel * kReplicateCount + path.sampleIndex % kReplicateCount;

  vec3 radiance = path.radiance;
  if (isNonFinite(radiance.x) || isNonFinite(radiance.y) || isNonFinite(radiance.z)) {
    countStatus(kStatusNonFinite);
    radiance = vec3(0.0);
  } else if (any(lessThan(radiance, vec3(0.0)))) {
    countStatus(kStatusNegative);
    radiance = vec3(0.0);
  }
  const vec3 scaled = radiance * render.view.radianceScale;
  if (any(greaterThan(scaled, vec3(kFixedPointLimit)))) countStatus(kStatusClipped);
  const uvec4 dither = pcg4d(uvec4(path.pixel, path.sampleIndex, render.view.seed));
  ReplicateRef sums = ReplicateRef(render.view.replicates);
  atomicAdd(sums.items[index].red, toFixedPoint(scaled.x, dither.x));
  atomicAdd(sums.items[index].green, toFixedPoint(scaled.y, dither.y));
  atomicAdd(sums.items[index].blue, toFixedPoint(scaled.z, dither.z));
  atomicAdd(sums.items[index].count, 1u);
  if (path.hit != 0u) atomicAdd(sums.items[index].hitCount, 1u);
}

void main() {
  uint slot;
  if (!takeSlot(kQueueFinished, itemIndex(), slot)) return;
  const PathState path = PathRef(pc.paths).items[slot];
  if (path.sampleIndex != kNoSample) addSample(path);
  pushSlot(kQueueFree, slot);
}
