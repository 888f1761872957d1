#include "oracle/bsdf_layers.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <numbers>
#include <tuple>
#include <vector>

#include "oracle/bsdf_fresnel.hpp"
#include "oracle/bsdf_ggx.hpp"
#include "shared/bsdf_constants.h"

namespace isophote::oracle {
namespace {

using std::numbers::pi;

constexpr int kNodes = 97; // at mu = (i / 96)^2
constexpr double kCoatF0 = 0.04;

double coatAlpha(double roughness) {
  const double alpha = roughness * roughness;
  return alpha < double(gpu::kMirrorAlpha) ? 0 : alpha;
}

double baseAlpha(const MetallicRoughness& m) { return m.alpha < double(gpu::kMirrorAlpha) ? 0 : m.alpha; }

double luminance(const glm::dvec3& color) { return glm::dot(color, glm::dvec3(0.2126, 0.7152, 0.0722)); }

double largest(const glm::dvec3& color) { return std::max({color.x, color.y, color.z}); }

double nodeMu(int i) {
  const double root = i / double(kNodes - 1);
  return root * root;
}

double interpolate(const std::vector<double>& row, double mu) {
  const double position = std::sqrt(std::clamp(mu, 0.0, 1.0)) * (kNodes - 1);
  const int i = std::min(static_cast<int>(position), kNodes - 2);
  return std::lerp(row[static_cast<size_t>(i)], row[static_cast<size_t>(i + 1)], position - i);
}

// 2 times the integral over mu in [0, 1] of function(mu) mu.
template <class Function> double cosineMean(const Function& function) {
  const int steps = 500;
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double x = (i + 0.5) / steps; // sqrt(mu)
    sum += 4 * x * x * x * function(x * x);
  }
  return sum / steps;
}

double charlieLambda(double cosine, double alpha) {
  const double t = (1 - alpha) * (1 - alpha);
  const double a = t * 25.3245 + (1 - t) * 21.5473;
  const double b = t * 3.32435 + (1 - t) * 3.82987;
  const double c = t * 0.16801 + (1 - t) * 0.19823;
  const double d = t * -1.27393 + (1 - t) * -1.97760;
  const double e = t * -4.85967 + (1 - t) * -4.32054;
  const auto L = [&](double x) { return a / (1 + b * std::pow(x, c)) + d * x + e; };
  return cosine < 0.5 ? std::exp(L(cosine)) : std::exp(2 * L(0.5) - L(1 - cosine));
}

// Integral over wi of the sheen's lobe times weight(wi.z).
template <class Weight> double sheenIntegral(double mu, double roughness, const Weight& weight) {
  const int heights = 100, azimuths = 32;
  const glm::dvec3 wo(std::sqrt(1 - mu * mu), 0, mu);
  double sum = 0;
  for (int i = 0; i < heights; ++i) {
    const double t = (i + 0.5) / heights;
    const double z = t * t * t;
    const double w = weight(z) * 3 * t * t;
    for (int j = 0; j < azimuths; ++j) {
      const double phi = pi * (j + 0.5) / azimuths;
      const double sine = std::sqrt(1 - z * z);
      sum += w * sheenLobe(wo, {sine * std::cos(phi), sine * std::sin(phi), z}, roughness);
    }
  }
  return 2 * pi * sum / (heights * azimuths);
}

} // namespace

double sheenLobe(const glm::dvec3& wo, const glm::dvec3& wi, double roughness) {
  const double alpha = std::max(roughness * roughness, double(gpu::kMinSheenAlpha));
  const glm::dvec3 h = glm::normalize(wo + wi);
  const double sine = std::sqrt(h.x * h.x + h.y * h.y);
  const double D = (2 + 1 / alpha) * std::pow(sine, 1 / alpha) / (2 * pi);
  const double V = 1 / ((1 + charlieLambda(wo.z, alpha) + charlieLambda(wi.z, alpha)) * 4 * wo.z * wi.z);
  return D * V * wi.z;
}

class LayerCoupling {
public:
  enum class Kind { Coat, Sheen, CoatedSheen };

  LayerCoupling(Kind kind, double roughness, double alphaBelow) : kind_(kind), roughness_(roughness) {
    if (kind == Kind::Sheen) buildSheen();
    buildFacets(alphaBelow);
  }

