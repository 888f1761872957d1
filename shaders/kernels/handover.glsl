// How a path's ray, what it meets and its shadow ray get from one stage to the next: through the pool; where one kernel
// holds all stages, in variables.
#ifndef ISOPHOTE_KERNELS_HANDOVER_GLSL
#define ISOPHOTE_KERNELS_HANDOVER_GLSL

#include "kernels/wavefront.glsl"

#ifdef ISOPHOTE_FUSED

RayState handedRay;
HitState handedHit;
ShadowState handedShadow; // without a contribution: there is none

RayState rayOf(const uint slot) { return handedRay; }
HitState hitOf(const uint slot) { return handedHit; }

void handRay(const uint slot, const RayState ray) { handedRay = ray; }
void handHit(const uint slot, const HitState hit) { handedHit = hit; }
void handShadowRay(const uint slot, const ShadowState shadow) { handedShadow = shadow; }

#else

RayState rayOf(const uint slot) { return RayRef(pc.rays).items[slot]; }
HitState hitOf(const uint slot) { return HitRef(pc.hits).items[slot]; }

void handRay(const uint slot, const RayState ray) { RayRef(pc.rays).items[slot] = ray; }
void handHit(const uint slot, const HitState hit) { HitRef(pc.hits).items[slot] = hit; }
void handShadowRay(const uint slot, const ShadowState shadow) {
  ShadowRef(pc.shadows).items[slot] = shadow;
  pushSlot(kQueueShadow, slot);
}

#endif

#endif
