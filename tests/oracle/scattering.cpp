#include "oracle/scattering.hpp"

#include <cmath>

namespace isophote::oracle {

namespace {

// x is the direction of anisotropy, where there is one.
glm::dmat3 frameOf(const SurfacePoint& point) {
  const glm::dvec3 normal = point.ns;
  const glm::dvec3 axis = std::abs(normal.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 tangent = point.along != glm::dvec3(0) ? point.along : glm::normalize(glm::cross(axis, normal));
  return {tangent, glm::cross(normal, tangent), normal};
}

} // namespace

Scattering::Scattering(const SurfacePoint& point, glm::dvec3 wo)
    : ng_(point.ng), frame_(frameOf(point)), woLocal_(glm::transpose(frame_) * wo), lit_(sidesAgree(wo)),
      lambert_(point.material.metallic == 0 && point.material.specular == 0 && point.material.transmission == 0 &&
               point.material.diffuseTransmission == 0 && point.material.film.amount == 0),
      model_(metallicRoughness(point.material.baseColor, point.material.metallic, point.material.roughness,
                               point.material.ior, point.material.specular, point.material.specularColor)) {
  if (point.material.anisotropy > 0) model_ = withAnisotropy(model_, point.material.anisotropy);
  model_.brushedAlbedo = true;
  if (point.material.transmission > 0)
    model_ = withTransmission(model_, point.material.transmission, point.material.ior, point.frontFace,
                              point.material.thinWalled);
  const SurfaceMaterial& material = point.material;
  if (material.conductorN.x > 0) model_ = withConductor(model_, material.conductorN, material.conductorK);
  if (material.film.amount > 0) model_ = withFilm(model_, material.film);
  if (material.diffuseTransmission > 0) {
    const bool refracts = material.transmission > 0 && !material.thinWalled;
    model_ = withDiffuseTransmission(model_, material.diffuseTransmission, material.diffuseTransmissionColor,
                                     refracts ? model_.innerIor / model_.outerIor : 1);
  }
  if (material.clearcoat == 0 && material.sheenColor == glm::dvec3(0)) return;
  layered_.emplace(
      model_,
      ClearcoatLayer{material.clearcoat, material.clearcoatRoughness, glm::transpose(frame_) * point.coatNormal},
      SheenLayer{material.sheenColor, material.sheenRoughness});
}

ScatterValue Scattering::evaluate(glm::dvec3 wi) const {
  if (!lit_ || !sidesAgree(wi)) return {};
  const glm::dvec3 wiLocal = glm::transpose(frame_) * wi;
  if (layered_) return {layered_->eval(woLocal_, wiLocal), layered_->pdf(woLocal_, wiLocal)};
  if (lambert_ && wiLocal.z <= 0) return {};
  if (lambert_) return {model_.baseColor * (wiLocal.z / kPi), wiLocal.z / kPi};
  return {evalBsdf(model_, woLocal_, wiLocal), pdfBsdf(model_, woLocal_, wiLocal)};
}

ScatterSample Scattering::sample(RandomStream& random) const {
  if (!lit_) return {};
  ScatterSample result;
  const double uLobe = random.next();
  const glm::dvec2 u = random.next2();
  if (lambert_ && !layered_) {
    const double r = std::sqrt(u.x), phi = 2 * kPi * u.y;
    result.wi = frame_ * glm::dvec3(r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - u.x));
    const ScatterValue value = evaluate(result.wi);
    result.pdf = value.pdf;
    if (value.pdf > 0) result.weight = model_.baseColor;
    return result;
  }
  const BsdfSample sample = layered_ ? layered_->sample(woLocal_, uLobe, u) : sampleBsdf(model_, woLocal_, uLobe, u);
  result.wi = frame_ * sample.wiLocal;
  if (!sample.valid || !sidesAgree(result.wi)) return {};
  result.weight = sample.weight;
  result.pdf = sample.pdfSolidAngle;
  result.delta = sample.delta;
  result.eta = sample.eta;
  return result;
}

} // namespace isophote::oracle
