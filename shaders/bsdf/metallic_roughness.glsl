// The base of a surface: the glTF 2.0 metallic-roughness model with transmission, made energy conserving and
// reciprocal. Formulas: docs/bsdf.md.
//
// Directions are unit and in the local shading frame, z the shading normal on wo's side; wi.z < 0: transmitted.
#ifndef ISOPHOTE_BSDF_METALLIC_ROUGHNESS_GLSL
#define ISOPHOTE_BSDF_METALLIC_ROUGHNESS_GLSL

#include "bsdf/anisotropic_albedo.glsl"
#include "bsdf/dielectric_interface.glsl"
#include "bsdf/diffuse_transmission.glsl"
#include "bsdf/facet_distribution.glsl"
#include "bsdf/fresnel.glsl"
#include "bsdf/ggx_albedo.glsl"
#include "bsdf/glass_loss.glsl"
#include "bsdf/iridescence.glsl"
#include "math/constants.glsl"
#include "sampling/warp.glsl"
#include "shared/bsdf_constants.h"
#include "shared/buffers.glsl"
#include "shared/constants.glsl"

struct MetallicRoughness {
  vec3 baseColor;
  float metallic;
  vec3 f0;     // of all facets but those of glass
  float alpha; // roughness squared, of anisotropic facets the geometric mean of both widths; below kMirrorAlpha the
               // specular lobe is a delta mirror
  vec2 width;  // alpha along x and y
  vec2 grain;  // roughness and strength of anisotropic facets
  uint anisotropicAlbedo; // where their table begins; kInvalidIndex: isotropic
  vec3 f90;
  float diffuse;      // share of the surface that has a diffuse lobe under its coat
  float ior;          // of opaque dielectric facets, where the setting fresnel is exact; below 1 stands for infinity
  uint exactAlbedo;   // where the table of their albedo begins in scene.view.ggxAlbedo, as the setting has it
  float dielectricF0; // of the coat over the diffuse lobe: its largest channel, so that no channel gains energy
  float dielectricF90;
  vec3 glassF0;     // of dielectric facets at normal incidence
  float glassF90;   // and at grazing
  float glass;      // share of the surface whose facets transmit
  float eta;        // index behind the surface over the index in front; of thin walls that of the wall
  bool thinWalled;  // both boundaries in one: transmission does not bend
  uint lossInFront; // half tables of glassLoss for light from wo's side and from the other; kInvalidIndex: none
  uint lossBehind;
  Iridescence film;
  vec3 conductorN; // complex index of the metal; 0: it reflects its base color
  vec3 conductorK;
  DiffuseTransmission behind; // the part of the diffuse lobe on the other side
};

/// Of the base's continuous lobes, f |cos wi| in two parts, which the layers above pass differently.
struct BaseValue {
  vec3 facets;         // of microfacets, scattering between opaque ones included
  vec3 diffuse;        // of the diffuse lobe, and scattering between facets of glass
  float pdfSolidAngle; // of sampleBase, per steradian of wi
};

/// Of the continuous lobes. f scatters radiance: across a boundary of index ratio eta it carries the factor 1 / eta^2.
struct BsdfValue {
  vec3 fCos;           // f |cos wi|
  float pdfSolidAngle; // of sampleBsdf, per steradian of wi
};

struct BsdfSample {
  vec3 wiLocal;
  vec3 weight;         // f |cos wi| / pdf over all continuous lobes; for the delta lobe reflectance / its probability
  float pdfSolidAngle; // of all continuous lobes; 0 for the delta lobe
  bool delta;
  bool valid; // false: absorbed
  float eta;  // index on wi's side over the index on wo's: 1 unless the sample is refracted
};

