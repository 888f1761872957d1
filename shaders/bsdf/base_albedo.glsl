// What the base's facets and its coat keep of light from one direction, and on the average. Formulas: docs/bsdf.md.
#ifndef ISOPHOTE_BSDF_BASE_ALBEDO_GLSL
#define ISOPHOTE_BSDF_BASE_ALBEDO_GLSL

#include "bsdf/anisotropic_albedo.glsl"
#include "bsdf/facet_albedo.glsl"
#include "bsdf/facet_reflectance.glsl"
#include "bsdf/film_albedo.glsl"
#include "shared/buffers.glsl"
#include "shared/constants.glsl"

bool isMirror(const MetallicRoughness m) { return kHasMirror && m.alpha < kMirrorAlpha; }

// Table alpha: a mirror's albedo is the limit alpha = 0.
float albedoAlpha(const MetallicRoughness m) { return isMirror(m) ? 0.0 : m.alpha; }

/// Returns (A, B) of the facets for light leaving along w, |w.z| the cosine.
vec2 facetAlbedo(const SceneRef scene, const MetallicRoughness m, const vec3 w) {
  if (kHasAnisotropy && m.anisotropicAlbedo != kInvalidIndex) {
    const TableCell cell = anisotropicCell(scene, m.anisotropicAlbedo, m.grain);
    return anisotropicAlbedo(scene, cell, m.width, vec3(w.xy, abs(w.z)));
  }
  return isotropicAlbedo(scene, 0u, abs(w.z), albedoAlpha(m));
}

/// Returns the cosine-weighted mean of facetAlbedo.
vec2 facetMeanAlbedo(const SceneRef scene, const MetallicRoughness m) {
  if (kHasAnisotropy && m.anisotropicAlbedo != kInvalidIndex) {
    return anisotropicMeanAlbedo(scene, anisotropicCell(scene, m.anisotropicAlbedo, m.grain));
  }
  return isotropicMeanAlbedo(scene, 0u, albedoAlpha(m));
}

TableCell coatFilmCell(const SceneRef scene, const MetallicRoughness m) {
  return filmCell(scene, m.filmAlbedo, vec2(m.film.thickness, sqrt(albedoAlpha(m))));
}

/// What single reflections by the coat over the diffuse lobe reflect of light at cosine mu; of a film by channel, else
/// alike in all.
/// @param albedo of the facets, as facetAlbedo has it
vec3 coatReflected(const SceneRef scene, const MetallicRoughness m, vec2 albedo, const float mu) {
  if (reflectsExactly(m) && m.exactAlbedo != 0u) { // the same sum, parted as the exact reflectance parts it
    const float grazing = isotropicAlbedo(scene, m.exactAlbedo, mu, albedoAlpha(m)).y;
    albedo = vec2(albedo.x + albedo.y - grazing, grazing);
  }
  const vec3 bare = vec3(m.dielectricF0 * albedo.x + m.dielectricF90 * albedo.y);
  return hasFilmAlbedo(m) ? mix(bare, filmAlbedo(scene, coatFilmCell(scene, m), mu), m.film.amount) : bare;
}

/// Returns the cosine-weighted mean of coatReflected.
/// @param mean facetMeanAlbedo
vec3 coatMeanReflected(const SceneRef scene, const MetallicRoughness m, vec2 mean) {
  if (reflectsExactly(m) && m.exactAlbedo != 0u) {
    const float grazing = isotropicMeanAlbedo(scene, m.exactAlbedo, albedoAlpha(m)).y;
    mean = vec2(mean.x + mean.y - grazing, grazing);
  }
  const vec3 bare = vec3(m.dielectricF0 * mean.x + m.dielectricF90 * mean.y);
  return hasFilmAlbedo(m) ? mix(bare, filmMeanAlbedo(scene, coatFilmCell(scene, m)), m.film.amount) : bare;
}

// Color of what leaves after more than one reflection between facets, for a loss that is white: the geometric series of
// the mean Fresnel reflectance, weighed by what each bounce lets out.
// Source: Kulla and Conty 2017, "Revisiting Physically Based Shading at Imageworks", SIGGRAPH course, slide 18.
// @param kept mean albedo of one reflection, at least 0.4
vec3 multipleReflectance(const vec3 f0, const vec3 f90, const float kept) {
  const vec3 mean = f0 + (f90 - f0) / 21.0; // of Schlick's approximation, cosine weighted
  return mean * mean * (kept / (1.0 - mean * (1.0 - kept)));
}

// What the coat passes in one direction. Schlick's curve follows a film only roughly: where that stands for it, no
// channel of the film itself may reflect what the coat lets through.
vec3 coatTransmissionAt(const SceneRef scene, const MetallicRoughness m, const float mu, const vec2 albedo,
                        const float multiple, const float lost) {
  const vec3 passed = max(1.0 - (coatReflected(scene, m, albedo, mu) + multiple * lost), vec3(0.0));
  if (!hasFilm(m) || hasFilmAlbedo(m)) return passed;
  const vec3 bare = fresnelSchlick(m.glassF0, vec3(m.glassF90), mu);
  return min(passed, 1.0 - largest(mix(bare, filmReflectance(m.film, mu, m.glassF0), m.film.amount)));
}

// No facet reflects nothing at all: an albedo of 0 is that of a scene without facets, whose table is absent.
float lostBetweenFacets(const vec2 albedo) {
  const float kept = albedo.x + albedo.y;
  return kMultipleScattering == 1u && kept > 0.0 ? max(1.0 - kept, 0.0) : 0.0;
}

#endif
