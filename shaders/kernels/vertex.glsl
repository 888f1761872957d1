// What all vertices of a path share: their random numbers, and whether the path goes on.
#ifndef ISOPHOTE_KERNELS_VERTEX_GLSL
#define ISOPHOTE_KERNELS_VERTEX_GLSL

#include "kernels/wavefront.glsl"
#include "sampling/hash.glsl"
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

/// Whether vertices send shadow rays.
bool samplesLights() { return kHasPunctualLights || (kHasSizedLights && kLightSampling != 2u); }

/// Whether a path scatters at the vertex it has reached: within the depth limit. Some samples, chosen by a hash of
/// their own, go on beyond it: what they gather there is not for the image but tells what the limit leaves out.
bool scattersHere(const uint slot, inout PathState path) {
  RenderRef render = RenderRef(pc.render);
  if (path.depth < render.view.maxDepth) return true;
  if (kDepthLedger == 0u || render.view.beyond == 0ul) return false;
  if (path.depth > render.view.maxDepth) return true; // it went on before
  if (pcg4d(uvec4(path.pixel, ~path.sampleIndex, render.view.seed)).x % kBeyondShare != 0u) return false;
  BeyondRef(render.view.beyondPaths).items[slot] = BeyondState(path.radiance, 1u);
  path.radiance = vec3(0.0);
  return true;
}

/// Russian roulette after a scattering. False: the path ends; else its throughput makes up for those that did.
///
/// @param power  the throughput that counts, its brightest channel
bool survivesRoulette(const float power, const float u, inout PathState path) {
  // Without it nothing but the limit ends a path in a closed room.
  const bool beyond = kDepthLedger != 0u && path.depth > RenderRef(pc.render).view.maxDepth;
  if ((kRussianRoulette == 0u && !beyond) || path.depth < kRouletteDepth) return true;
  // The root ends paths later: what a path that goes on costs is less than the noise of one that ended.
  const float chance = kRussianRoulette == 2u ? power : sqrt(power);
  const float survival = min(chance, kRouletteMaxSurvival);
  if (u >= survival) return false;
  path.beta /= survival;
  return true;
}

#endif