/// Derives the lobes' parameters from glTF's factors after texturing.
///
/// Source: Khronos, glTF 2.0 appendix B; KHR_materials_ior; KHR_materials_specular.
/// @param ior           of the dielectric; 0 stands for infinity as in KHR_materials_ior
/// @param roughness     perceptual, in [0, 1]
/// @param specularColor linear, any positive value; the reflectance is clamped to 1
MetallicRoughness metallicRoughness(const vec3 baseColor, const float metallic, const float roughness, const float ior,
                                    const float specular, const vec3 specularColor) {
  const float amplitude = (ior - 1.0) / (ior + 1.0);
  const vec3 dielectric = min(amplitude * amplitude * specularColor, vec3(1.0)) * specular;
  MetallicRoughness m;
  m.baseColor = baseColor;
  m.metallic = metallic;
  m.alpha = roughness * roughness;
  m.width = vec2(m.alpha);
  m.grain = vec2(0.0);
  m.anisotropicAlbedo = kInvalidIndex;
  m.f0 = mix(dielectric, baseColor, metallic);
  m.f90 = vec3(mix(specular, 1.0, metallic));
  m.diffuse = 1.0 - metallic;
  m.ior = ior;
  m.exactAlbedo = 0u;
  m.dielectricF0 = max(dielectric.x, max(dielectric.y, dielectric.z));
  m.dielectricF90 = specular;
  m.glassF0 = dielectric;
  m.glassF90 = specular;
  m.glass = 0.0;
  m.eta = 1.0;
  m.thinWalled = true;
  m.lossInFront = kInvalidIndex;
  m.lossBehind = kInvalidIndex;
  m.film = Iridescence(0.0, 1.0, 0.0);
  m.conductorN = vec3(0.0);
  m.conductorK = vec3(0.0);
  m.behind = kNoDiffuseTransmission;
  return m;
}

/// Lets a part of the diffuse lobe out on the other side.
void setDiffuseTransmission(inout MetallicRoughness m, const DiffuseTransmission behind, const bool thinWalled) {
  m.behind = behind;
  m.thinWalled = thinWalled;
}

/// Names the tables that restore what rough glass loses.
///
/// @param table     of the material's index in air, kInvalidIndex: none
/// @param frontFace wo is in the air
void setGlassLoss(inout MetallicRoughness m, const uint table, const bool frontFace) {
  if (table == kInvalidIndex) return;
  m.lossInFront = frontFace ? table : table + kGlassLossHalf;
  m.lossBehind = frontFace ? table + kGlassLossHalf : table;
}

/// Names the table of the albedo that opaque dielectric facets have where the setting fresnel is exact.
/// @param ior of the material in air
void setExactAlbedo(inout MetallicRoughness m, const float ior, const uint table) {
  m.ior = ior;
  m.exactAlbedo = kFresnel == kFresnelExact ? table : 0u;
}

/// Widens the facets' slopes along x.
///
/// Source: Khronos, KHR_materials_anisotropy: mix(alpha, 1, strength^2) along x, alpha along y. The tables of glass and
/// layers are read at the geometric mean.
/// @param strength in [0, 1]
/// @param table    of the albedo
void setAnisotropy(inout MetallicRoughness m, const float strength, const uint table) {
  if (strength <= 0.0) return;
  const vec2 width = vec2(mix(m.alpha, 1.0, strength * strength), m.alpha);
  if (width.x < kNarrowestAlpha) return;
  m.grain = vec2(sqrt(m.alpha), strength);
  m.anisotropicAlbedo = table;
  m.width = max(width, vec2(kNarrowestAlpha));
  m.alpha = sqrt(m.width.x * m.width.y);
}

/// Turns a share of the dielectric into glass: facets that reflect by the exact Fresnel equations and transmit the
/// rest.
///
/// Source: Khronos, KHR_materials_transmission and KHR_materials_volume.
/// @param m            as metallicRoughness returns it
/// @param transmission share, in [0, 1]; an index that stands for infinity lets nothing through
/// @param eta          relativeIor; of thin walls the wall's own index
void setTransmission(inout MetallicRoughness m, const float transmission, const float eta, const bool thinWalled) {
  m.f0 = mix((1.0 - transmission) * m.glassF0, m.baseColor, m.metallic);
  m.f90 = vec3(mix((1.0 - transmission) * m.dielectricF90, 1.0, m.metallic));
  m.diffuse = (1.0 - m.metallic) * (1.0 - transmission);
  m.glass = (1.0 - m.metallic) * transmission;
  m.eta = eta;
  m.thinWalled = thinWalled;
}

// Whether there may be anything on the other side of a surface.
const bool kHasFarSide = kHasTransmission || kHasDiffuseTransmission;

bool isConductor(const MetallicRoughness m) { return kHasConductor && m.conductorN.x > 0.0; }

bool hasFilm(const MetallicRoughness m) { return kHasIridescence && m.film.amount > 0.0; }

