// Finished samples -> Film; their slots become free.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "film/fixed_point.glsl"
#include "kernels/wavefront.glsl"
#include "math/float_bits.glsl"
#include "sampling/hash.glsl"

// Scales a sample brighter than the limit down to it, and keeps account of what that takes away.
vec3 clampSample(const RenderRef render, const uint pixel, const vec3 radiance, const uvec4 dither) {
  const float brightest = max(radiance.x, max(radiance.y, radiance.z));
  if (brightest <= render.view.sampleLimit) return radiance;
  const vec3 kept = radiance * (render.view.sampleLimit / brightest);
  if (render.view.clamped != 0ul) {
    const vec3 removed = (radiance - kept) * render.view.radianceScale;
    ClampedRef clamped = ClampedRef(render.view.clamped);
    atomicAdd(clamped.items[pixel].red, toFixedPoint(removed.x, dither.x));
    atomicAdd(clamped.items[pixel].green, toFixedPoint(removed.y, dither.y));
    atomicAdd(clamped.items[pixel].blue, toFixedPoint(removed.z, dither.z));
  }
  return kept;
}

// Whether a sum of values that are not negative has left the range of 63 bits.
bool isFull(const int64_t before, const int64_t added) {
  return uint64_t(before) + uint64_t(added) > 0x7ffffffffffffffful;
}

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
  const uvec4 dither = pcg4d(uvec4(path.pixel, path.sampleIndex, render.view.seed));
  if (kClamp != 0u) radiance = clampSample(render, pixel, radiance, dither);
  const vec3 scaled = radiance * render.view.radianceScale;
  if (any(greaterThan(scaled, vec3(kFixedPointLimit)))) countStatus(kStatusClipped);
  ReplicateRef sums = ReplicateRef(render.view.replicates);
  const int64_t red = toFixedPoint(scaled.x, dither.x);
  const int64_t green = toFixedPoint(scaled.y, dither.y);
  const int64_t blue = toFixedPoint(scaled.z, dither.z);
  const bool redFull = isFull(atomicAdd(sums.items[index].red, red), red);
  const bool greenFull = isFull(atomicAdd(sums.items[index].green, green), green);
  const bool blueFull = isFull(atomicAdd(sums.items[index].blue, blue), blue);
  if (redFull || greenFull || blueFull) countStatus(kStatusClipped);
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
