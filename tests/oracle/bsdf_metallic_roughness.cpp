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

glm::dvec3 diffuse(const MetallicRoughness& m, double muO, double muI) {
  const double alpha = modelAlpha(m);
  const double transmittedO = 1 - coatAlbedo(m, directionalAlbedo(muO, alpha));
  const double transmittedI = 1 - coatAlbedo(m, directionalAlbedo(muI, alpha));
  const double mean = std::max(1 - coatAlbedo(m, meanAlbedo(alpha)), double(gpu::kMinCoatTransmission));
  return m.baseColor * ((1 - m.metallic) / pi * transmittedO * transmittedI / mean);
}

double specularProbability(const MetallicRoughness& m, double muO) {
  const glm::dvec2 albedo = directionalAlbedo(muO, modelAlpha(m));
  const double specular = luminance(m.f0 * albedo.x + m.f90 * albedo.y);
  const double below = luminance(m.baseColor) * (1 - m.metallic) * (1 - coatAlbedo(m, albedo));
  return specular + below > 0 ? specular / (specular + below) : 0;
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
          .dielectricF90 = specular};
}

glm::dvec3 evalBsdf(const MetallicRoughness& m, const glm::dvec3& woLocal, const glm::dvec3& wiLocal) {
  if (woLocal.z <= 0 || wiLocal.z <= 0) return glm::dvec3(0);
  glm::dvec3 f = diffuse(m, woLocal.z, wiLocal.z);
  if (!isMirror(m)) {
    const glm::dvec3 wm = glm::normalize(woLocal + wiLocal);
    const glm::dvec2 alpha(m.alpha);
    f += fresnelSchlick(m.f0, m.f90, glm::dot(woLocal, wm)) * ggxD(wm, alpha) * ggxG2(woLocal, wiLocal, alpha) /
         (4 * woLocal.z * wiLocal.z);
  }
  return f * wiLocal.z;
}

glm::dvec3 evalDiffuse(const MetallicRoughness& m, const glm::dvec3& woLocal, const glm::dvec3& wiLocal) {
  if (woLocal.z <= 0 || wiLocal.z <= 0) return glm::dvec3(0);
  return diffuse(m, woLocal.z, wiLocal.z) * wiLocal.z;
}

double pdfBsdf(const MetallicRoughness& m, const glm::dvec3& woLocal, const glm::dvec3& wiLocal) {
  if (woLocal.z <= 0 || wiLocal.z <= 0) return 0;
  const double specular = specularProbability(m, woLocal.z);
  double pdf = (1 - specular) * wiLocal.z / pi;
  if (!isMirror(m)) {
    const glm::dvec3 wm = glm::normalize(woLocal + wiLocal);
    pdf += specular * pdfVisibleNormal(woLocal, wm, glm::dvec2(m.alpha)) / (4 * glm::dot(woLocal, wm));
  }
  return pdf;
}

BsdfSample sampleBsdf(const MetallicRoughness& m, const glm::dvec3& woLocal, double uLobe, const glm::dvec2& u) {
  BsdfSample result;
  if (woLocal.z <= 0) return result;
  const double specular = specularProbability(m, woLocal.z);
  if (uLobe < specular) {
    if (isMirror(m)) {
      result.wiLocal = glm::dvec3(-woLocal.x, -woLocal.y, woLocal.z);
      result.weight = fresnelSchlick(m.f0, m.f90, woLocal.z) / specular;
      result.delta = result.valid = true;
      return result;
    }
    const glm::dvec3 wm = sampleVisibleNormal(woLocal, glm::dvec2(m.alpha), u);
    result.wiLocal = glm::normalize(2 * glm::dot(woLocal, wm) * wm - woLocal);
  } else {
    const double radius = std::sqrt(u.x);
    const double phi = 2 * pi * u.y;
    result.wiLocal = {radius * std::cos(phi), radius * std::sin(phi), std::sqrt(1 - u.x)};
  }
  result.pdfSolidAngle = pdfBsdf(m, woLocal, result.wiLocal);
  if (result.pdfSolidAngle <= 0) return result;
  result.weight = evalBsdf(m, woLocal, result.wiLocal) / result.pdfSolidAngle;
  result.valid = true;
  return result;
}

} // namespace isophote::oracle
