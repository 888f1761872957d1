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
  enum class Kind { Coat, Sheen };

  LayerCoupling(Kind kind, double roughness, double alphaBelow) : kind_(kind), roughness_(roughness) {
    if (kind == Kind::Sheen) buildSheen();
    mean_ = cosineMean([this](double mu) { return albedo(mu); });
    const glm::dvec2 meanBelow(cosineMean([&](double mu) { return directionalAlbedo(mu, alphaBelow).x; }),
                               cosineMean([&](double mu) { return directionalAlbedo(mu, alphaBelow).y; }));
    for (int k = 0; k < 2; ++k) {
      covariance_[k] = cosineMean([&](double mu) { return directionalAlbedo(mu, alphaBelow)[k] * albedo(mu); }) -
                       meanBelow[k] * mean_;
    }
    buildNarrow(alphaBelow);
    for (int k = 0; k < 2; ++k)
      meanThrough_[k] = cosineMean([&](double mu) { return directionalAlbedo(mu, alphaBelow)[k] * through(mu)[k]; });
  }

  [[nodiscard]] double albedo(double mu) const {
    if (kind_ == Kind::Sheen) return interpolate(sheenAlbedo_, mu);
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
  [[nodiscard]] const glm::dvec2& covariance() const { return covariance_; }

private:
  void buildSheen() {
    for (int i = 0; i < kNodes; ++i) {
      const double raw = sheenIntegral(std::max(nodeMu(i), 1e-6), roughness_, [](double) { return 1.0; });
      sheenScale_.push_back(1 / std::max(raw, 1.0));
    }
    for (int i = 0; i < kNodes; ++i) {
      const double mu = std::max(nodeMu(i), 1e-6);
      const double scaled = sheenIntegral(mu, roughness_, [this](double z) { return scale(z); });
      sheenAlbedo_.push_back(sheenScale_[static_cast<size_t>(i)] * scaled);
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
  glm::dvec2 covariance_{0};
  std::vector<double> sheenScale_;
  std::vector<double> sheenAlbedo_;
  std::vector<double> narrow_;
  std::vector<double> normal_;
  std::vector<double> grazing_;
  glm::dvec2 meanThrough_{0};
};

class CoatedSheen {
public:
  CoatedSheen(const LayerCoupling& coat, const LayerCoupling& sheen, double sheenRoughness, double alphaBelow) {
    for (int i = 0; i < kNodes; ++i) {
      const double mu = std::max(nodeMu(i), 1e-6);
      const double mean = sheenIntegral(
          mu, sheenRoughness, [&](double z) { return sheen.scale(z) * std::max(coat.albedo(z), coat.albedo(mu)); });
      taken_.push_back(sheen.scale(mu) * mean);
    }
    mean_ = cosineMean([this](double mu) { return taken(mu); });
    for (int k = 0; k < 2; ++k) {
      const auto below = [&](double mu) { return directionalAlbedo(mu, alphaBelow)[k]; };
      covariance_[k] = cosineMean([&](double mu) { return below(mu) * taken(mu); }) - cosineMean(below) * mean_;
    }
  }

  /// Albedo of the sheen's lobe times the larger of the coat's albedos at both directions.
  [[nodiscard]] double taken(double mu) const { return interpolate(taken_, mu); }
  [[nodiscard]] double mean() const { return mean_; }
  [[nodiscard]] const glm::dvec2& covariance() const { return covariance_; }

private:
  std::vector<double> taken_;
  double mean_ = 0;
  glm::dvec2 covariance_{0};
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

double mixed(double amount, double factor) { return 1 - amount + amount * factor; }

} // namespace

LayeredSurface::LayeredSurface(const MetallicRoughness& base, const ClearcoatLayer& coat, const SheenLayer& sheen)
    : base_(base), coat_(coat), sheen_(sheen) {
  if (coat.amount > 0) coatCoupling_ = coupling(LayerCoupling::Kind::Coat, coat.roughness, baseAlpha(base));
  if (largest(sheen.color) > 0) sheenCoupling_ = coupling(LayerCoupling::Kind::Sheen, sheen.roughness, baseAlpha(base));
  if (coatCoupling_ && sheenCoupling_)
    coatedSheen_ =
        std::make_shared<const CoatedSheen>(*coatCoupling_, *sheenCoupling_, sheen.roughness, baseAlpha(base));
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

// The layer reflects amount E; the coat's facets f0 A + f90 B and what scatters between them, of which a share leaves
// the layer; the diffuse lobe gives back the rest, by U(wo) U(wi) / mean U in place of the same without a layer.
double LayeredSurface::broadThrough(const LayerCoupling& layer, double amount, double muO, double muI) const {
  const double f0 = base_.dielectricF0, f90 = base_.dielectricF90, multiple = coatMultipleReflectance(base_);
  const auto left = [&](double reflected, const glm::dvec2& albedo, const glm::dvec2& through, double covered) {
    const double bare = f0 * albedo.x + f90 * albedo.y + multiple * (1 - albedo.x - albedo.y);
    const double under = f0 * through.x + f90 * through.y + multiple * (1 - reflected - through.x - through.y);
    return 1 - covered * reflected - std::lerp(bare, under, covered);
  };
  const auto ratio = [&](double mu) {
    const glm::dvec2 albedo = directionalAlbedo(mu, baseAlpha(base_));
    const glm::dvec2 through = albedo * layer.through(mu);
    return left(layer.albedo(mu), albedo, through, amount) / left(layer.albedo(mu), albedo, through, 0);
  };
  const double mean = left(layer.mean(), meanAlbedo(baseAlpha(base_)), layer.meanThrough(), amount);
  return ratio(muO) * ratio(muI) * meanCoatTransmission(base_) / mean;
}

// Both layers lose c E_coat + a (E_sheen - c X), X what the coat takes of the sheen's light; the diffuse lobe gives
// back the rest, U, by U(wo) U(wi) over the mean of U times what the base's own coat passes.
double LayeredSurface::broadThroughBoth(const glm::dvec3& wo, const glm::dvec3& wi) const {
  const double amount = largest(sheen_.color);
  const auto left = [&](const glm::dvec3& w) {
    const double mu = std::abs(w.z);
    const double coat = coat_.amount * coatCoupling_->albedo(std::abs(glm::dot(coat_.normal, w)));
    return std::max(1 - coat - amount * (sheenCoupling_->albedo(mu) - coat_.amount * coatedSheen_->taken(mu)), 0.0);
  };
  const auto lost = [&](auto quantity) {
    return coat_.amount * quantity(*coatCoupling_) +
           amount * (quantity(*sheenCoupling_) - coat_.amount * quantity(*coatedSheen_));
  };
  const glm::dvec2 covariance = lost([](const auto& layer) { return layer.covariance(); });
  const double mean =
      1 - lost([](const auto& layer) { return layer.mean(); }) +
      (base_.dielectricF0 * covariance.x + base_.dielectricF90 * covariance.y) / meanCoatTransmission(base_);
  return left(wo) * left(wi) / mean;
}

LayeredSurface::Passage LayeredSurface::passage(const glm::dvec3& wo, const glm::dvec3& wi) const {
  const auto through = [&](const LayerCoupling& layer, double amount, double muO, double muI) {
    return Passage{mixed(amount, layer.narrow(muO) * layer.narrow(muI)), broadThrough(layer, amount, muO, muI)};
  };
  Passage result;
  if (coatCoupling_) {
    const double muO = std::abs(glm::dot(coat_.normal, wo)), muI = std::abs(glm::dot(coat_.normal, wi));
    result = through(*coatCoupling_, coat_.amount, muO, muI);
  }
  if (sheenCoupling_) {
    const Passage sheen = through(*sheenCoupling_, largest(sheen_.color), wo.z, std::abs(wi.z));
    result.narrow *= sheen.narrow;
    if (coatCoupling_) result.narrow *= 1 - 0.01 * coat_.amount * largest(sheen_.color);
    result.broad = coatCoupling_ ? broadThroughBoth(wo, wi) : sheen.broad;
  }
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
      under =
          mixed(coat_.amount, 1 - std::max(coatCoupling_->albedo(std::abs(muO)), coatCoupling_->albedo(std::abs(muI))));
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
