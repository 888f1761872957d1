#include "oracle/bsdf_metallic_roughness.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "oracle/bsdf_fresnel.hpp"
#include "oracle/bsdf_ggx.hpp"
#include "shared/bsdf_constants.h"

namespace isophote::oracle {
namespace {

using std::numbers::pi;

double luminance(const glm::dvec3& color) { return glm::dot(color, glm::dvec3(0.2126, 0.7152, 0.0722)); }

bool isMirror(const MetallicRoughness& m) { return m.alpha < double(gpu::kMirrorAlpha); }

double coatAlbedo(const MetallicRoughness& m, const glm::dvec2& albedo) {
  return m.dielectricF0 * albedo.x + m.dielectricF90 * albedo.y;
}

// GGX integrals of the lobe that is really there: a mirror's where alpha is below the limit.
double modelAlpha(const MetallicRoughness& m) { return isMirror(m) ? 0 : m.alpha; }

double glassShare(const MetallicRoughness& m) { return m.transmission * (1 - m.metallic); }

glm::dvec3 diffuse(const MetallicRoughness& m, double muO, double muI) {
  const double alpha = modelAlpha(m);
  const double transmittedO = 1 - coatAlbedo(m, directionalAlbedo(muO, alpha));
  const double transmittedI = 1 - coatAlbedo(m, directionalAlbedo(muI, alpha));
  const double mean = std::max(1 - coatAlbedo(m, meanAlbedo(alpha)), double(gpu::kMinCoatTransmission));
  return m.baseColor * ((1 - m.metallic) * (1 - m.transmission) / pi * transmittedO * transmittedI / mean);
}

// Probability of choosing a facet instead of the diffuse lobe.
double facetProbability(const MetallicRoughness& m, double muO) {
  const glm::dvec2 albedo = directionalAlbedo(muO, modelAlpha(m));
  const double below = luminance(m.baseColor) * (1 - coatAlbedo(m, albedo));
  const double facets = luminance(m.f0 * albedo.x + m.f90 * albedo.y) +
                        glassShare(m) * (luminance(m.glassF0 * albedo.x + m.dielectricF90 * albedo.y) + below);
  const double diffuse = (1 - m.metallic) * (1 - m.transmission) * below;
  return facets > 0 ? facets / (facets + diffuse) : 0;
}

glm::dvec3 reflectedAtFacet(const MetallicRoughness& m, double cosine) {
  return fresnelSchlick(m.f0, m.f90, cosine) + glassShare(m) * glassReflectance(m, cosine);
}

glm::dvec3 transmittedAtFacet(const MetallicRoughness& m, double cosine) {
  const glm::dvec3 reflectance = glassReflectance(m, cosine);
  return glassShare(m) * (1 - std::max({reflectance.x, reflectance.y, reflectance.z})) * m.baseColor;
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
  const glm::dvec2 alpha(m.alpha);
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
          .f0 = glm::mix(dielectricF0, baseColor, metallic),
          .f90 = glm::dvec3(std::lerp(specular, 1.0, metallic)),
          .dielectricF0 = std::max({dielectricF0.x, dielectricF0.y, dielectricF0.z}),
          .dielectricF90 = specular,
          .glassF0 = dielectricF0};
}

MetallicRoughness withTransmission(MetallicRoughness m, double transmission, double ior, bool frontFace,
                                   bool thinWalled) {
  m.transmission = transmission;
  m.outerIor = frontFace || thinWalled ? 1 : ior;
  m.innerIor = frontFace || thinWalled ? ior : 1;
  m.thinWalled = thinWalled;
  m.f0 = glm::mix((1 - transmission) * m.glassF0, m.baseColor, m.metallic);
  m.f90 = glm::dvec3(std::lerp((1 - transmission) * m.dielectricF90, 1.0, m.metallic));
  return m;
}

glm::dvec3 glassReflectance(const MetallicRoughness& m, double cosine) {
  const double exact = fresnelDielectric(cosine, m.innerIor / m.outerIor);
  if (exact >= 1) return glm::dvec3(1); // total internal reflection, or grazing
  const double normal = fresnelDielectric(1, m.innerIor / m.outerIor);
  return glm::mix(m.glassF0, glm::dvec3(m.dielectricF90), std::max(0.0, (exact - normal) / (1 - normal)));
}

bool transmitsDelta(const MetallicRoughness& m) {
  const double contrast = std::abs(m.innerIor - m.outerIor) / std::max(m.innerIor, m.outerIor);
  return isMirror(m) || (!m.thinWalled && m.alpha * contrast < 2e-4);
}

glm::dvec3 evalBsdf(const MetallicRoughness& m, const glm::dvec3& woLocal, const glm::dvec3& wiLocal) {
  if (woLocal.z <= 0 || wiLocal.z == 0) return glm::dvec3(0);
  if (wiLocal.z < 0) {
    if (m.transmission == 0 || transmitsDelta(m)) return glm::dvec3(0);
    return transmittedByFacets(m, woLocal, wiLocal).f * -wiLocal.z;
  }
  glm::dvec3 f = diffuse(m, woLocal.z, wiLocal.z);
  if (!isMirror(m)) {
    const glm::dvec3 wm = glm::normalize(woLocal + wiLocal);
    const glm::dvec2 alpha(m.alpha);
    f += reflectedAtFacet(m, glm::dot(woLocal, wm)) * ggxD(wm, alpha) * ggxG2(woLocal, wiLocal, alpha) /
         (4 * woLocal.z * wiLocal.z);
  }
  return f * wiLocal.z;
}

double pdfBsdf(const MetallicRoughness& m, const glm::dvec3& woLocal, const glm::dvec3& wiLocal) {
  if (woLocal.z <= 0 || wiLocal.z == 0) return 0;
  const double facets = facetProbability(m, woLocal.z);
  if (wiLocal.z < 0) {
    if (m.transmission == 0 || transmitsDelta(m)) return 0;
    return facets * transmittedByFacets(m, woLocal, wiLocal).pdf;
  }
  double pdf = (1 - facets) * wiLocal.z / pi;
  if (!isMirror(m)) {
    const glm::dvec3 wm = glm::normalize(woLocal + wiLocal);
    pdf += facets * reflectionShare(m, glm::dot(woLocal, wm)) * pdfVisibleNormal(woLocal, wm, glm::dvec2(m.alpha)) /
           (4 * glm::dot(woLocal, wm));
  }
  return pdf;
}

BsdfSample sampleBsdf(const MetallicRoughness& m, const glm::dvec3& woLocal, double uLobe, const glm::dvec2& u) {
  BsdfSample result;
  if (woLocal.z <= 0) return result;
  const double facets = facetProbability(m, woLocal.z);
  if (uLobe < facets) {
    const glm::dvec3 wm = isMirror(m) ? glm::dvec3(0, 0, 1) : sampleVisibleNormal(woLocal, glm::dvec2(m.alpha), u);
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
  }
  if (result.wiLocal.z <= 0) return result;
  result.pdfSolidAngle = pdfBsdf(m, woLocal, result.wiLocal);
  if (result.pdfSolidAngle <= 0) return result;
  result.weight = evalBsdf(m, woLocal, result.wiLocal) / result.pdfSolidAngle;
  result.valid = true;
  return result;
}

} // namespace isophote::oracle