  /// A coat over a sheen. The coat takes the larger of its albedos at both directions from the sheen's light.
  LayerCoupling(const LayerCoupling& coat, const LayerCoupling& sheen, double alphaBelow)
      : kind_(Kind::CoatedSheen), roughness_(sheen.roughness_) {
    for (int i = 0; i < kNodes; ++i) {
      const double mu = std::max(nodeMu(i), 1e-6);
      const double taken = sheen.scale(mu) * sheenIntegral(mu, sheen.roughness_, [&](double z) {
                             return sheen.scale(z) * std::max(coat.albedo(z), coat.albedo(mu));
                           });
      albedo_.push_back(coat.albedo(mu) + sheen.albedo(mu) - taken);
    }
    buildFacets(alphaBelow);
  }

  [[nodiscard]] double albedo(double mu) const {
    if (kind_ != Kind::Coat) return interpolate(albedo_, mu);
    const glm::dvec2 ab = directionalAlbedo(mu, coatAlpha(roughness_));
    return kCoatF0 * ab.x + ab.y;
  }
  [[nodiscard]] double scale(double mu) const { return interpolate(sheenScale_, mu); }
  [[nodiscard]] double narrow(double mu) const { return interpolate(narrow_, mu); }
  /// Of what facets reflect by Schlick's weights 1 - (1-c)^5 and (1-c)^5, the shares that leave the layer.
  [[nodiscard]] glm::dvec2 through(double mu) const { return {interpolate(normal_, mu), interpolate(grazing_, mu)}; }
  /// Cosine-weighted means of both albedos times that.
  [[nodiscard]] const glm::dvec2& meanThrough() const { return meanThrough_; }
  [[nodiscard]] double mean() const { return mean_; }

private:
  void buildFacets(double alphaBelow) {
    mean_ = cosineMean([this](double mu) { return albedo(mu); });
    buildNarrow(alphaBelow);
    for (int k = 0; k < 2; ++k)
      meanThrough_[k] = cosineMean([&](double mu) { return directionalAlbedo(mu, alphaBelow)[k] * through(mu)[k]; });
  }

  void buildSheen() {
    for (int i = 0; i < kNodes; ++i) {
      const double raw = sheenIntegral(std::max(nodeMu(i), 1e-6), roughness_, [](double) { return 1.0; });
      sheenScale_.push_back(1 / std::max(raw, 1.0));
    }
    for (int i = 0; i < kNodes; ++i) {
      const double mu = std::max(nodeMu(i), 1e-6);
      const double scaled = sheenIntegral(mu, roughness_, [this](double z) { return scale(z); });
      albedo_.push_back(sheenScale_[static_cast<size_t>(i)] * scaled);
    }
  }

  struct Ray {
    double mu;
    double share;
    double grazing; ///< (1-c)^5
  };

  // g with g(mu) times the mean of g over what a white microfacet base does with light of mu = 1 - albedo(mu).
  void buildNarrow(double alpha) {
    narrow_.resize(kNodes);
    std::vector<double> passed(kNodes);
    for (int i = 0; i < kNodes; ++i) {
      passed[static_cast<size_t>(i)] = std::max(1 - albedo(nodeMu(i)), 0.0);
      narrow_[static_cast<size_t>(i)] = std::sqrt(passed[static_cast<size_t>(i)]);
    }
    normal_ = grazing_ = passed;
    if (alpha == 0) return;
    std::vector<std::vector<Ray>> rays(kNodes);
    const int side = 32;
    for (int n = 0; n < kNodes; ++n) {
      const double mu = std::max(nodeMu(n), 1e-9);
      const glm::dvec3 wo(std::sqrt(1 - mu * mu), 0, mu);
      for (int i = 0; i < side; ++i) {
        const double t = (i + 0.5) / side;
        for (int j = 0; j < side; ++j) {
          const glm::dvec3 wm = sampleVisibleNormal(wo, glm::dvec2(alpha), {1 - t * t, 0.25 + 0.5 * (j + 0.5) / side});
          const glm::dvec3 wi = 2 * glm::dot(wo, wm) * wm - wo;
          if (wi.z <= 0) continue;
          const double weight = ggxG2(wo, wi, glm::dvec2(alpha)) / ggxG1(wo, glm::dvec2(alpha));
          rays[static_cast<size_t>(n)].push_back(
              {wi.z, 2 * t * weight / (side * side), std::pow(1 - glm::dot(wo, wm), 5)});
        }
      }
    }
    std::vector<double> lost(kNodes);
    for (size_t n = 0; n < kNodes; ++n) {
      double kept = 0;
      for (const Ray& ray : rays[n]) kept += ray.share;
      lost[n] = std::max(1 - kept, 0.0);
    }
    const double meanLost = cosineMean([&](double mu) { return interpolate(lost, mu); });
    for (int step = 0; step < 30; ++step) {
      const double returned = cosineMean([&](double mu) { return interpolate(lost, mu) * interpolate(narrow_, mu); });
      std::vector<double> next(kNodes);
      for (size_t n = 0; n < kNodes; ++n) {
        double received = lost[n] * returned / meanLost;
        for (const Ray& ray : rays[n]) received += ray.share * interpolate(narrow_, ray.mu);
        next[n] = received > 0 ? std::sqrt(narrow_[n] * passed[n] / received) : 0;
      }
      narrow_ = next;
    }
    for (size_t n = 0; n < kNodes; ++n) {
      glm::dvec2 all(0), leaving(0);
      for (const Ray& ray : rays[n]) {
        const glm::dvec2 weights = ray.share * glm::dvec2(1 - ray.grazing, ray.grazing);
        all += weights;
        leaving += weights * interpolate(narrow_, ray.mu);
      }
      normal_[n] = all.x > 1e-9 ? narrow_[n] * leaving.x / all.x : passed[n];
      grazing_[n] = all.y > 1e-9 ? narrow_[n] * leaving.y / all.y : passed[n];
    }
  }

