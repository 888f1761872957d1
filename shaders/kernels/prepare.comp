// Turns queue counts into the next stages' dispatch sizes. One invocation; the host never reads a count between
// kernels.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "kernels/wavefront.glsl"

DispatchSize groupsFor(const uint count) {
  return DispatchSize((count + pc.workgroupSize - 1u) / pc.workgroupSize, 1u, 1u);
}

// Before the first stage that shades.
void emptyNextQueues(const WaveRef wave) {
  wave.state.counts[kQueueRay] = 0u;
  wave.state.counts[kQueueShadow] = 0u;
}

// Which samples the next `count` work items are.
void setFirstWork(const WaveRef wave, const uint count) {
  const uint64_t padded = uint64_t(RenderRef(pc.render).view.paddedPixelCount);
  wave.state.regenerateCount = count;
  wave.state.regenerateSample = uint(wave.state.nextWork / padded);
  wave.state.regeneratePixel = uint(wave.state.nextWork % padded);
}

uint64_t workLeft(const WaveRef wave) { return RenderRef(pc.render).view.workEnd - wave.state.nextWork; }

void prepareRegenerate(const WaveRef wave) {
  const uint freeCount = wave.state.counts[kQueueFree];
  const uint inFlight = pc.capacity - freeCount;
  const uint wanted = min(freeCount, pc.activeLimit > inFlight ? pc.activeLimit - inFlight : 0u);
  const uint count = uint(min(uint64_t(wanted), workLeft(wave)));
  setFirstWork(wave, count);
  wave.state.nextWork += uint64_t(count);
  wave.state.counts[kQueueFree] = freeCount - count; // regenerate takes the last `count` entries
  wave.state.dispatches[kStageRegenerate] = groupsFor(count);
  wave.state.counts[kQueueFinished] = 0u;
  // The rays already queued continue paths; what regenerate adds to them starts new ones.
  wave.state.bounceRays += uint64_t(wave.state.counts[kQueueRay]);
  wave.state.primaryRays -= uint64_t(wave.state.counts[kQueueRay]);
}

// More than one dispatch can start; small enough for sums with the number of a pixel in 32 bits.
const uint kMostFusedWork = 1u << 30u;

void prepareFused(const WaveRef wave) {
  setFirstWork(wave, uint(min(uint64_t(kMostFusedWork), workLeft(wave))));
  wave.state.regenerateTaken = 0u;
  wave.state.counts[kQueueRay] = 0u;
  wave.state.counts[kQueueFree] = 0u;
}

void main() {
  if (gl_GlobalInvocationID.x != 0u) return;
  WaveRef wave = WaveRef(pc.wave);
  switch (pc.prepare) {
  case kPrepareRegenerate:
    prepareRegenerate(wave);
    break;
  case kPrepareIntersect:
    wave.state.primaryRays += uint64_t(wave.state.counts[kQueueRay]);
    wave.state.counts[kQueueSurface] = 0u;
    wave.state.counts[kQueueEscaped] = 0u;
    wave.state.counts[kQueueMedium] = 0u;
    wave.state.dispatches[kStageIntersectClosest] = groupsFor(wave.state.counts[kQueueRay]);
    break;
  case kPrepareMedium:
    emptyNextQueues(wave);
    wave.state.dispatches[kStageShadeMedium] = groupsFor(wave.state.counts[kQueueMedium]);
    break;
  case kPrepareShade:
    if (!kHasScatteringMedia) emptyNextQueues(wave);
    wave.state.dispatches[kStageShadeEscaped] = groupsFor(wave.state.counts[kQueueEscaped]);
    wave.state.dispatches[kStageShadeSurface] = groupsFor(wave.state.counts[kQueueSurface]);
    break;
  case kPrepareShadow:
    wave.state.shadowRays += uint64_t(wave.state.counts[kQueueShadow]);
    wave.state.dispatches[kStageIntersectShadow] = groupsFor(wave.state.counts[kQueueShadow]);
    wave.state.dispatches[kStageAccumulate] = groupsFor(wave.state.counts[kQueueFinished]);
    break;
  case kPrepareFused:
    prepareFused(wave);
    break;
  case kPrepareAfterFused:
    wave.state.nextWork += uint64_t(min(wave.state.regenerateTaken, wave.state.regenerateCount));
    break;
  }
}