vec3 metalReflectance(const MetallicRoughness m, const float cosine) {
  if (!isConductor(m)) return fresnelSchlick(m.baseColor, vec3(1.0), cosine);
  return vec3(fresnelConductor(cosine, m.conductorN.x, m.conductorK.x),
              fresnelConductor(cosine, m.conductorN.y, m.conductorK.y),
              fresnelConductor(cosine, m.conductorN.z, m.conductorK.z));
}

// Whether opaque dielectric facets reflect by the Fresnel equations; those under a film are Schlick's.
bool reflectsExactly(const MetallicRoughness m) { return kFresnel == kFresnelExact && m.ior >= 1.0 && !hasFilm(m); }

// What opaque dielectric facets reflect.
vec3 opaqueReflectance(const MetallicRoughness m, const float cosine) {
  if (!reflectsExactly(m)) return fresnelSchlick(m.glassF0, vec3(m.glassF90), cosine);
  const float share = grazingShare(fresnelDielectric(cosine, m.ior), m.ior);
  return max(m.glassF0 + (vec3(m.glassF90) - m.glassF0) * share, vec3(0.0));
}

/// What facets other than glass reflect.
vec3 facetReflectance(const MetallicRoughness m, const float cosine) {
  if (!hasFilm(m) && !isConductor(m) && !reflectsExactly(m)) return fresnelSchlick(m.f0, m.f90, cosine);
  vec3 metal = metalReflectance(m, cosine);
  vec3 dielectric = opaqueReflectance(m, cosine);
  if (hasFilm(m)) {
    metal = mix(metal, filmReflectance(m.film, cosine, metalReflectance(m, 1.0)), m.film.amount);
    dielectric = mix(dielectric, filmReflectance(m.film, cosine, m.glassF0), m.film.amount);
  }
  return m.diffuse * dielectric + m.metallic * metal;
}

/// Gives the metal a complex index of refraction.
void setConductor(inout MetallicRoughness m, const vec3 n, const vec3 k) {
  m.conductorN = n;
  m.conductorK = k;
  m.f0 = facetReflectance(m, 1.0);
}

/// Puts a thin film on the facets. The coat over the diffuse lobe is then taken for the brightest that interference can
/// make it, so that no color gains energy.
void setIridescence(inout MetallicRoughness m, const Iridescence film) {
  if (film.amount <= 0.0) return;
  m.film = film;
  m.dielectricF0 = mix(m.dielectricF0, max(m.dielectricF0, filmBound(film, m.glassF0)), film.amount);
  m.dielectricF90 = mix(m.dielectricF90, 1.0, film.amount);
  m.f90 = mix(m.f90, vec3(m.diffuse + m.metallic), film.amount);
  m.f0 = facetReflectance(m, 1.0);
}

bool isMirror(const MetallicRoughness m) { return kHasMirror && m.alpha < kMirrorAlpha; }

// Table alpha: a mirror's albedo is the limit alpha = 0.
float albedoAlpha(const MetallicRoughness m) { return isMirror(m) ? 0.0 : m.alpha; }

/// Returns (A, B) of the facets for light leaving along w, |w.z| the cosine.
vec2 facetAlbedo(const SceneRef scene, const MetallicRoughness m, const vec3 w) {
  if (kHasAnisotropy && m.anisotropicAlbedo != kInvalidIndex) {
    const AnisotropicCell cell = anisotropicCell(scene, m.anisotropicAlbedo, m.grain);
    return anisotropicAlbedo(scene, cell, m.width, vec3(w.xy, abs(w.z)));
  }
  return ggxAlbedo(scene, 0u, abs(w.z), albedoAlpha(m));
}

/// Returns the cosine-weighted mean of facetAlbedo.
vec2 facetMeanAlbedo(const SceneRef scene, const MetallicRoughness m) {
  if (kHasAnisotropy && m.anisotropicAlbedo != kInvalidIndex) {
    return anisotropicMeanAlbedo(scene, anisotropicCell(scene, m.anisotropicAlbedo, m.grain));
  }
  return ggxMeanAlbedo(scene, 0u, albedoAlpha(m));
}

// The same sum, parted as the coat's reflectance parts it: by the exact one where the setting has that.
vec2 coatAlbedo(const SceneRef scene, const MetallicRoughness m, const vec2 albedo, const float mu) {
  if (!reflectsExactly(m) || m.exactAlbedo == 0u) return albedo;
  const float grazing = ggxAlbedo(scene, m.exactAlbedo, mu, albedoAlpha(m)).y;
  return vec2(albedo.x + albedo.y - grazing, grazing);
}

