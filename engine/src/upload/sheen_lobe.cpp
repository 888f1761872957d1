#include "upload/sheen_lobe.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <glm/glm.hpp>

namespace isophote {
namespace {

double sheenLambda(double cosine, double alpha) {
  const double t = (1 - alpha) * (1 - alpha);
  const auto fit = [t](double atOne, double atZero) { return std::lerp(atOne, atZero, t); };
  const double a = fit(21.5473, 25.3245), b = fit(3.82987, 3.32435), c = fit(0.19823, 0.16801);
  const double d = fit(-1.97760, -1.27393), e = fit(-4.32054, -4.85967);
  const auto curve = [&](double x) { return a / (1 + b * std::pow(x, c)) + d * x + e; };
  return std::exp(cosine < 0.5 ? curve(cosine) : 2 * curve(0.5) - curve(1 - cosine));
}

/// Shares of the sheen's albedo by the node they go to, before scaling.
LayerRow sheenShares(double mu, double alpha, const std::vector<double>& lambdas) {
  const int heights = static_cast<int>(lambdas.size());
  constexpr int kAzimuthCount = 32;
  const double sine = std::sqrt(1 - mu * mu);
  const double lambdaO = sheenLambda(mu, alpha);
  LayerRow shares{};
  for (int i = 0; i < heights; ++i) {
    const double t = (i + 0.5) / heights;
    const double muI = t * t * t; // grazing directions carry most
    const double sineI = std::sqrt(1 - muI * muI);
    double sum = 0;
    for (int j = 0; j < kAzimuthCount; ++j) {
      const double phi = std::numbers::pi * (j + 0.5) / kAzimuthCount;
      const glm::dvec3 h(sine + sineI * std::cos(phi), sineI * std::sin(phi), mu + muI);
      const double sin2 = (h.x * h.x + h.y * h.y) / glm::dot(h, h);
      sum += std::pow(sin2, 0.5 / alpha);
    }
    const double distribution = (2 + 1 / alpha) / (2 * std::numbers::pi) * sum / kAzimuthCount;
    // D / (4 mu (1 + Lambda + Lambda)), over the azimuths of both halves and dmuI = 3 t^2 dt.
    const double value = distribution / (4 * std::max(mu, 1e-4) * (1 + lambdaO + lambdas[static_cast<size_t>(i)]));
    spread(shares, muI, 2 * std::numbers::pi * value * 3 * t * t / heights);
  }
  return shares;
}

/// sheenRow of shaders/bsdf/sheen.glsl, turned round.
double sheenRoughness(uint32_t row) {
  const double least = std::sqrt(double(gpu::kMinSheenAlpha));
  const double position = row / double(gpu::kLayerRoughnessCount - 1);
  return least + (1 - least) * position * position;
}

} // namespace

// Near grazing the published lobe reflects more than arrives where roughness is below 0.3. It is divided by its own
// albedo there, at both directions, so that it stays reciprocal and never exceeds 1.
SheenLobe sheenLobe(uint32_t row) {
  constexpr int kHeightCount = 48;
  const double alpha = std::max(std::pow(sheenRoughness(row), 2), double(gpu::kMinSheenAlpha));
  std::vector<double> lambdas;
  for (int i = 0; i < kHeightCount; ++i) {
    const double t = (i + 0.5) / kHeightCount;
    lambdas.push_back(sheenLambda(t * t * t, alpha));
  }
  SheenLobe lobe;
  for (uint32_t c = 0; c < kLayerNodeCount; ++c) {
    lobe.shares[c] = sheenShares(layerNodeMu(c), alpha, lambdas);
    double sum = 0;
    for (const double share : lobe.shares[c]) sum += share;
    lobe.scale[c] = 1 / std::max(sum, 1.0);
  }
  for (uint32_t c = 0; c < kLayerNodeCount; ++c) {
    double sum = 0;
    for (uint32_t k = 0; k < kLayerNodeCount; ++k) sum += lobe.shares[c][k] *= lobe.scale[c] * lobe.scale[k];
    lobe.albedo[c] = std::min(sum, 1.0);
  }
  return lobe;
}

} // namespace isophote
