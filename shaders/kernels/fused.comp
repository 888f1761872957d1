// All stages in one kernel: each invocation takes the path of its slot, and those that follow it, `pc.steps` vertices
// on. What passes between the stages stays in registers; the queues are filled at the end, so that a wave can go on
// from here. Before the first dispatch and after a wave it is dispatched with no steps, to mark the slots that are
// free.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_arithmetic : require

#define ISOPHOTE_FUSED 1
#include "kernels/accumulate.glsl"
#include "kernels/handover.glsl"
#include "kernels/intersect_closest.glsl"
#include "kernels/intersect_shadow.glsl"
#include "kernels/regenerate.glsl"
#include "kernels/shade_escaped.glsl"
#include "kernels/shade_medium.glsl"
#include "kernels/shade_surface.glsl"
#include "kernels/wavefront.glsl"

struct RayCounts {
  uint primary;
  uint bounce;
  uint shadow;
};

// The next work item that no other invocation has; false where none is left.
bool takeWork(out uint item) {
  const uvec4 lanes = subgroupBallot(true);
  uint first = 0u;
  if (subgroupElect()) {
    first = atomicAdd(WaveRef(pc.wave).state.regenerateTaken, subgroupBallotBitCount(lanes));
  }
  item = subgroupBroadcastFirst(first) + subgroupBallotExclusiveBitCount(lanes);
  return item < WaveRef(pc.wave).state.regenerateCount;
}

// Takes a path to its next vertex and through it, as one wave does. A sample that is finished goes into the film.
void advancePath(const uint slot, inout PathState path, inout RayCounts counts) {
  handedShadow.contribution = vec3(0.0);
  uint next = intersectPath(slot, path);
  if (kHasScatteringMedia && next == kQueueMedium) next = shadeMedium(slot, path);
  if (shinesBeyondSurfaces() && next == kQueueEscaped) {
    shadeEscaped(slot, path);
    next = kQueueFinished;
  }
  if (next == kQueueSurface) next = shadeSurface(slot, path) ? kQueueRay : kQueueFinished;
  if (samplesLights() && any(notEqual(handedShadow.contribution, vec3(0.0)))) {
    path.radiance += arrivingLight(slot, handedShadow, path);
    counts.shadow += 1u;
  }
  if (next == kQueueFinished) {
    addSample(slot, path);
    path.sampleIndex = kNoSample;
  }
}

void addRays(const RayCounts counts) {
  const uint primary = subgroupAdd(counts.primary);
  const uint bounce = subgroupAdd(counts.bounce);
  const uint shadow = subgroupAdd(counts.shadow);
  if (!subgroupElect()) return;
  WaveRef wave = WaveRef(pc.wave);
  atomicAdd(wave.state.primaryRays, uint64_t(primary));
  atomicAdd(wave.state.bounceRays, uint64_t(bounce));
  atomicAdd(wave.state.shadowRays, uint64_t(shadow));
}

void markFree(const uint item) {
  uint slot;
  if (takeSlot(kQueueFree, item, slot)) PathRef(pc.paths).items[slot].sampleIndex = kNoSample;
}

// Whether this workgroup's slots take new paths. Those that do are spread evenly over the dispatch, which llvmpipe cuts
// into a contiguous part for each core.
bool takesPaths() {
  const uint groups = gl_NumWorkGroups.x;
  const uint taking = (pc.activeLimit + pc.workgroupSize - 1u) / pc.workgroupSize;
  return (gl_WorkGroupID.x * taking) % groups < taking;
}

void main() {
  const uint slot = itemIndex();
  if (pc.steps == 0u) {
    markFree(slot);
    return;
  }
  if (slot >= pc.capacity) return;
  const bool takes = takesPaths();
  if (!takes && PathRef(pc.paths).items[slot].sampleIndex == kNoSample) {
    pushSlot(kQueueFree, slot);
    return;
  }
  // New paths start together, when half of the lanes are free: rays from the camera stay close to each other
  // (docs/performance.md). In the first step any lane may, so that every dispatch gets on.
  const uint enough = (subgroupBallotBitCount(subgroupBallot(takes)) + 1u) / 2u;
  handedRay = RayRef(pc.rays).items[slot];
  PathState path = PathRef(pc.paths).items[slot];
  RayCounts counts = RayCounts(0u, 0u, 0u);
  for (uint step = 0u; step < pc.steps; ++step) {
    if (path.sampleIndex == kNoSample) {
      if (!takes) break;
      if (step > 0u && subgroupBallotBitCount(subgroupBallot(true)) < enough) continue;
      uint item;
      if (!takeWork(item)) break;
      if (!startPath(slot, item, path)) {
        path.sampleIndex = kNoSample;
        continue;
      }
      counts.primary += 1u;
    } else {
      counts.bounce += 1u;
    }
    advancePath(slot, path, counts);
  }
  RayRef(pc.rays).items[slot] = handedRay;
  PathRef(pc.paths).items[slot] = path;
  if (path.sampleIndex == kNoSample) {
    pushSlot(kQueueFree, slot);
  } else {
    pushSlot(kQueueRay, slot);
  }
  addRays(counts);
}
