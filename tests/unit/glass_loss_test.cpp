#include "upload/glass_loss.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "oracle/glass_loss.hpp"
#include "shared/bsdf_constants.h"

using namespace isophote;

namespace {

// The device's lookup, shaders/bsdf/glass_loss.glsl, in double.
glm::dvec2 lookUp(const std::vector<glm::vec2>& table, uint32_t half, double mu, double alpha) {
  const auto at = [&](uint32_t column, uint32_t row) {
    return glm::dvec2(table[half * gpu::kGlassLossHalf + row * gpu::kGlassLossMuCount + column]);
  };
  const double column = std::sqrt(mu) * (gpu::kGlassLossMuCount - 1);
  const double row = std::sqrt(alpha) * (gpu::kGlassLossRoughnessCount - 1);
  const uint32_t c = std::min(uint32_t(column), gpu::kGlassLossMuCount - 2);
  const uint32_t r = std::min(uint32_t(row), gpu::kGlassLossRoughnessCount - 2);
  return glm::mix(glm::mix(at(c, r), at(c + 1, r), column - c), glm::mix(at(c, r + 1), at(c + 1, r + 1), column - c),
                  row - r);
}

} // namespace

// Over a low-discrepancy set in sqrt(mu) and roughness, against another quadrature with another sampling of normals.
TEST(GlassLoss, InterpolationMatchesQuadrature) {
  for (const double ior : {1.1, 1.5, 2.4}) {
    const auto table = glassLossTable({.ior = float(ior)});
    for (const uint32_t half : {0u, 1u}) {
      const double eta = half == 0 ? ior : 1 / ior;
      double inner = 0, grazing = 0;
      for (int i = 1; i <= 300; ++i) {
        const double x = std::fmod(i * 0.7548776662466927, 1), y = 0.05 + 0.95 * std::fmod(i * 0.5698402909980532, 1);
        const double mu = x * x, alpha = y * y;
        const glm::dvec2 error =
            glm::abs(lookUp(table, half, mu, alpha) - oracle::quadratureGlassLoss(mu, alpha, eta, 120));
        double& worst = mu < 0.05 || alpha < 0.02 ? grazing : inner;
        worst = std::max({worst, error.x, error.y});
      }
      RecordProperty("inner", std::to_string(inner));
      RecordProperty("grazing", std::to_string(grazing));
      EXPECT_LT(inner, 1e-2) << ior << " half " << half;
      EXPECT_LT(grazing, 1.5e-2) << ior << " half " << half;
    }
  }
}
