// What all vertices of a path share: their random numbers, and whether the path goes on.
#ifndef ISOPHOTE_KERNELS_VERTEX_GLSL
#define ISOPHOTE_KERNELS_VERTEX_GLSL

#include "kernels/wavefront.glsl"
#include "shared/constants.glsl"

// Pairs of random numbers of path vertex d start at kFirstVertexPair + kVertexPairs * d.
const uint kFirstVertexPair = 2u;
const uint kVertexPairs = 4u;

// Roulette starts at this depth, and never lets a path live with more than this probability: a lossless closed scene
// ends. At reflectance rho the weights of long paths have finite variance only where rho^2 is below this limit, so it
// must be close to 1: with 0.95 a closed room of reflectance 0.98 would never converge.
const uint kRouletteDepth = 3u;
const float kRouletteMaxSurvival = 0.999;

// Lights that a direction can find.
const bool kHasSizedLights = kHasEmissiveTriangles || kHasSphereLights || kHasSuns || kHasEnvironment;

/// Russian roulette after a scattering. False: the path ends; else its throughput makes up for those that did.
///
/// @param power  probability of survival before it is limited
bool survivesRoulette(const float power, const float u, inout PathState path) {
  if (kRussianRoulette == 0u || path.depth < kRouletteDepth) return true;
  const float survival = min(power, kRouletteMaxSurvival);
  if (u >= survival) return false;
  path.beta /= survival;
  return true;
}

#endif
