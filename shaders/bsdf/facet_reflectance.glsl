// What one facet of the base reflects and transmits. Formulas: docs/bsdf.md, docs/bsdf-layers.md.
#ifndef ISOPHOTE_BSDF_FACET_REFLECTANCE_GLSL
#define ISOPHOTE_BSDF_FACET_REFLECTANCE_GLSL

#include "bsdf/fresnel.glsl"
#include "bsdf/iridescence.glsl"
#include "bsdf/metallic_roughness.glsl"
#include "math/constants.glsl"
#include "shared/constants.glsl"

float largest(const vec3 v) { return max(v.x, max(v.y, v.z)); }

float luminance(const vec3 color) { return dot(color, vec3(0.2126, 0.7152, 0.0722)); } // of Rec.709 primaries

bool isConductor(const MetallicRoughness m) { return kHasConductor && m.conductorN.x > 0.0; }

bool hasFilm(const MetallicRoughness m) { return kHasIridescence && m.film.amount > 0.0; }

bool hasFilmAlbedo(const MetallicRoughness m) { return hasFilm(m) && m.filmAlbedo != kInvalidIndex; }

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

/// Puts a thin film on the facets. Without a table of what they then reflect, the coat over the diffuse lobe is taken
/// for the brightest that interference can make it, so that no color gains energy.
/// @param table of the albedo, or kInvalidIndex
void setIridescence(inout MetallicRoughness m, const Iridescence film, const uint table) {
  if (film.amount <= 0.0) return;
  m.film = film;
  m.filmAlbedo = table;
  if (table == kInvalidIndex) {
    m.dielectricF0 = mix(m.dielectricF0, max(m.dielectricF0, filmBound(film, m.glassF0)), film.amount);
    m.dielectricF90 = mix(m.dielectricF90, 1.0, film.amount);
  }
  m.f90 = mix(m.f90, vec3(m.diffuse + m.metallic), film.amount);
  m.f0 = facetReflectance(m, 1.0);
}

/// Returns the reflectance of a facet of glass without a film: fresnelDielectric, or the setting's, scaled as
/// KHR_materials_specular scales Schlick's approximation, f0 + (f90 - f0) x with x the share of the way from normal to
/// grazing reflectance. Total internal reflection is total whatever the scale.
vec3 glassReflectance(const MetallicRoughness m, const float cosine) {
  const float reflectance =
      kFresnel == kFresnelSchlick ? schlickDielectric(cosine, m.eta) : fresnelDielectric(cosine, m.eta);
  if (reflectance >= 1.0) return vec3(1.0);
  const float share = grazingShare(reflectance, m.eta);
  return max(m.glassF0 + (vec3(m.glassF90) - m.glassF0) * share, vec3(0.0)); // f0 may be less than eta's
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
  vec3 reflectance = glassReflectance(m, cosine);
  vec3 passed = vec3(1.0 - largest(reflectance)); // of no color, but for a film: the rest of what that reflects
  if (hasFilm(m)) {
    const float sin2Outside = (1.0 - cosine * cosine) / min(m.eta * m.eta, 1.0); // from inside, by Snell's law
    const vec3 film = filmReflectance(m.film, sqrt(max(1.0 - sin2Outside, 0.0)), m.glassF0);
    reflectance = mix(reflectance, film, m.film.amount);
    passed = mix(passed, 1.0 - film, m.film.amount);
  }
  facet.reflected += m.glass * reflectance;
  facet.transmitted = m.glass * passed * m.baseColor;
  const float reflected = luminance(facet.reflected);
  const float sum = reflected + luminance(facet.transmitted);
  facet.reflectedShare = sum > 0.0 ? reflected / sum : 1.0;
  return facet;
}

#endif
