#include "oracle/light_list.hpp"

#include <algorithm>
#include <cmath>

#include "oracle/sized_lights.hpp"
#include "oracle/surface.hpp"

namespace isophote::oracle {

namespace {

double largest(glm::dvec3 value) { return std::max({value.x, value.y, value.z}); }

double sceneRadius(const std::vector<Triangle>& triangles) {
  glm::dvec3 lower(kInfinity), upper(-kInfinity);
  for (const Triangle& triangle : triangles) {
    for (const glm::dvec3& vertex : {triangle.v0, triangle.v0 + triangle.edge1, triangle.v0 + triangle.edge2}) {
      lower = glm::min(lower, vertex);
      upper = glm::max(upper, vertex);
    }
  }
  return triangles.empty() ? 1 : glm::length(upper - lower) / 2;
}

} // namespace

glm::dvec3 punctualIrradiance(const PunctualLight& light, glm::dvec3 position) {
  const glm::dvec3 intensity(light.intensity);
  if (light.kind == LightKind::Directional) return intensity;
  const glm::dvec3 offset = position - light.position;
  const double d2 = glm::dot(offset, offset);
  if (!(d2 > 0)) return glm::dvec3(0);
  double attenuation = 1 / d2;
  if (light.range > 0) attenuation *= std::max(std::min(1 - std::pow(std::sqrt(d2) / light.range, 4), 1.0), 0.0);
  if (light.kind == LightKind::Spot) {
    const double inner = std::cos(static_cast<double>(light.innerConeAngle));
    const double outer = std::cos(static_cast<double>(light.outerConeAngle));
    const double scale = 1 / std::max(0.001, inner - outer); // the recommended code of the extension
    const double cosAngle = glm::dot(glm::normalize(offset), light.direction);
    const double falloff = std::clamp(cosAngle * scale - outer * scale, 0.0, 1.0);
    attenuation *= falloff * falloff;
  }
  return intensity * attenuation;
}

LightList::LightList(const Scene& scene, const std::vector<Triangle>& triangles, const EnvironmentMap* environment)
    : scene_(&scene), triangles_(&triangles), environment_(environment), trianglePmf_(triangles.size(), 0.0),
      lightPmf_(scene.lights.size(), 0.0) {
  std::vector<double> powers;
  const auto add = [&](Kind kind, size_t index, double power) {
    if (!(power > 0)) return;
    entries_.push_back({kind, static_cast<uint32_t>(index), 0});
    powers.push_back(power);
  };
  const double radius = sceneRadius(triangles);
  for (size_t i = 0; i < triangles.size(); ++i) {
    const Material& material = scene.materials[triangles[i].material];
    if (material.unlit) continue;
    const double sides = material.doubleSided ? 2 : 1;
    add(Kind::Triangle, i, sides * kPi * triangles[i].area * largest(glm::dvec3(material.emissive)));
  }
  for (size_t i = 0; i < scene.lights.size(); ++i) {
    const PunctualLight& light = scene.lights[i];
    const double extent = light.kind == LightKind::Directional ? kPi * radius * radius : 4 * kPi;
    add(Kind::Punctual, i, extent * largest(glm::dvec3(light.intensity)));
  }
  if (environment != nullptr) add(Kind::Environment, 0, kPi * radius * radius * environment->power());

  double total = 0;
  for (const double power : powers) total += power;
  double sum = 0;
  for (size_t i = 0; i < entries_.size(); ++i) {
    entries_[i].pmf = powers[i] / total;
    cumulative_.push_back(sum += entries_[i].pmf);
    if (entries_[i].kind == Kind::Triangle) trianglePmf_[entries_[i].index] = entries_[i].pmf;
    if (entries_[i].kind == Kind::Punctual) lightPmf_[entries_[i].index] = entries_[i].pmf;
    if (entries_[i].kind == Kind::Environment) environmentPmf_ = entries_[i].pmf;
  }
}

LightSample LightList::sample(glm::dvec3 position, RandomStream& random) const {
  if (entries_.empty()) return {};
  const auto found = std::upper_bound(cumulative_.begin(), cumulative_.end(), random.next());
  const auto chosen = std::min(static_cast<size_t>(found - cumulative_.begin()), entries_.size() - 1);
  const Entry& entry = entries_[chosen];
  if (entry.kind == Kind::Triangle) return sampleTriangle(entry.index, entry.pmf, position, random);
  if (entry.kind == Kind::Punctual && scene_->lights[entry.index].radius > 0)
    return sampleSized(entry.index, entry.pmf, position, random.next2());
  if (entry.kind == Kind::Punctual) return samplePunctual(scene_->lights[entry.index], entry.pmf, position);
  LightSample result;
  const double uTexel = random.next();
  result.wi = environment_->sample(uTexel, random.next2());
  result.radiance = environment_->radiance(result.wi);
  result.pdf = entry.pmf * environment_->pdf(result.wi);
  return result;
}

LightSample LightList::sampleTriangle(uint32_t index, double pmf, glm::dvec3 position, RandomStream& random) const {
  const Triangle& triangle = (*triangles_)[index];
  const glm::dvec2 u = random.next2();
  const double root = std::sqrt(u.x); // uniform over the area: Turk 1990, "Generating Random Points in Triangles"
  Hit hit;
  hit.triangle = index;
  hit.b1 = root * (1 - u.y);
  hit.b2 = root * u.y;
  const glm::dvec3 offset = triangle.v0 + hit.b1 * triangle.edge1 + hit.b2 * triangle.edge2 - position;
  LightSample result;
  result.distance = glm::length(offset);
  if (!(result.distance > 0)) return {};
  result.wi = offset / result.distance;
  result.triangle = index;
  // A surface covered with probability alpha emits alpha times its radiance on average.
  result.radiance = evaluateEmission(*scene_, triangle, hit, -result.wi) * evaluateCoverage(*scene_, triangle, hit);
  const double cosLight = std::abs(glm::dot(triangle.ng, result.wi));
  if (!(cosLight > 0)) return {};
  result.pdf = pmf / triangle.area * result.distance * result.distance / cosLight;
  return result;
}

LightSample LightList::samplePunctual(const PunctualLight& light, double pmf, glm::dvec3 position) const {
  LightSample result;
  result.punctual = true;
  result.pdf = pmf;
  result.radiance = punctualIrradiance(light, position);
  if (light.kind == LightKind::Directional) {
    result.wi = -light.direction;
  } else {
    const glm::dvec3 offset = light.position - position;
    result.distance = glm::length(offset);
    if (!(result.distance > 0)) return {};
    result.wi = offset / result.distance;
  }
  return result;
}

LightSample LightList::sampleSized(uint32_t index, double pmf, glm::dvec3 position, glm::dvec2 u) const {
  const PunctualLight& light = scene_->lights[index];
  const Cone cone = light.isSun() ? sunCone(light) : sphereCone(light, position);
  LightSample result;
  result.wi = cone.sample(u);
  result.pdf = pmf * cone.pdf();
  if (light.isSun()) {
    result.radiance = sunRadiance(light);
    return result;
  }
  // At the limb rounding may miss the sphere: it is as far as the tangent is long.
  const double distance = glm::length(light.position - position);
  result.distance = intersectSphere(light, {position, result.wi, 0, kInfinity, kNoTriangle, kNoTriangle});
  if (result.distance == kInfinity) result.distance = std::sqrt(distance * distance - light.radius * light.radius);
  result.radiance = sphereRadiance(light, position, result.wi);
  result.sphere = index;
  return result;
}

double LightList::pdfSized(uint32_t index, glm::dvec3 position) const {
  const PunctualLight& light = scene_->lights[index];
  return lightPmf_[index] * (light.isSun() ? sunCone(light) : sphereCone(light, position)).pdf();
}

double LightList::pdfTriangle(uint32_t triangle, double distance, glm::dvec3 wi) const {
  const double cosLight = std::abs(glm::dot((*triangles_)[triangle].ng, wi));
  if (!(cosLight > 0)) return 0;
  return trianglePmf_[triangle] / (*triangles_)[triangle].area * distance * distance / cosLight;
}

double LightList::pdfEnvironment(glm::dvec3 wi) const {
  return environmentPmf_ > 0 ? environmentPmf_ * environment_->pdf(wi) : 0;
}

} // namespace isophote::oracle