vec2 coatMeanAlbedo(const SceneRef scene, const MetallicRoughness m, const vec2 mean) {
  if (!reflectsExactly(m) || m.exactAlbedo == 0u) return mean;
  const float grazing = ggxMeanAlbedo(scene, m.exactAlbedo, albedoAlpha(m)).y;
  return vec2(mean.x + mean.y - grazing, grazing);
}

float largest(const vec3 v) { return max(v.x, max(v.y, v.z)); }

float luminance(const vec3 color) { return dot(color, vec3(0.2126, 0.7152, 0.0722)); } // of Rec.709 primaries

/// Returns the reflectance of a facet of glass: fresnelDielectric, or the setting's, scaled as KHR_materials_specular
/// scales Schlick's approximation, f0 + (f90 - f0) x with x the share of the way from normal to grazing reflectance.
/// Total internal reflection is total whatever the scale.
vec3 glassReflectance(const MetallicRoughness m, const float cosine) {
  const float reflectance =
      kFresnel == kFresnelSchlick ? schlickDielectric(cosine, m.eta) : fresnelDielectric(cosine, m.eta);
  if (reflectance >= 1.0) return vec3(1.0);
  const float share = grazingShare(reflectance, m.eta);
  const vec3 bare = max(m.glassF0 + (vec3(m.glassF90) - m.glassF0) * share, vec3(0.0)); // f0 may be less than eta's
  if (!hasFilm(m)) return bare;
  const float sin2Outside = (1.0 - cosine * cosine) / min(m.eta * m.eta, 1.0); // from inside, by Snell's law
  return mix(bare, filmReflectance(m.film, sqrt(max(1.0 - sin2Outside, 0.0)), m.glassF0), m.film.amount);
}

/// What the facets under one cosine do with light.
struct FacetScattering {
  vec3 reflected;
  vec3 transmitted;
  float reflectedShare; // of the two, by luminance: the probability of reflecting a sampled facet's light
};

/// @param cosine between wo and the facet's normal
FacetScattering scatterAtFacet(const MetallicRoughness m, const float cosine) {
  FacetScattering facet = FacetScattering(facetReflectance(m, cosine), vec3(0.0), 1.0);
  if (!kHasTransmission || m.glass == 0.0) return facet;
  const vec3 reflectance = glassReflectance(m, cosine);
  facet.reflected += m.glass * reflectance;
  facet.transmitted = m.glass * (1.0 - largest(reflectance)) * m.baseColor;
  const float reflected = luminance(facet.reflected);
  const float sum = reflected + luminance(facet.transmitted);
  facet.reflectedShare = sum > 0.0 ? reflected / sum : 1.0;
  return facet;
}

// Where indices are this close for the roughness, refraction spreads light less than single precision can evaluate: its
// facet is known to 1e-7 / |eta - 1|, which must be small against alpha. Such a lobe is sampled and never evaluated, as
// a delta lobe, and masks nothing: surfaces of index 1 are invisible.
const float kMinRefractionSpread = 2e-4;

bool transmitsDelta(const MetallicRoughness m) {
  return isMirror(m) || (!m.thinWalled && m.alpha * abs(m.eta - 1.0) < kMinRefractionSpread * max(m.eta, 1.0));
}

// Color of what leaves after more than one reflection between facets, for a loss that is white: the geometric series of
// the mean Fresnel reflectance, weighed by what each bounce lets out.
// Source: Kulla and Conty 2017, "Revisiting Physically Based Shading at Imageworks", SIGGRAPH course, slide 18.
// @param kept mean albedo of one reflection, at least 0.4
vec3 multipleReflectance(const vec3 f0, const vec3 f90, const float kept) {
  const vec3 mean = f0 + (f90 - f0) / 21.0; // of Schlick's approximation, cosine weighted
  return mean * mean * (kept / (1.0 - mean * (1.0 - kept)));
}

/// Multiple scattering by facets of glass, as seen from wo.
struct GlassMultiple {
  float lost;        // by one scattering of light from wo
  float meanInFront; // mean of such losses over wo, and of those of light from behind
  float meanBehind;
  float transmitted; // share of the lost light that leaves to the other side
};

