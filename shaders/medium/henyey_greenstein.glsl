// The phase function of Henyey and Greenstein 1941, "Diffuse radiation in the Galaxy": f = pdf, so the weight is 1.
#ifndef ISOPHOTE_MEDIUM_HENYEY_GREENSTEIN_GLSL
#define ISOPHOTE_MEDIUM_HENYEY_GREENSTEIN_GLSL

#include "math/constants.glsl"
#include "math/frame.glsl"
#include "math/trigonometry.glsl"

/// Phase function and density of sampleHenyeyGreenstein, per steradian.
///
/// (1-g^2) / (4 pi (1 + g^2 - 2 g cos)^1.5), cos = dot(-wo, wi). The base of the power is taken as (1-|g|)^2 plus
/// |g| times the squared distance of the two directions that g favours: a sum of positive terms, exact to rounding
/// where |g| is near 1 and cos is near its peak.
/// @param g  in (-1, 1), mean cosine; positive: forward
float evalHenyeyGreenstein(const vec3 wo, const vec3 wi, const float g) {
  const vec3 apart = g >= 0.0 ? wi + wo : wi - wo; // squared length 2 (1 - |cos|) at the peak
  const float sharp = 1.0 - abs(g);
  const float base = sharp * sharp + abs(g) * dot(apart, apart);
  return kInv4Pi * sharp * (1.0 + abs(g)) / (base * sqrt(base));
}

/// Samples a direction by the phase function.
///
/// The inverse of the distribution, with both 1 - cos = 2 (1-u) (1-g)^2 (1 + g u) / d^2 and
/// 1 + cos = 2 u (1+g)^2 (1 - g (1-u)) / d^2, d = 1 - g + 2 g u, as products: the usual form divides by 2 g and loses
/// all digits as g -> 0, and those of small angles as |g| -> 1.
/// @param u  in [0, 1)^2, multiples of 2^-24
vec3 sampleHenyeyGreenstein(const vec3 wo, const float g, const vec2 u) {
  const float x = u.x + 2.9802322387695312e-8; // the middle of u's step; may round to 1, cos = 1
  const float y = 1.0 - x;
  const float d = g >= 0.0 ? (1.0 - g) + 2.0 * g * x : (1.0 + g) - 2.0 * g * y; // the same, without cancellation
  const float oneMinusCos = 2.0 * y * (1.0 - g) * (1.0 - g) * (1.0 + g * x) / (d * d);
  const float onePlusCos = 2.0 * x * (1.0 + g) * (1.0 + g) * (1.0 - g * y) / (d * d);
  const float small = min(oneMinusCos, onePlusCos);
  const float sinTheta = sqrt(small * (2.0 - small));
  const float cosTheta = oneMinusCos < onePlusCos ? 1.0 - small : small - 1.0;
  const vec2 sinCos = sinCosPi(2.0 * u.y - 1.0);
  return toWorld(frameFromNormal(-wo), vec3(sinTheta * sinCos.y, sinTheta * sinCos.x, cosTheta));
}

#endif
