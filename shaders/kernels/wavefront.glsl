// What every stage shares: the push constant, the typed views of the pool, queue access.
#ifndef ISOPHOTE_KERNELS_WAVEFRONT_GLSL
#define ISOPHOTE_KERNELS_WAVEFRONT_GLSL

#extension GL_EXT_shader_atomic_int64 : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_ballot : require

#include "shared/buffers.glsl"
#include "shared/constants.glsl"
#include "shared/path_types.h"

layout(local_size_x_id = 0) in;

// clang-format off
layout(push_constant, scalar) uniform PushConstant { KernelArgs pc; };
// clang-format on

layout(buffer_reference, scalar, buffer_reference_align = 8) buffer WaveRef { WaveState state; };
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer RenderRef { RenderView view; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer QueueRef { uint slots[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer RayRef { RayState items[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer HitRef { HitState items[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer PathRef { PathState items[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer ReceiverRef { LightReceiver items[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer ShadowRef { ShadowState items[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer MediaRef { MediaState items[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer InteriorRef { InteriorState items[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer StraightRef { StraightState items[]; };
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer ReplicateRef { ReplicateSum items[]; };
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer AovRef { AovSum items[]; };
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer RemovedRef { RemovedSum items[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer BeyondRef { BeyondState items[]; };

// Whether shadow rays cross glass, unbent.
const bool kStraightShadows = kHasTransmission && kShadowTransmission == 1u;

// Whether the probability of a light depends on where it was chosen for, and a ray may find lights.
bool keepsReceivers() { return kHasLightTree && (kHasEmissiveTriangles || kHasSphereLights) && pc.receivers != 0ul; }

// Where the path scattered last; its ray may have started anew since, at boundaries that do nothing.
vec3 lastScattering(const uint slot, const RayState ray) {
  return kHasVolumes ? ray.origin - MediaRef(pc.media).items[slot].travelled * ray.direction : ray.origin;
}

// What light sampling was given at the last scattering, at p.
LightReceiver receiverOf(const uint slot, const vec3 p) {
  LightReceiver receiver = LightReceiver(p, vec3(0.0));
  if (keepsReceivers()) receiver = ReceiverRef(pc.receivers).items[slot];
  return receiver;
}

void countStatus(const uint counter) { atomicAdd(WaveRef(pc.wave).state.status[counter], 1u); }

QueueRef queueSlots(const uint queue) { return QueueRef(pc.queues + uint64_t(queue) * uint64_t(pc.capacity) * 4ul); }

// The item this invocation works on. Workgroups are dealt alternately from the two halves of the queue: a driver that
// gives each of two cores one contiguous half of a dispatch (llvmpipe) then balances expensive regions of the image.
uint itemIndex() {
  const uint groups = gl_NumWorkGroups.x;
  const uint firstHalf = (groups + 1u) / 2u;
  const uint group = gl_WorkGroupID.x < firstHalf ? 2u * gl_WorkGroupID.x : 2u * (gl_WorkGroupID.x - firstHalf) + 1u;
  return group * pc.workgroupSize + gl_LocalInvocationID.x;
}

// Appends `slot`, with one atomic per subgroup. Every slot is in a queue at most once, so `capacity` always suffices;
// the check makes a bug visible instead of corrupting memory.
void pushSlot(const uint queue, const uint slot) {
  const uvec4 lanes = subgroupBallot(true);
  uint first = 0u;
  if (subgroupElect()) first = atomicAdd(WaveRef(pc.wave).state.counts[queue], subgroupBallotBitCount(lanes));
  const uint index = subgroupBroadcastFirst(first) + subgroupBallotExclusiveBitCount(lanes);
  if (index < pc.capacity) {
    queueSlots(queue).slots[index] = slot;
  } else {
    countStatus(kStatusQueueOverflow);
  }
}

// The slot of queue item `index`, or false past the end of the queue.
bool takeSlot(const uint queue, const uint index, out uint slot) {
  slot = 0u;
  if (index >= WaveRef(pc.wave).state.counts[queue]) return false;
  slot = queueSlots(queue).slots[index];
#ifdef ISOPHOTE_CHECK_BOUNDS
  if (slot >= pc.capacity) {
    countStatus(kStatusOutOfBounds);
    return false;
  }
#endif
  return true;
}

#endif