/// What the lobes do with light from wo; all that does not depend on wi.
struct BaseShares {
  vec2 albedo; // (A, B) of the facets
  float lost;  // by one reflection of all light
  float meanLost;
  vec3 multiple;      // reflectance of multiple scattering by opaque facets
  float coatMultiple; // the same of the coat alone
  float coat;         // what the coat lets through to the diffuse lobe
  float meanCoat;     // mean over directions
  GlassMultiple glass;
  float facetProbability;  // of choosing a facet in sampleBase,
  float behindProbability; // of choosing the cosine lobe of the other side; the rest: this side's
};

float coatTransmission(const MetallicRoughness m, const vec2 albedo, const float multiple, const float lost) {
  return max(1.0 - (m.dielectricF0 * albedo.x + m.dielectricF90 * albedo.y + multiple * lost), 0.0);
}

// The same in one direction. Schlick's curve follows a film only roughly: no channel of the film itself may reflect
// what the coat lets through.
float coatTransmissionAt(const SceneRef scene, const MetallicRoughness m, const float mu, const vec2 albedo,
                         const float multiple, const float lost) {
  const float passed = coatTransmission(m, coatAlbedo(scene, m, albedo, mu), multiple, lost);
  if (!hasFilm(m)) return passed;
  const vec3 bare = fresnelSchlick(m.glassF0, vec3(m.glassF90), mu);
  return min(passed, 1.0 - largest(mix(bare, filmReflectance(m.film, mu, m.glassF0), m.film.amount)));
}

// No facet reflects nothing at all: an albedo of 0 is that of a scene without facets, whose table is absent.
float lostBetweenFacets(const vec2 albedo) {
  const float kept = albedo.x + albedo.y;
  return kMultipleScattering == 1u && kept > 0.0 ? max(1.0 - kept, 0.0) : 0.0;
}

// Share of the normal reflectance that KHR_materials_specular leaves.
float specularScale(const MetallicRoughness m) {
  const float amplitude = (m.eta - 1.0) / (m.eta + 1.0);
  const float normal = amplitude * amplitude;
  return normal > 0.0 ? min(largest(m.glassF0) / normal, 1.0) : 1.0;
}

// The shares of both sides must be reciprocal, (1 - transmitted) of each times its mean loss and squared index being
// equal, which leaves one factor free: the denser mean of them gets what the mean Fresnel reflectance from outside lets
// through. Its fit for indices in [1, 3] is Kulla and Conty's, slide 20.
GlassMultiple glassMultiple(const SceneRef scene, const MetallicRoughness m, const float muO, const BaseShares shares) {
  const float index = max(m.eta, 1.0 / m.eta);
  const float scale = specularScale(m);
  const float entering = 1.0 - scale * min((index - 1.0) / (4.08567 + 1.00071 * index), 1.0);
  if (m.thinWalled) return GlassMultiple(shares.lost, shares.meanLost, shares.meanLost, entering);
  if (kMultipleScattering == 0u || m.lossInFront == kInvalidIndex || transmitsDelta(m)) {
    return GlassMultiple(0.0, 1.0, 1.0, entering);
  }
  const float inFront = max(glassMeanLoss(scene, m.lossInFront, m.alpha, scale), 1e-6);
  const float behind = max(glassMeanLoss(scene, m.lossBehind, m.alpha, scale), 1e-6);
  const float denser = m.eta * m.eta * behind;
  return GlassMultiple(glassLoss(scene, m.lossInFront, muO, m.alpha, scale), inFront, behind,
                       entering * denser / max(denser, inFront));
}

// How the losses of glass continue at wi, on wo's side or the other.
float glassLossAt(const SceneRef scene, const MetallicRoughness m, const vec3 wi, const bool behind) {
  if (m.thinWalled) return lostBetweenFacets(facetAlbedo(scene, m, wi));
  if (kMultipleScattering == 0u || m.lossInFront == kInvalidIndex || transmitsDelta(m)) return 0.0;
  return glassLoss(scene, behind ? m.lossBehind : m.lossInFront, abs(wi.z), m.alpha, specularScale(m));
}

