#include "oracle/bsdf_metallic_roughness.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <mutex>
#include <numbers>
#include <vector>

#include "oracle/bsdf_fresnel.hpp"
#include "oracle/bsdf_ggx.hpp"
#include "oracle/glass_loss.hpp"
#include "shared/bsdf_constants.h"

namespace isophote::oracle {
namespace {

using std::numbers::pi;

double luminance(const glm::dvec3& color) { return glm::dot(color, glm::dvec3(0.2126, 0.7152, 0.0722)); }

bool isMirror(const MetallicRoughness& m) { return m.alpha < double(gpu::kMirrorAlpha); }

// GGX integrals of the lobe that is really there: a mirror's where alpha is below the limit.
double modelAlpha(const MetallicRoughness& m) { return isMirror(m) ? 0 : m.alpha; }

// (A, B) of the facets for light leaving along w.
glm::dvec2 albedoAt(const MetallicRoughness& m, const glm::dvec3& w) {
  if (m.brushedAlbedo && m.width.x != m.width.y) return anisotropicAlbedo(w, m.width);
  return directionalAlbedo(std::abs(w.z), modelAlpha(m));
}

glm::dvec2 albedoMean(const MetallicRoughness& m) {
  if (m.brushedAlbedo && m.width.x != m.width.y) return anisotropicMeanAlbedo(m.width);
  return meanAlbedo(modelAlpha(m));
}

double lost(const MetallicRoughness& m, const glm::dvec2& albedo) {
  return m.multipleScattering ? 1 - albedo.x - albedo.y : 0;
}

// Reflectance of multiple scattering between opaque facets. Source: Kulla and Conty 2017, "Revisiting Physically Based
// Shading at Imageworks".
glm::dvec3 multipleReflectance(const MetallicRoughness& m, const glm::dvec3& f0, const glm::dvec3& f90) {
  const glm::dvec3 fresnel = f0 + (f90 - f0) / 21.0;
  const glm::dvec2 mean = albedoMean(m);
  const double kept = mean.x + mean.y;
  return fresnel * fresnel * kept / (1.0 - fresnel * (1 - kept));
}

// Albedo of isotropic facets that the film covers, one reflection: normals of density G1 D |dot| / cos are weighed by
// G2 / G1 (Heitz 2014).
glm::dvec3 integrateFilm(const MetallicRoughness& m, double mu) {
  if (isMirror(m)) return filmReflectance(m.film, mu, m.glassF0);
  const glm::dvec3 wo(std::sqrt(1 - mu * mu), 0, mu);
  const int side = 40;
  glm::dvec3 sum(0);
  for (int i = 0; i < side * side; ++i) {
    const double t = (i / side + 0.5) / side; // normals crowd at the cap's rim
    const glm::dvec3 wm =
        sampleVisibleNormal(wo, glm::dvec2(m.alpha), {1 - t * t, 0.25 + 0.5 * (i % side + 0.5) / side});
    const glm::dvec3 wi = 2 * glm::dot(wo, wm) * wm - wo;
    if (wi.z <= 0) continue;
    const double weight = ggxG2(wo, wi, glm::dvec2(m.alpha)) / ggxG1(wo, glm::dvec2(m.alpha));
    sum += 2 * t * weight / (side * side) * filmReflectance(m.film, std::min(glm::dot(wo, wm), 1.0), m.glassF0);
  }
  return sum;
}

// The same between 129 nodes of sqrt(mu), kept for each film.
glm::dvec3 filmAlbedo(const MetallicRoughness& m, double mu) {
  constexpr int kNodes = 129;
  static std::mutex mutex;
  static std::map<std::array<double, 6>, std::vector<glm::dvec3>> known;
  const std::lock_guard lock(mutex);
  auto& nodes = known[{m.film.ior, m.film.thickness, m.alpha, m.glassF0.x, m.glassF0.y, m.glassF0.z}];
  for (int i = static_cast<int>(nodes.size()); i < kNodes; ++i)
    nodes.push_back(integrateFilm(m, std::max(std::pow(i / (kNodes - 1.0), 2), 1e-9)));
  const double position = std::sqrt(mu) * (kNodes - 1);
  const auto low = std::min(static_cast<size_t>(position), size_t(kNodes - 2));
  return glm::mix(nodes[low], nodes[low + 1], position - double(low));
}

// A film's table is of isotropic facets; else it is bounded.
bool isBounded(const MetallicRoughness& m) { return m.film.amount > 0 && m.width.x != m.width.y; }

// What the coat passes in one direction; of a bounded film no more than its brightest channel leaves.
glm::dvec3 coatTransmission(const MetallicRoughness& m, const glm::dvec3& w) {
  const double mu = std::abs(w.z);
  glm::dvec2 albedo = albedoAt(m, w);
  const glm::dvec3 single =
      isBounded(m) ? glm::dvec3(m.dielectricF0 * albedo.x + m.dielectricF90 * albedo.y) : coatReflected(m, mu);
  const glm::dvec3 passed = 1.0 - single - coatMultipleReflectance(m) * lost(m, albedo);
  if (!isBounded(m)) return passed;
  const glm::dvec3 reflected = glm::mix(fresnelSchlick(m.glassF0, glm::dvec3(m.glassF90), mu),
                                        filmReflectance(m.film, mu, m.glassF0), m.film.amount);
  return glm::min(passed, glm::dvec3(1 - std::max({reflected.x, reflected.y, reflected.z})));
}

glm::dvec3 metalReflectance(const MetallicRoughness& m, double cosine) {
  if (m.conductorN.x == 0) return fresnelSchlick(m.baseColor, glm::dvec3(1), cosine);
  return {fresnelConductor(cosine, m.conductorN.x, m.conductorK.x),
          fresnelConductor(cosine, m.conductorN.y, m.conductorK.y),
          fresnelConductor(cosine, m.conductorN.z, m.conductorK.z)};
}

double glassShare(const MetallicRoughness& m) { return m.transmission * (1 - m.metallic); }

// Share of the diffuse light from wo's side that crosses, and the factor by which radiance from the other side is seen:
// of the light from there the share (n_o / n_i)^2 / max(1, (n_o / n_i)^2) of m.diffuseTransmission crosses.
double diffuselyCrossing(const MetallicRoughness& m) {
  return m.diffuseEta >= 1 ? m.diffuseTransmission : m.diffuseTransmission * m.diffuseEta * m.diffuseEta;
}

double diffuselySeenThrough(const MetallicRoughness& m) {
  return m.diffuseEta <= 1 ? m.diffuseTransmission : m.diffuseTransmission / (m.diffuseEta * m.diffuseEta);
}

glm::dvec3 diffuse(const MetallicRoughness& m, const glm::dvec3& wo, const glm::dvec3& wi) {
  const bool behind = wi.z < 0;
  const glm::dvec3 transmittedO = coatTransmission(m, wo);
  const glm::dvec3 transmittedI = coatTransmission(m, wi);
  const glm::dvec3 mean = meanCoatTransmission(m);
  const glm::dvec3 color =
      behind ? m.diffuseTransmissionColor * diffuselySeenThrough(m) : m.baseColor * (1 - diffuselyCrossing(m));
  return color * ((1 - m.metallic) * (1 - m.transmission) / pi * transmittedO * transmittedI / mean);
}

glm::dvec3 opaqueMultiple(const MetallicRoughness& m) {
  return m.metallic * multipleReflectance(m, metalReflectance(m, 1), glm::dvec3(1)) +
         (1 - m.metallic) * (1 - m.transmission) * multipleReflectance(m, m.glassF0, glm::dvec3(m.glassF90));
}

// Multiple scattering by glass: what light at cosine mu in front of, or behind, the surface loses; means; and the share
// of light from wo's side that is sent to the other.
struct GlassMultiple {
  double lossInFront = 0, meanInFront = 1, meanBehind = 1, transmitted = 0;
};

double glassLossAt(const MetallicRoughness& m, const glm::dvec3& w, bool behind) {
  if (!m.multipleScattering) return 0;
  if (m.thinWalled) return lost(m, albedoAt(m, w));
  if (transmitsDelta(m)) return 0;
  const double normal = fresnelDielectric(1, m.innerIor / m.outerIor);
  const double scale = std::min(1.0, std::max({m.glassF0.x, m.glassF0.y, m.glassF0.z}) / normal);
  return glassLoss(std::abs(w.z), m.alpha, behind ? m.outerIor / m.innerIor : m.innerIor / m.outerIor, scale);
}

GlassMultiple glassMultiple(const MetallicRoughness& m, const glm::dvec3& wo) {
  GlassMultiple result;
  result.lossInFront = glassLossAt(m, wo, false);
  if (result.lossInFront == 0) return result;
  const double normal = fresnelDielectric(1, m.innerIor / m.outerIor);
  const double scale = std::min(1.0, std::max({m.glassF0.x, m.glassF0.y, m.glassF0.z}) / normal);
  const double index = std::max(m.innerIor / m.outerIor, m.outerIor / m.innerIor);
  const double entering = 1 - scale * std::min(1.0, (index - 1) / (4.08567 + 1.00071 * index));
  if (m.thinWalled) {
    result.meanInFront = result.meanBehind = lost(m, albedoMean(m));
    result.transmitted = entering;
    return result;
  }
  result.meanInFront = glassMeanLoss(m.alpha, m.innerIor / m.outerIor, scale);
  result.meanBehind = glassMeanLoss(m.alpha, m.outerIor / m.innerIor, scale);
  const double inFront = m.outerIor * m.outerIor * result.meanInFront;
  const double behind = m.innerIor * m.innerIor * result.meanBehind;
  result.transmitted = entering * behind / std::max(behind, inFront); // reciprocal
  return result;
}

// Probabilities of the facets and of the cosine lobe of the other side; the rest is this side's cosine lobe.
struct Choice {
  double facets = 0, behind = 0;
};

Choice lobeChoice(const MetallicRoughness& m, const glm::dvec3& wo) {
  const glm::dvec2 albedo = albedoAt(m, wo);
  const GlassMultiple glass = glassMultiple(m, wo);
  const double passed = coatTransmission(m, wo).y; // green for all channels
  const double below = luminance(m.baseColor) * passed;
  const double facets = luminance(m.f0 * albedo.x + m.f90 * albedo.y) +
                        glassShare(m) * (luminance(m.glassF0 * albedo.x + m.dielectricF90 * albedo.y) + below);
  const double diffuseShare = (1 - m.metallic) * (1 - m.transmission);
  const double above = diffuseShare * (1 - diffuselyCrossing(m)) * below +
                       luminance(opaqueMultiple(m)) * lost(m, albedo) +
                       glassShare(m) * (1 - glass.transmitted) * glass.lossInFront;
  const double behind = glassShare(m) * luminance(m.baseColor) * glass.transmitted * glass.lossInFront +
                        diffuseShare * diffuselyCrossing(m) * luminance(m.diffuseTransmissionColor) * passed;
  const double sum = facets + above + behind;
  return sum > 0 ? Choice{facets / sum, behind / sum} : Choice{};
}

// The lobe of scattering between opaque facets, without the cosine.
glm::dvec3 opaqueMultipleLobe(const MetallicRoughness& m, const glm::dvec3& wo, const glm::dvec3& wi) {
  if (isMirror(m)) return glm::dvec3(0);
  const double both = lost(m, albedoAt(m, wo)) * lost(m, albedoAt(m, wi));
  return both > 0 ? opaqueMultiple(m) * (both / (pi * lost(m, albedoMean(m)))) : glm::dvec3(0);
}

// The lobes of scattering between facets of glass, without the cosine; of both sides.
glm::dvec3 glassMultipleLobe(const MetallicRoughness& m, const glm::dvec3& wo, const glm::dvec3& wi) {
  const bool behind = wi.z < 0;
  const GlassMultiple glass = glassMultiple(m, wo);
  if (glassShare(m) == 0 || glass.lossInFront == 0) return glm::dvec3(0);
  const double both = glass.lossInFront * glassLossAt(m, wi, behind);
  if (!behind) return glm::dvec3(glassShare(m) * (1 - glass.transmitted) * both / (pi * glass.meanInFront));
  const double toOuter = m.thinWalled ? 1 : m.outerIor * m.outerIor / (m.innerIor * m.innerIor); // of radiance
  return glassShare(m) * m.baseColor * glass.transmitted * both / (pi * glass.meanBehind) * toOuter;
}

glm::dvec3 reflectedAtFacet(const MetallicRoughness& m, double cosine) {
  return facetReflectance(m, cosine) + glassShare(m) * glassReflectance(m, cosine);
}

glm::dvec3 bareGlassReflectance(const MetallicRoughness& m, double cosine) {
  const double exact = fresnelDielectric(cosine, m.innerIor / m.outerIor);
  if (exact >= 1) return glm::dvec3(1); // total internal reflection, or grazing
  const double normal = fresnelDielectric(1, m.innerIor / m.outerIor);
  return glm::max(glm::mix(m.glassF0, glm::dvec3(m.glassF90), (exact - normal) / (1 - normal)), 0.0);
}

glm::dvec3 glassFilm(const MetallicRoughness& m, double cosine) {
  const double sineOutside = std::sqrt(1 - cosine * cosine) * std::max(m.outerIor, 1.0); // Snell's law
  return filmReflectance(m.film, std::sqrt(std::max(0.0, 1 - sineOutside * sineOutside)), m.glassF0);
}

// The rest of what glass reflects: of its brightest channel, of a film channel by channel.
glm::dvec3 transmittedAtFacet(const MetallicRoughness& m, double cosine) {
  const glm::dvec3 bare = bareGlassReflectance(m, cosine);
  glm::dvec3 passed(1 - std::max({bare.x, bare.y, bare.z}));
  if (m.film.amount > 0) passed = glm::mix(passed, 1.0 - glassFilm(m, cosine), m.film.amount);
  return glassShare(m) * passed * m.baseColor;
}

double reflectionShare(const MetallicRoughness& m, double cosine) {
  const double reflected = luminance(reflectedAtFacet(m, cosine));
  const double transmitted = luminance(transmittedAtFacet(m, cosine));
  return reflected + transmitted > 0 ? reflected / (reflected + transmitted) : 1;
}

glm::dvec3 mirroredDown(const glm::dvec3& w) { return {w.x, w.y, -w.z}; }

// What facets transmit, with its density, for wi.z < 0. Source: Walter et al. 2007, "Microfacet Models for Refraction
// through Rough Surfaces", eq. 16, 17 and 21, where light comes from wi and leaves along wo.
struct Transmitted {
  glm::dvec3 f{0};
  double pdf = 0; // of choosing facets and transmission at them
};

Transmitted transmittedByFacets(const MetallicRoughness& m, const glm::dvec3& wo, const glm::dvec3& wi) {
  const glm::dvec2 alpha(m.width);
  if (m.thinWalled) {
    const glm::dvec3 above = mirroredDown(wi);
    const glm::dvec3 wm = glm::normalize(wo + above);
    const double cosine = glm::dot(wo, wm);
    return {transmittedAtFacet(m, cosine) * ggxD(wm, alpha) * ggxG2(wo, above, alpha) / (4 * wo.z * above.z),
            (1 - reflectionShare(m, cosine)) * pdfVisibleNormal(wo, wm, alpha) / (4 * cosine)};
  }
  glm::dvec3 wm = -glm::normalize(m.outerIor * wo + m.innerIor * wi);
  if (wm.z < 0) wm = -wm;
  const double cosineO = glm::dot(wo, wm), cosineI = glm::dot(wi, wm);
  if (cosineO <= 0 || cosineI >= 0) return {};
  const double root = m.innerIor * cosineI + m.outerIor * cosineO;
  const double jacobian = m.innerIor * m.innerIor * std::abs(cosineI) / (root * root);
  const double toOuter = m.outerIor * m.outerIor / (m.innerIor * m.innerIor); // of radiance
  return {transmittedAtFacet(m, cosineO) * std::abs(cosineO / (wo.z * wi.z)) * ggxD(wm, alpha) *
              ggxG2(wo, mirroredDown(wi), alpha) * jacobian * toOuter,
          (1 - reflectionShare(m, cosineO)) * pdfVisibleNormal(wo, wm, alpha) * jacobian};
}

BsdfSample sampleTransmission(const MetallicRoughness& m, const glm::dvec3& wo, const glm::dvec3& wm,
                              double probability) {
  BsdfSample result;
  const double cosine = glm::dot(wo, wm);
  if (m.thinWalled) {
    result.wiLocal = mirroredDown(2 * cosine * wm - wo);
  } else {
    const double ratio = m.outerIor / m.innerIor; // Snell's law
    result.eta = 1 / ratio;
    const double cosineT = std::sqrt(std::max(0.0, 1 - ratio * ratio * (1 - cosine * cosine)));
    result.wiLocal = glm::normalize(-ratio * wo + (ratio * cosine - cosineT) * wm);
  }
  if (result.wiLocal.z >= 0) return {};
  if (transmitsDelta(m)) {
    result.delta = true;
    result.weight =
        transmittedAtFacet(m, cosine) / (probability * (1 - reflectionShare(m, cosine))) / (result.eta * result.eta);
  } else {
    result.pdfSolidAngle = pdfBsdf(m, wo, result.wiLocal);
    if (result.pdfSolidAngle <= 0) return {};
    result.weight = evalBsdf(m, wo, result.wiLocal) / result.pdfSolidAngle;
  }
  result.valid = true;
  return result;
}

} // namespace

MetallicRoughness metallicRoughness(const glm::dvec3& baseColor, double metallic, double roughness, double ior,
                                    double specular, const glm::dvec3& specularColor) {
  const double normalIncidence = std::pow((ior - 1) / (ior + 1), 2);
  const glm::dvec3 dielectricF0 = glm::min(normalIncidence * specularColor, glm::dvec3(1)) * specular;
  return {.baseColor = baseColor,
          .metallic = metallic,
          .alpha = roughness * roughness,
          .width = glm::dvec2(roughness * roughness),
          .f0 = glm::mix(dielectricF0, baseColor, metallic),
          .f90 = glm::dvec3(std::lerp(specular, 1.0, metallic)),
          .dielectricF0 = std::max({dielectricF0.x, dielectricF0.y, dielectricF0.z}),
          .dielectricF90 = specular,
          .glassF0 = dielectricF0,
          .glassF90 = specular};
}

MetallicRoughness withTransmission(MetallicRoughness m, double transmission, double ior, bool frontFace,
                                   bool thinWalled) {
  m.transmission = transmission;
  m.outerIor = frontFace || thinWalled ? 1 : ior;
  m.innerIor = frontFace || thinWalled ? ior : 1;
  m.thinWalled = thinWalled;
  m.f0 = glm::mix((1 - transmission) * m.glassF0, m.baseColor, m.metallic);
  m.f90 = glm::dvec3(std::lerp((1 - transmission) * m.glassF90, 1.0, m.metallic));
  return m;
}

glm::dvec3 glassReflectance(const MetallicRoughness& m, double cosine) {
  const glm::dvec3 bare = bareGlassReflectance(m, cosine);
  return m.film.amount == 0 ? bare : glm::mix(bare, glassFilm(m, cosine), m.film.amount);
}

MetallicRoughness withDiffuseTransmission(MetallicRoughness m, double share, const glm::dvec3& color, double eta) {
  m.diffuseTransmission = share;
  m.diffuseTransmissionColor = color;
  m.diffuseEta = eta;
  return m;
}

MetallicRoughness withAnisotropy(MetallicRoughness m, double strength) {
  const double wide = std::lerp(m.alpha, 1.0, strength * strength);
  const double limit = double(gpu::kNarrowestAlpha);
  if (strength == 0 || wide < limit) return m;
  m.width = {wide, std::max(m.alpha, limit)};
  m.alpha = std::sqrt(m.width.x * m.width.y);
  return m;
}

MetallicRoughness withConductor(MetallicRoughness m, const glm::dvec3& n, const glm::dvec3& k) {
  m.conductorN = n;
  m.conductorK = k;
  m.f0 = facetReflectance(m, 1);
  return m;
}

MetallicRoughness withFilm(MetallicRoughness m, const ThinFilm& film) {
  m.film = film;
  if (isBounded(m)) {
    m.dielectricF0 = std::lerp(m.dielectricF0, std::max(m.dielectricF0, filmBound(film, m.glassF0)), film.amount);
    m.dielectricF90 = std::lerp(m.dielectricF90, 1.0, film.amount);
  }
  m.f90 = glm::mix(m.f90, glm::dvec3(m.metallic + (1 - m.metallic) * (1 - m.transmission)), film.amount);
  m.f0 = facetReflectance(m, 1);
  return m;
}

glm::dvec3 facetReflectance(const MetallicRoughness& m, double cosine) {
  if (m.film.amount == 0 && m.conductorN.x == 0) return fresnelSchlick(m.f0, m.f90, cosine);
  const glm::dvec3 metal =
      glm::mix(metalReflectance(m, cosine), filmReflectance(m.film, cosine, metalReflectance(m, 1)), m.film.amount);
  const glm::dvec3 dielectric = glm::mix(fresnelSchlick(m.glassF0, glm::dvec3(m.glassF90), cosine),
                                         filmReflectance(m.film, cosine, m.glassF0), m.film.amount);
  return (1 - m.metallic) * (1 - m.transmission) * dielectric + m.metallic * metal;
}

bool transmitsDelta(const MetallicRoughness& m) {
  const double contrast = std::abs(m.innerIor - m.outerIor) / std::max(m.innerIor, m.outerIor);
  return isMirror(m) || (!m.thinWalled && m.alpha * contrast < 2e-4);
}

glm::dvec3 evalBsdf(const MetallicRoughness& m, const glm::dvec3& woLocal, const glm::dvec3& wiLocal) {
  if (woLocal.z <= 0 || wiLocal.z == 0) return glm::dvec3(0);
  if (wiLocal.z < 0) {
    glm::dvec3 f = diffuse(m, woLocal, wiLocal);
    if (m.transmission > 0 && !transmitsDelta(m))
      f += transmittedByFacets(m, woLocal, wiLocal).f + glassMultipleLobe(m, woLocal, wiLocal);
    return f * -wiLocal.z;
  }
  glm::dvec3 f =
      diffuse(m, woLocal, wiLocal) + opaqueMultipleLobe(m, woLocal, wiLocal) + glassMultipleLobe(m, woLocal, wiLocal);
  if (!isMirror(m)) {
    const glm::dvec3 wm = glm::normalize(woLocal + wiLocal);
    const glm::dvec2 alpha(m.width);
    f += reflectedAtFacet(m, glm::dot(woLocal, wm)) * ggxD(wm, alpha) * ggxG2(woLocal, wiLocal, alpha) /
         (4 * woLocal.z * wiLocal.z);
  }
  return f * wiLocal.z;
}

glm::dvec3 evalDiffuse(const MetallicRoughness& m, const glm::dvec3& woLocal, const glm::dvec3& wiLocal) {
  if (woLocal.z <= 0 || wiLocal.z == 0) return glm::dvec3(0);
  return (diffuse(m, woLocal, wiLocal) + glassMultipleLobe(m, woLocal, wiLocal)) * std::abs(wiLocal.z);
}

double coatMultipleReflectance(const MetallicRoughness& m) {
  return multipleReflectance(m, glm::dvec3(m.dielectricF0), glm::dvec3(m.dielectricF90)).x;
}

glm::dvec3 coatReflected(const MetallicRoughness& m, double mu) {
  const glm::dvec2 albedo = albedoAt(m, {std::sqrt(1 - mu * mu), 0, mu});
  const double bare = m.dielectricF0 * albedo.x + m.dielectricF90 * albedo.y;
  if (m.film.amount == 0 || isBounded(m)) return glm::dvec3(bare);
  return glm::mix(glm::dvec3(bare), filmAlbedo(m, mu), m.film.amount);
}

glm::dvec3 coatMeanReflected(const MetallicRoughness& m) {
  const glm::dvec2 albedo = albedoMean(m);
  const double bare = m.dielectricF0 * albedo.x + m.dielectricF90 * albedo.y;
  if (m.film.amount == 0 || isBounded(m)) return glm::dvec3(bare);
  glm::dvec3 mean(0);
  const int steps = 200;
  for (int i = 0; i < steps; ++i) { // 2 mu dmu
    const double root = (i + 0.5) / steps;
    mean += filmAlbedo(m, root * root) * (4 * root * root * root / steps);
  }
  return glm::mix(glm::dvec3(bare), mean, m.film.amount);
}

glm::dvec3 meanCoatTransmission(const MetallicRoughness& m) {
  const double between = coatMultipleReflectance(m) * lost(m, albedoMean(m));
  return glm::max(1.0 - coatMeanReflected(m) - between, glm::dvec3(double(gpu::kMinCoatTransmission)));
}

double pdfBsdf(const MetallicRoughness& m, const glm::dvec3& woLocal, const glm::dvec3& wiLocal) {
  if (woLocal.z <= 0 || wiLocal.z == 0) return 0;
  const auto [facets, behind] = lobeChoice(m, woLocal);
  if (wiLocal.z < 0) {
    double pdf = behind * -wiLocal.z / pi;
    if (m.transmission > 0 && !transmitsDelta(m)) pdf += facets * transmittedByFacets(m, woLocal, wiLocal).pdf;
    return pdf;
  }
  double pdf = (1 - facets - behind) * wiLocal.z / pi;
  if (!isMirror(m)) {
    const glm::dvec3 wm = glm::normalize(woLocal + wiLocal);
    pdf += facets * reflectionShare(m, glm::dot(woLocal, wm)) * pdfVisibleNormal(woLocal, wm, m.width) /
           (4 * glm::dot(woLocal, wm));
  }
  return pdf;
}

BsdfSample sampleBsdf(const MetallicRoughness& m, const glm::dvec3& woLocal, double uLobe, const glm::dvec2& u) {
  BsdfSample result;
  if (woLocal.z <= 0) return result;
  const auto [facets, behind] = lobeChoice(m, woLocal);
  if (uLobe < facets) {
    const glm::dvec3 wm = isMirror(m) ? glm::dvec3(0, 0, 1) : sampleVisibleNormal(woLocal, m.width, u);
    const double reflected = reflectionShare(m, glm::dot(woLocal, wm));
    if (uLobe >= facets * reflected) return sampleTransmission(m, woLocal, wm, facets);
    result.wiLocal = glm::normalize(2 * glm::dot(woLocal, wm) * wm - woLocal);
    if (isMirror(m)) {
      result.weight = reflectedAtFacet(m, woLocal.z) / (facets * reflected);
      result.delta = result.valid = true;
      return result;
    }
  } else {
    const double radius = std::sqrt(u.x);
    const double phi = 2 * pi * u.y;
    result.wiLocal = {radius * std::cos(phi), radius * std::sin(phi), std::sqrt(1 - u.x)};
    if (uLobe < facets + behind) {
      result.wiLocal.z = -result.wiLocal.z;
      if (m.diffuseTransmission > 0) {
        result.eta = m.diffuseEta;
      } else if (!m.thinWalled) {
        result.eta = m.innerIor / m.outerIor;
      }
    }
  }
  if (result.wiLocal.z <= 0 && uLobe < facets) return result;
  result.pdfSolidAngle = pdfBsdf(m, woLocal, result.wiLocal);
  if (result.pdfSolidAngle <= 0) return result;
  result.weight = evalBsdf(m, woLocal, result.wiLocal) / result.pdfSolidAngle;
  result.valid = true;
  return result;
}

} // namespace isophote::oracle
