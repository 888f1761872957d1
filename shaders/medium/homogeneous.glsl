// A homogeneous medium: what is left of light after a distance, and where a path scatters next. Formulas:
// docs/media.md.
#ifndef ISOPHOTE_MEDIUM_HOMOGENEOUS_GLSL
#define ISOPHOTE_MEDIUM_HOMOGENEOUS_GLSL

#include "sampling/hash.glsl"

struct Medium {
  vec3 extinction; // per unit of length, absorption and scattering, >= 0
  vec3 albedo;     // of one scattering, in [0, 1]
  float anisotropy;
};

/// Beer and Lambert: the share of light that neither was absorbed nor scattered. Relative error 2 ULP plus that of the
/// optical depth, which exp turns from relative to absolute; 0 from optical depth 104 on.
vec3 transmittance(const vec3 extinction, const float distance) { return exp(-extinction * distance); }

/// -ln(u) for u uniform in (0, 1), u = (bits + 1/2) 2^-32, with full relative precision at both ends: optical depths
/// from 1e-10 to 22 appear with their probability.
float sampleOpticalDepth(const uint bits) {
  const float scale = 2.3283064365386963e-10; // 2^-32
  const float rest = (float(~bits) + 0.5) * scale;
  if (rest >= 0.25) return -log((float(bits) + 0.5) * scale);
  // -ln(1 - rest) = 2 artanh(z): the series to z^7 is exact to 2e-8.
  const float z = rest / (2.0 - rest);
  const float z2 = z * z;
  return 2.0 * z * (1.0 + z2 * (1.0 / 3.0 + z2 * (0.2 + z2 * (1.0 / 7.0))));
}

struct DistanceSample {
  float distance; // to the scattering
  vec3 weight;    // of the throughput: transmittance, times scattering coefficient if scattered, over the density
  bool scattered; // false: the path reached `limit` first
};

/// Samples where a path of throughput beta scatters next.
///
/// One channel, chosen with probability p_c = beta_c / sum(beta), gives the distance; the density counts all of them
/// (balance heuristic over channels: Wilkie et al. 2014, "Hero Wavelength Spectral Sampling"), so that any chromatic
/// extinction is unbiased, and no channel of beta exceeds the former sum.
/// @param beta   not black
/// @param limit  > 0, distance to the next surface
/// @param bits   uniform; x chooses the channel, y the optical depth
DistanceSample sampleDistance(const Medium medium, const vec3 beta, const float limit, const uvec2 bits) {
  const vec3 p = beta / (beta.x + beta.y + beta.z);
  const float choice = unitFloat(bits.x);
  const float extinction = choice < p.x         ? medium.extinction.x
                           : choice < p.x + p.y ? medium.extinction.y
                                                : medium.extinction.z;
  const float depth = sampleOpticalDepth(bits.y);
  DistanceSample result;
  result.scattered = depth < extinction * limit;
  result.distance = result.scattered ? depth / extinction : limit;
  vec3 left = transmittance(medium.extinction, result.distance);
  if (result.scattered) left *= medium.extinction;
  const float density = dot(p, left);
  result.weight = density > 0.0 ? left / density : vec3(0.0);
  if (result.scattered) result.weight *= medium.albedo;
  return result;
}

#endif
