// KHR_materials_sheen: fibres that stand up from the surface. Formulas: docs/bsdf-layers.md, "Sheen".
#ifndef ISOPHOTE_BSDF_SHEEN_GLSL
#define ISOPHOTE_BSDF_SHEEN_GLSL

#include "bsdf/layer.glsl"
#include "math/constants.glsl"
#include "sampling/warp.glsl"

struct Sheen {
  vec3 color;      // linear, in [0, 1]; black: no sheen
  float roughness; // perceptual, in [0, 1]
};

float sheenAlpha(const Sheen sheen) { return max(sheen.roughness * sheen.roughness, kMinSheenAlpha); }

/// Coverage of what lies below: that of the brightest channel, so that no channel gains energy.
float sheenAmount(const Sheen sheen) { return max(sheen.color.x, max(sheen.color.y, sheen.color.z)); }

/// Position of the sheen's roughness among the rows of its table, denser where the lobe changes fastest with it.
float sheenRow(const Sheen sheen) {
  const float least = sqrt(kMinSheenAlpha);
  return sqrt(max(sheen.roughness - least, 0.0) / (1.0 - least));
}

/// Density of fibre normals at the squared sine of their angle to the surface's.
/// Source: Estevez and Kulla 2017, "Production Friendly Microfacet Sheen BRDF", eq. 2.
float charlieD(const float sinSquared, const float alpha) {
  return (2.0 + 1.0 / alpha) * kInvTwoPi * pow(sinSquared, 0.5 / alpha);
}

float charlieCurve(const float x, const float t) {
  const float a = mix(21.5473, 25.3245, t);
  const float b = mix(3.82987, 3.32435, t);
  const float c = mix(0.19823, 0.16801, t);
  const float d = mix(-1.97760, -1.27393, t);
  const float e = mix(-4.32054, -4.85967, t);
  return a / (1.0 + b * pow(x, c)) + d * x + e;
}

/// Smith's Lambda of the fibres. Source: Estevez and Kulla 2017, eq. 3 and table 1.
float charlieLambda(const float cosine, const float alpha) {
  const float t = (1.0 - alpha) * (1.0 - alpha);
  const float exponent =
      cosine < 0.5 ? charlieCurve(cosine, t) : 2.0 * charlieCurve(0.5, t) - charlieCurve(1.0 - cosine, t);
  return exp(exponent);
}

/// Samples the hemisphere uniformly, 1 / (2 pi) per steradian: f cos wi / pdf stays bounded at the horizon, where it
/// would not with the cosine's density.
vec3 sampleSheen(const vec2 u) {
  const vec3 wi = sampleUniformSphere(u);
  return vec3(wi.xy, abs(wi.z));
}

/// f cos wi of the sheen of color 1, scaled at both directions so that it reflects at most what arrives.
/// @param cellO, cellI of wo and wi at the sheen's roughness
float evalSheen(FloatRef table, const Sheen sheen, const LayerCell cellO, const LayerCell cellI, const vec3 wo,
                const vec3 wi) {
  const float alpha = sheenAlpha(sheen);
  const vec3 sum = wo + wi;
  const float sinSquared = min(dot(sum.xy, sum.xy) / dot(sum, sum), 1.0);
  const float masking = 1.0 + charlieLambda(wo.z, alpha) + charlieLambda(wi.z, alpha);
  const float scale = readLayer(table, kLayerScale, cellO) * readLayer(table, kLayerScale, cellI);
  return scale * charlieD(sinSquared, alpha) / (4.0 * wo.z * masking);
}

#endif
