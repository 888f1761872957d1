// A finished sample into the film.
#ifndef ISOPHOTE_KERNELS_ACCUMULATE_GLSL
#define ISOPHOTE_KERNELS_ACCUMULATE_GLSL

#include "film/fixed_point.glsl"
#include "kernels/wavefront.glsl"
#include "math/float_bits.glsl"
#include "sampling/hash.glsl"

void addRemoved(RemovedRef sums, const uint pixel, const vec3 scaled, const uvec4 dither) {
  atomicAdd(sums.items[pixel].red, toFixedPoint(scaled.x, dither.x));
  atomicAdd(sums.items[pixel].green, toFixedPoint(scaled.y, dither.y));
  atomicAdd(sums.items[pixel].blue, toFixedPoint(scaled.z, dither.z));
}

// Scales a sample brighter than the limit down to it, and keeps account of what that takes away.
vec3 clampSample(const RenderRef render, const uint pixel, const vec3 radiance, const uvec4 dither) {
  const float brightest = max(radiance.x, max(radiance.y, radiance.z));
  if (brightest <= render.view.sampleLimit) return radiance;
  const vec3 kept = radiance * (render.view.sampleLimit / brightest);
  if (render.view.clamped != 0ul) {
    addRemoved(RemovedRef(render.view.clamped), pixel, (radiance - kept) * render.view.radianceScale, dither);
  }
  return kept;
}

// Whether a sum of values that are not negative has left the range of 63 bits.
bool isFull(const int64_t before, const int64_t added) {
  return uint64_t(before) + uint64_t(added) > 0x7ffffffffffffffful;
}

// Of a path that was followed beyond the depth limit: the radiance within it; what it found beyond goes to the ledger,
// in the name of all samples.
vec3 withinDepth(const RenderRef render, const uint slot, const uint pixel, const vec3 radiance, const uvec4 dither) {
  const BeyondState state = BeyondRef(render.view.beyondPaths).items[slot];
  if (state.reached == 0u) return radiance;
  if (isNonFinite(radiance.x) || isNonFinite(radiance.y) || isNonFinite(radiance.z)) {
    countStatus(kStatusNonFinite);
  } else {
    const vec3 removed = max(radiance, vec3(0.0)) * (float(kBeyondShare) * render.view.radianceScale);
    addRemoved(RemovedRef(render.view.beyond), pixel, removed, dither);
  }
  return state.kept;
}

void addSample(const uint slot, const PathState path) {
  RenderRef render = RenderRef(pc.render);
  const uvec2 cropPixel = uvec2(path.pixel & 0xffffu, path.pixel >> 16u) - render.view.cropOrigin;
  const uint pixel = cropPixel.y * render.view.cropSize.x + cropPixel.x;
  const uint index = pixel * kReplicateCount + path.sampleIndex % kReplicateCount;

  const uvec4 dither = pcg4d(uvec4(path.pixel, path.sampleIndex, render.view.seed));
  vec3 radiance = path.radiance;
  if (kDepthLedger != 0u) radiance = withinDepth(render, slot, pixel, radiance, dither);
  if (isNonFinite(radiance.x) || isNonFinite(radiance.y) || isNonFinite(radiance.z)) {
    countStatus(kStatusNonFinite);
    radiance = vec3(0.0);
  } else if (any(lessThan(radiance, vec3(0.0)))) {
    countStatus(kStatusNegative);
    radiance = vec3(0.0);
  }
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

#endif