BaseShares baseShares(const SceneRef scene, const MetallicRoughness m, const vec3 woLocal) {
  const float muO = woLocal.z;
  const vec2 mean = facetMeanAlbedo(scene, m);
  BaseShares shares;
  shares.albedo = facetAlbedo(scene, m, woLocal);
  shares.lost = lostBetweenFacets(shares.albedo);
  shares.meanLost = max(lostBetweenFacets(mean), 1e-6);
  const float kept = 1.0 - shares.meanLost;
  shares.multiple = m.metallic * multipleReflectance(metalReflectance(m, 1.0), vec3(1.0), kept) +
                    m.diffuse * multipleReflectance(m.glassF0, vec3(m.glassF90), kept);
  shares.coatMultiple = multipleReflectance(vec3(m.dielectricF0), vec3(m.dielectricF90), kept).x;
  shares.coat = coatTransmissionAt(scene, m, muO, shares.albedo, shares.coatMultiple, shares.lost);
  const vec2 meanCoat = coatMeanAlbedo(scene, m, mean);
  shares.meanCoat =
      max(coatTransmission(m, meanCoat, shares.coatMultiple, lostBetweenFacets(mean)), kMinCoatTransmission);
  shares.glass = GlassMultiple(0.0, 1.0, 1.0, 0.0);

  float facets = luminance(m.f0 * shares.albedo.x + m.f90 * shares.albedo.y);
  const float below = luminance(m.baseColor) * shares.coat;
  float above = m.diffuse * (1.0 - crossingShare(m.behind)) * below + luminance(shares.multiple) * shares.lost;
  float behind = 0.0;
  if (kHasDiffuseTransmission) {
    behind = m.diffuse * crossingShare(m.behind) * (luminance(m.behind.color) * shares.coat);
  }
  if (kHasTransmission && m.glass > 0.0) {
    shares.glass = glassMultiple(scene, m, muO, shares);
    facets += m.glass * (luminance(m.glassF0 * shares.albedo.x + m.dielectricF90 * shares.albedo.y) + below);
    above += m.glass * (1.0 - shares.glass.transmitted) * shares.glass.lost;
    behind += m.glass * luminance(m.baseColor) * shares.glass.transmitted * shares.glass.lost;
  }
  const float sum = facets + above + behind;
  shares.facetProbability = facets > 0.0 ? facets / sum : 0.0;
  shares.behindProbability = behind > 0.0 ? behind / sum : 0.0;
  return shares;
}

BaseValue noScattering() { return BaseValue(vec3(0.0), vec3(0.0), 0.0); }

// The lobes on wo's side: diffuse, multiple scattering, and the reflection by facets.
BaseValue evaluateReflection(const SceneRef scene, const MetallicRoughness m, const BaseShares shares,
                             const vec3 woLocal, const vec3 wiLocal) {
  const vec2 albedo = facetAlbedo(scene, m, wiLocal);
  const float lost = lostBetweenFacets(albedo);
  const float entering = coatTransmissionAt(scene, m, wiLocal.z, albedo, shares.coatMultiple, lost);
  const float cosine = kInvPi * wiLocal.z;
  BaseValue value;
  const float staying = m.diffuse * (1.0 - crossingShare(m.behind));
  value.diffuse = m.baseColor * (staying * (shares.coat * entering / shares.meanCoat) * cosine);
  value.facets = shares.multiple * (shares.lost * lost / shares.meanLost * cosine);
  if (kHasTransmission && m.glass > 0.0) {
    const GlassMultiple glass = shares.glass;
    const float continued = glass.lost * glassLossAt(scene, m, wiLocal, false) / glass.meanInFront;
    value.diffuse += m.glass * (1.0 - glass.transmitted) * continued * cosine;
  }
  value.pdfSolidAngle = max(1.0 - shares.facetProbability - shares.behindProbability, 0.0) * cosine;
  if (!isMirror(m)) {
    const vec3 sum = woLocal + wiLocal;
    const float twoCosine = length(sum); // 2 dot(wo, wm) of unit directions: the same from both sides to the last bit
    const vec3 wm = sum / twoCosine;
    const vec2 width = m.width;
    const float shape = facetD(wm, width) * facetVisibility(woLocal, wiLocal, width) * wiLocal.z;
    const FacetScattering facet = scatterAtFacet(m, 0.5 * twoCosine);
    value.facets += facet.reflected * shape;
    value.pdfSolidAngle += shares.facetProbability * facet.reflectedShare * pdfVisibleReflection(woLocal, wm, width);
  }
  return value;
}