  Kind kind_;
  double roughness_;
  double mean_ = 0;
  std::vector<double> sheenScale_;
  std::vector<double> albedo_;
  std::vector<double> narrow_;
  std::vector<double> normal_;
  std::vector<double> grazing_;
  glm::dvec2 meanThrough_{0};
};

namespace {

std::shared_ptr<const LayerCoupling> coupling(LayerCoupling::Kind kind, double roughness, double alphaBelow) {
  static std::mutex mutex;
  static std::map<std::tuple<LayerCoupling::Kind, double, double>, std::shared_ptr<const LayerCoupling>> known;
  const std::lock_guard lock(mutex);
  auto& entry = known[{kind, roughness, alphaBelow}];
  if (!entry) entry = std::make_shared<const LayerCoupling>(kind, roughness, alphaBelow);
  return entry;
}

glm::dmat3 coatFrame(const glm::dvec3& normal) {
  const glm::dvec3 axis = std::abs(normal.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 tangent = glm::normalize(glm::cross(axis, normal));
  return {tangent, glm::cross(normal, tangent), normal};
}

} // namespace

LayeredSurface::LayeredSurface(const MetallicRoughness& base, const ClearcoatLayer& coat, const SheenLayer& sheen)
    : base_(base), coat_(coat), sheen_(sheen) {
  if (coat.amount > 0) coatCoupling_ = coupling(LayerCoupling::Kind::Coat, coat.roughness, baseAlpha(base));
  if (largest(sheen.color) > 0) sheenCoupling_ = coupling(LayerCoupling::Kind::Sheen, sheen.roughness, baseAlpha(base));
  if (coatCoupling_ && sheenCoupling_)
    bothCoupling_ = std::make_shared<const LayerCoupling>(*coatCoupling_, *sheenCoupling_, baseAlpha(base));
}

LayeredSurface::Probabilities LayeredSurface::probabilities(const glm::dvec3& wo) const {
  double reachable = 1, coatShare = 0, sheenShare = 0;
  if (coatCoupling_) {
    const double mu = glm::dot(wo, coat_.normal);
    const double reflected = coat_.amount * coatCoupling_->albedo(std::abs(mu));
    reachable -= reflected;
    if (mu > 0) coatShare = reflected;
  }
  if (sheenCoupling_) {
    const double albedo = sheenCoupling_->albedo(wo.z);
    sheenShare = reachable * luminance(sheen_.color) * albedo;
    reachable *= 1 - largest(sheen_.color) * albedo;
  }
  const double base = reachable * std::max(luminance(glm::max(base_.baseColor, base_.f0)), 0.05);
  const double below = sheenShare + base;
  return {coatShare > 0 ? coatShare / (coatShare + below) : 0, sheenShare > 0 ? sheenShare / below : 0};
}

// Shares of the surface that lie bare, under the coat, under the sheen and under both.
std::vector<LayeredSurface::Cover> LayeredSurface::covers() const {
  const double coat = coat_.amount, sheen = largest(sheen_.color);
  std::vector<Cover> result{{(1 - coat) * (1 - sheen), nullptr}};
  if (coatCoupling_) result.push_back({coat * (1 - sheen), coatCoupling_.get()});
  if (sheenCoupling_) result.push_back({(1 - coat) * sheen, sheenCoupling_.get()});
  if (bothCoupling_) result.push_back({coat * sheen, bothCoupling_.get()});
  return result;
}

// A cosine to the coat's own normal where the layer is that coat.
double LayeredSurface::cosineTo(const LayerCoupling& layer, const glm::dvec3& w) const {
  return std::abs(&layer == coatCoupling_.get() ? glm::dot(coat_.normal, w) : w.z);
}

// Layers reflect E; the coat's facets f0 A + f90 B and what scatters between them, of which a share leaves. The rest is
// for the diffuse lobe to give back. f0 makes the sum the coat's reflectance also where that is no Schlick curve.
template <class Layer>
glm::dvec3 LayeredSurface::left(const glm::dvec3& coatReflected, const glm::dvec2& albedo, const Layer& of) const {
  const double f90 = std::lerp(base_.dielectricF90, 1.0, base_.film.amount);
  const glm::dvec3 f0 = (coatReflected - f90 * albedo.y) / albedo.x;
  const double multiple = coatMultipleReflectance(base_);
  glm::dvec3 rest(1);
  for (const auto& [share, layer] : covers()) {
    const auto [reflected, facets] = layer == nullptr ? std::pair(0.0, albedo) : of(*layer);
    rest -= share * (reflected + f0 * facets.x + f90 * facets.y + multiple * (1 - reflected - facets.x - facets.y));
  }
  return rest;
}

glm::dvec3 LayeredSurface::leftAlong(const glm::dvec3& w) const {
  const double mu = std::abs(w.z);
  const glm::dvec2 albedo = directionalAlbedo(mu, baseAlpha(base_));
  return left(coatReflected(base_, mu), albedo, [&](const LayerCoupling& layer) {
    const double cosine = cosineTo(layer, w);
    return std::pair(layer.albedo(cosine), albedo * layer.through(cosine));
  });
}

glm::dvec3 LayeredSurface::leftOnAverage() const {
  return left(coatMeanReflected(base_), meanAlbedo(baseAlpha(base_)),
              [](const LayerCoupling& layer) { return std::pair(layer.mean(), layer.meanThrough()); });
}

// What the diffuse lobe's own coat passes; the lobe has been multiplied by it.
glm::dvec3 LayeredSurface::coatPassed(const glm::dvec3& w) const {
  const double mu = std::abs(w.z);
  const glm::dvec2 albedo = directionalAlbedo(mu, baseAlpha(base_));
  return 1.0 - coatReflected(base_, mu) - coatMultipleReflectance(base_) * (1 - albedo.x - albedo.y);
}

LayeredSurface::Passage LayeredSurface::passage(const glm::dvec3& wo, const glm::dvec3& wi) const {
  Passage result{.narrow = 0};
  for (const auto& [share, layer] : covers()) {
    const double coupling =
        layer == nullptr ? 1 : layer->narrow(cosineTo(*layer, wo)) * layer->narrow(cosineTo(*layer, wi));
    result.narrow += share * coupling;
  }
  result.broad =
      leftAlong(wo) * leftAlong(wi) * meanCoatTransmission(base_) / (leftOnAverage() * coatPassed(wo) * coatPassed(wi));
  return result;
}

glm::dvec3 LayeredSurface::eval(const glm::dvec3& wo, const glm::dvec3& wi) const {
  if (wo.z <= 0 || wi.z == 0) return glm::dvec3(0);
  const Passage through = passage(wo, wi);
  const glm::dvec3 diffuse = evalDiffuse(base_, wo, wi);
  glm::dvec3 result = diffuse * through.broad + (evalBsdf(base_, wo, wi) - diffuse) * through.narrow;
  if (wi.z < 0) return result; // a thin wall has its layers on both sides
  const double muO = glm::dot(coat_.normal, wo), muI = glm::dot(coat_.normal, wi);
  if (sheenCoupling_) {
    double under = 1;
    if (coatCoupling_)
      under = 1 - coat_.amount * std::max(coatCoupling_->albedo(std::abs(muO)), coatCoupling_->albedo(std::abs(muI)));
    result += sheen_.color *
              (under * sheenCoupling_->scale(wo.z) * sheenCoupling_->scale(wi.z) * sheenLobe(wo, wi, sheen_.roughness));
  }
  if (coatCoupling_ && coatAlpha(coat_.roughness) > 0 && muO > 0 && muI > 0) {
    const glm::dmat3 frame = coatFrame(coat_.normal);
    const glm::dvec3 woCoat = glm::transpose(frame) * wo, wiCoat = glm::transpose(frame) * wi;
    const glm::dvec3 wm = glm::normalize(woCoat + wiCoat);
    const glm::dvec2 alpha(coatAlpha(coat_.roughness));
    const double fresnel = fresnelSchlick(glm::dvec3(kCoatF0), glm::dvec3(1), glm::dot(woCoat, wm)).x;
    result += coat_.amount * fresnel * ggxD(wm, alpha) * ggxG2(woCoat, wiCoat, alpha) / (4 * woCoat.z);
  }
  return result;
}

double LayeredSurface::pdf(const glm::dvec3& wo, const glm::dvec3& wi) const {
  if (wo.z <= 0 || wi.z == 0) return 0;
  const Probabilities choice = probabilities(wo);
  if (wi.z < 0) return (1 - choice.coat) * (1 - choice.sheen) * pdfBsdf(base_, wo, wi);
  double result = (1 - choice.coat) * (choice.sheen / (2 * pi) + (1 - choice.sheen) * pdfBsdf(base_, wo, wi));
  const double muO = glm::dot(coat_.normal, wo), muI = glm::dot(coat_.normal, wi);
  if (choice.coat > 0 && coatAlpha(coat_.roughness) > 0 && muO > 0 && muI > 0) {
    const glm::dmat3 frame = coatFrame(coat_.normal);
    const glm::dvec3 woCoat = glm::transpose(frame) * wo, wiCoat = glm::transpose(frame) * wi;
    const glm::dvec3 wm = glm::normalize(woCoat + wiCoat);
    result +=
        choice.coat * pdfVisibleNormal(woCoat, wm, glm::dvec2(coatAlpha(coat_.roughness))) / (4 * glm::dot(woCoat, wm));
  }
  return result;
}

BsdfSample LayeredSurface::sample(const glm::dvec3& wo, double uLobe, const glm::dvec2& u) const {
  BsdfSample result;
  if (wo.z <= 0) return result;
  const Probabilities choice = probabilities(wo);
  if (uLobe < choice.coat) {
    const glm::dmat3 frame = coatFrame(coat_.normal);
    const glm::dvec3 woCoat = glm::transpose(frame) * wo;
    const double alpha = coatAlpha(coat_.roughness);
    const glm::dvec3 wm = alpha == 0 ? glm::dvec3(0, 0, 1) : sampleVisibleNormal(woCoat, glm::dvec2(alpha), u);
    result.wiLocal = frame * (2 * glm::dot(woCoat, wm) * wm - woCoat);
    if (alpha == 0) {
      result.weight = coat_.amount * fresnelSchlick(glm::dvec3(kCoatF0), glm::dvec3(1), woCoat.z) / choice.coat;
      result.delta = true;
      result.valid = result.wiLocal.z > 0;
      return result;
    }
  } else {
    const double rest = (uLobe - choice.coat) / (1 - choice.coat);
    if (rest < choice.sheen) {
      const double sine = std::sqrt(1 - u.x * u.x);
      result.wiLocal = {sine * std::cos(2 * pi * u.y), sine * std::sin(2 * pi * u.y), u.x};
    } else {
      result = sampleBsdf(base_, wo, (rest - choice.sheen) / (1 - choice.sheen), u);
      if (result.delta) {
        result.weight *= passage(wo, result.wiLocal).narrow / ((1 - choice.coat) * (1 - choice.sheen));
        return result;
      }
    }
  }
  result.pdfSolidAngle = pdf(wo, result.wiLocal);
  result.valid = result.pdfSolidAngle > 0;
  if (result.valid) result.weight = eval(wo, result.wiLocal) / result.pdfSolidAngle;
  return result;
}

} // namespace isophote::oracle