// Transmission by single facets, wi.z < 0: of thin walls the reflection mirrored to the other side, else refraction.
// The density is that of choosing them with `probability`.
// Source: Walter et al. 2007, eq. 21, for radiance; KHR_materials_transmission.
BaseValue evaluateFacetTransmission(const MetallicRoughness m, const float probability, const vec3 woLocal,
                                    const vec3 wiLocal) {
  const vec2 width = m.width;
  const vec3 above = vec3(wiLocal.xy, -wiLocal.z);
  const float visibility = facetVisibility(woLocal, above, width) * above.z;
  if (m.thinWalled) {
    const vec3 sum = woLocal + above;
    const float twoCosine = length(sum);
    const vec3 wm = sum / twoCosine;
    const FacetScattering facet = scatterAtFacet(m, 0.5 * twoCosine);
    return BaseValue(facet.transmitted * (facetD(wm, width) * visibility), vec3(0.0),
                     probability * (1.0 - facet.reflectedShare) * pdfVisibleReflection(woLocal, wm, width));
  }
  const RefractingFacet refracting = refractingFacet(woLocal, wiLocal, m.eta);
  if (!refracting.valid) return noScattering();
  const FacetScattering facet = scatterAtFacet(m, refracting.cosO);
  const float shape = 4.0 * facetD(refracting.wm, width) * visibility * refracting.cosO * refracting.jacobian;
  const float density = pdfVisibleNormal(woLocal, refracting.wm, width) * m.eta * m.eta * refracting.jacobian;
  return BaseValue(facet.transmitted * shape, vec3(0.0), probability * (1.0 - facet.reflectedShare) * density);
}

// Index behind over in front, of directions.
float refractedEta(const MetallicRoughness m) { return m.thinWalled ? 1.0 : m.eta; }

// The same of the cosine lobe on the other side; of glass both are equal.
float broadEta(const MetallicRoughness m) {
  return kHasDiffuseTransmission && m.behind.share > 0.0 ? m.behind.eta : refractedEta(m);
}

// The lobes on the other side.
BaseValue evaluateTransmission(const SceneRef scene, const MetallicRoughness m, const BaseShares shares,
                               const vec3 woLocal, const vec3 wiLocal) {
  BaseValue value = noScattering();
  const float cosine = -kInvPi * wiLocal.z;
  if (kHasTransmission && m.glass > 0.0 && !transmitsDelta(m)) {
    value = evaluateFacetTransmission(m, shares.facetProbability, woLocal, wiLocal);
    const GlassMultiple glass = shares.glass;
    const float eta = refractedEta(m);
    const float continued = glass.lost * glassLossAt(scene, m, wiLocal, true) / (glass.meanBehind * eta * eta);
    value.diffuse = m.baseColor * (m.glass * glass.transmitted * continued * cosine);
  }
  if (kHasDiffuseTransmission && m.behind.share > 0.0) { // both faces are coated alike
    const vec2 albedo = facetAlbedo(scene, m, wiLocal);
    const float leaving =
        coatTransmissionAt(scene, m, -wiLocal.z, albedo, shares.coatMultiple, lostBetweenFacets(albedo));
    value.diffuse += crossingReflectance(m.behind) * (m.diffuse * (shares.coat * leaving / shares.meanCoat) * cosine);
  }
  value.pdfSolidAngle += shares.behindProbability * cosine;
  return value;
}

// Of Lambert lobes alone: the probability of sampling the one on the other side.
float lambertBehindProbability(const MetallicRoughness m) {
  const float behind = m.diffuse * crossingShare(m.behind) * luminance(m.behind.color);
  const float above = m.diffuse * (1.0 - crossingShare(m.behind)) * luminance(m.baseColor);
  return behind > 0.0 ? behind / (above + behind) : 0.0;
}

/// Returns f |cos wi| and the sampling density of the continuous lobes of both sides; zeros where wo is below the
/// surface.
BaseValue evaluateBase(const SceneRef scene, const MetallicRoughness m, const vec3 woLocal, const vec3 wiLocal) {
  const bool transmitted = kHasFarSide && wiLocal.z < 0.0;
  if (min(woLocal.z, transmitted ? -wiLocal.z : wiLocal.z) < kMinCosine) return noScattering();
  if (kHasSpecular) {
    const BaseShares shares = baseShares(scene, m, woLocal);
    if (transmitted) return evaluateTransmission(scene, m, shares, woLocal, wiLocal);
    return evaluateReflection(scene, m, shares, woLocal, wiLocal);
  }
  if (!kHasDiffuseTransmission) {
    const float density = kInvPi * wiLocal.z;
    return BaseValue(vec3(0.0), m.baseColor * (m.diffuse * density), density);
  }
  const float density = kInvPi * abs(wiLocal.z);
  const float behind = lambertBehindProbability(m);
  if (transmitted) {
    return BaseValue(vec3(0.0), crossingReflectance(m.behind) * (m.diffuse * density), behind * density);
  }
  const float staying = m.diffuse * (1.0 - crossingShare(m.behind));
  return BaseValue(vec3(0.0), m.baseColor * (staying * density), (1.0 - behind) * density);
}

BsdfSample absorbed() { return BsdfSample(vec3(0.0, 0.0, 1.0), vec3(0.0), 0.0, false, false, 1.0); }

BsdfSample finishSample(const vec3 wiLocal, const BaseValue value, const float eta) {
  const vec3 weight = value.pdfSolidAngle > 0.0 ? (value.facets + value.diffuse) / value.pdfSolidAngle : vec3(0.0);
  return BsdfSample(wiLocal, weight, value.pdfSolidAngle, false, largest(weight) > 0.0, eta);
}

// A direction to the other side through a facet of normal wm, where transmission was chosen.
BsdfSample sampleFacetTransmission(const SceneRef scene, const MetallicRoughness m, const BaseShares shares,
                                   const FacetScattering facet, const vec3 woLocal, const vec3 wm, const float cosine) {
  const float eta = refractedEta(m);
  if (transmitsDelta(m)) {
    const vec3 wi = m.thinWalled ? -woLocal : refractAbout(woLocal, wm, cosine, m.eta);
    const float probability = shares.facetProbability * (1.0 - facet.reflectedShare);
    const vec3 weight = facet.transmitted / (probability * eta * eta);
    return BsdfSample(wi, weight, 0.0, true, wi.z < -kMinCosine && largest(weight) > 0.0, eta);
  }
  vec3 wi;
  if (m.thinWalled) {
    wi = normalize(2.0 * cosine * wm - woLocal);
    wi.z = -wi.z;
  } else {
    wi = refractAbout(woLocal, wm, cosine, m.eta);
  }
  if (wi.z > -kMinCosine) return absorbed();
  return finishSample(wi, evaluateTransmission(scene, m, shares, woLocal, wi), eta);
}

/// Samples a direction of scattering: the cosine lobe of either side or a visible facet by their shares of the albedo,
/// at the facet reflection or transmission, weighed over all lobes.
///
/// @param uLobe in [0, 1), chooses the lobe
/// @param u     in [0, 1)^2
BsdfSample sampleBase(const SceneRef scene, const MetallicRoughness m, const vec3 woLocal, float uLobe, const vec2 u) {
  if (woLocal.z < kMinCosine) return absorbed();
  if (!kHasSpecular) {
    vec3 wi = sampleCosineHemisphere(u);
    const bool crosses = kHasDiffuseTransmission && uLobe < lambertBehindProbability(m);
    if (crosses) wi.z = -wi.z;
    return finishSample(wi, evaluateBase(scene, m, woLocal, wi), crosses ? m.behind.eta : 1.0);
  }
  const BaseShares shares = baseShares(scene, m, woLocal);
  vec3 wi;
  if (uLobe >= shares.facetProbability) {
    wi = sampleCosineHemisphere(u);
    if (kHasFarSide && uLobe < shares.facetProbability + shares.behindProbability) {
      wi.z = -wi.z;
      return finishSample(wi, evaluateTransmission(scene, m, shares, woLocal, wi), broadEta(m));
    }
  } else {
    vec3 wm = vec3(0.0, 0.0, 1.0);
    if (!isMirror(m)) wm = sampleVisibleNormal(woLocal, m.width, u, shares.facetProbability, uLobe);
    const float cosine = dot(woLocal, wm);
    const FacetScattering facet = scatterAtFacet(m, cosine);
    if (kHasTransmission && uLobe >= shares.facetProbability * facet.reflectedShare) {
      return sampleFacetTransmission(scene, m, shares, facet, woLocal, wm, cosine);
    }
    if (isMirror(m)) {
      const vec3 weight = facet.reflected / (shares.facetProbability * facet.reflectedShare);
      return BsdfSample(vec3(-woLocal.xy, woLocal.z), weight, 0.0, true, true, 1.0);
    }
    wi = normalize(2.0 * cosine * wm - woLocal);
  }
  if (wi.z < kMinCosine) return absorbed();
  return finishSample(wi, evaluateReflection(scene, m, shares, woLocal, wi), 1.0);
}

#endif
