#include "upload/facet_albedo.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "oracle/bsdf_facets.hpp"
#include "oracle/bsdf_ggx.hpp"
#include "shared/bsdf_constants.h"

using namespace isophote;

namespace {

// The device's lookup, shaders/bsdf/facet_albedo.glsl, in double.
glm::dvec2 lookUp(double mu, double alpha) {
  const auto at = [](uint32_t column, uint32_t row) {
    return glm::dvec2(facetAlbedoTable()[row * gpu::kFacetAlbedoMuCount + column]);
  };
  const double column = std::sqrt(mu) * (gpu::kFacetAlbedoMuCount - 1);
  const double row = std::sqrt(alpha) * (gpu::kFacetAlbedoRoughnessCount - 1);
  const uint32_t c = std::min(uint32_t(column), gpu::kFacetAlbedoMuCount - 2);
  const uint32_t r = std::min(uint32_t(row), gpu::kFacetAlbedoRoughnessCount - 2);
  return glm::mix(glm::mix(at(c, r), at(c + 1, r), column - c), glm::mix(at(c, r + 1), at(c + 1, r + 1), column - c),
                  row - r);
}

struct WorstError {
  double a = 0;
  double b = 0;
};

// Over `count` points of a low-discrepancy set in sqrt(mu) and roughness inside the given box.
WorstError worstError(int count, double muLow, double muHigh, double alphaLow, double alphaHigh) {
  WorstError worst;
  for (int i = 1; i <= count; ++i) {
    const double x = std::lerp(std::sqrt(muLow), std::sqrt(muHigh), std::fmod(i * 0.7548776662466927, 1));
    const double y = std::lerp(std::sqrt(alphaLow), std::sqrt(alphaHigh), std::fmod(i * 0.5698402909980532, 1));
    const glm::dvec2 error = glm::abs(lookUp(x * x, y * y) - oracle::quadratureAlbedo(x * x, y * y, 200));
    worst.a = std::max(worst.a, error.x);
    worst.b = std::max(worst.b, error.y);
  }
  return worst;
}

} // namespace

TEST(FacetAlbedo, TableHasTheLayoutThatTheDeviceReads) {
  const auto& table = facetAlbedoTable();
  ASSERT_EQ(table.size(), gpu::kFacetAlbedoMeans + gpu::kFacetAlbedoRoughnessCount);
  for (uint32_t c = 0; c < gpu::kFacetAlbedoMuCount; ++c) { // roughness 0: the smooth mirror
    const double root = c / double(gpu::kFacetAlbedoMuCount - 1);
    const double grazing = std::pow(1 - root * root, 5);
    EXPECT_NEAR(double(table[c].x), 1 - grazing, 1e-7);
    EXPECT_NEAR(double(table[c].y), grazing, 1e-7);
  }
  // 2 times the integral of (1 - mu)^5 mu is 2 / 42; linear interpolation over sqrt(mu) moves it by less than 1e-4.
  EXPECT_NEAR(double(table[gpu::kFacetAlbedoMeans].y), 2.0 / 42, 1e-4);
}

// Values: converged double quadrature; the one at (1, 1) is 1 - ln 2.
TEST(FacetAlbedo, TableHoldsKnownAlbedos) {
  EXPECT_NEAR(lookUp(1, 1).x + lookUp(1, 1).y, 1 - std::numbers::ln2, 3e-4);
  EXPECT_NEAR(lookUp(1, 0.5).x + lookUp(1, 0.5).y, 0.687848, 5e-4);
  EXPECT_NEAR(lookUp(0.5, 1).x + lookUp(0.5, 1).y, 0.450694, 5e-4);
  EXPECT_NEAR(lookUp(0.1, 0.25).x + lookUp(0.1, 0.25).y, 0.891624, 5e-4);
}

TEST(FacetAlbedo, InterpolationMatchesQuadrature) {
  const WorstError ordinary = worstError(150, 0.05, 1, 0.05, 1);
  EXPECT_LT(ordinary.a, 1.2e-3);
  EXPECT_LT(ordinary.b, 6e-4);
  const WorstError grazing = worstError(150, 0, 0.05, 0.05, 1);
  EXPECT_LT(grazing.a, 6e-4);
  EXPECT_LT(grazing.b, 1e-3);
  const WorstError smooth = worstError(150, 0.05, 1, 1e-3, 0.05);
  EXPECT_LT(smooth.a, 1.2e-3);
  EXPECT_LT(smooth.b, 1.8e-3);
  // Where mu and alpha are alike and small, both functions bend within one cell.
  const WorstError both = worstError(150, 0, 0.05, 1e-3, 0.05);
  EXPECT_LT(both.a, 2.8e-3);
  EXPECT_LT(both.b, 0.01);
  for (const auto& [name, worst] :
       {std::pair("ordinary", ordinary), {"grazing", grazing}, {"smooth", smooth}, {"both", both}}) {
    RecordProperty(name, "A " + std::to_string(worst.a) + " B " + std::to_string(worst.b));
  }
}

TEST(FacetAlbedo, MeansMatchTheOracle) {
  for (const uint32_t row : {0u, 8u, 20u, 42u, 63u}) {
    const double roughness = row / double(gpu::kFacetAlbedoRoughnessCount - 1);
    const glm::dvec2 mean(facetAlbedoTable()[gpu::kFacetAlbedoMeans + row]);
    const glm::dvec2 expected = oracle::meanAlbedo(roughness * roughness);
    EXPECT_NEAR(mean.x, expected.x, 5e-4) << roughness;
    EXPECT_NEAR(mean.y, expected.y, 5e-4) << roughness;
  }
}

// The oracle integrates over another parametrization of the visible normals than the table; a third way, over wi
// itself.
TEST(FacetAlbedo, OracleQuadratureMatchesIntegrationOverDirections) {
  for (const auto& [mu, alpha] : {std::pair(1.0, 0.5), {0.5, 0.5}, {0.3, 1.0}, {0.7, 0.3}}) {
    const glm::dvec3 wo(std::sqrt(1 - mu * mu), 0, mu);
    const int side = 600;
    glm::dvec2 sum(0);
    for (int i = 0; i < side; ++i) {
      for (int j = 0; j < side; ++j) {
        const double cosine = (i + 0.5) / side;
        const double phi = std::numbers::pi * (j + 0.5) / side;
        const double sine = std::sqrt(1 - cosine * cosine);
        const glm::dvec3 wi(sine * std::cos(phi), sine * std::sin(phi), cosine);
        const glm::dvec3 wm = glm::normalize(wo + wi);
        const double grazing = std::pow(1 - glm::dot(wo, wm), 5);
        const double value = oracle::ggxD(wm, glm::dvec2(alpha)) * oracle::ggxG2(wo, wi, glm::dvec2(alpha)) / (4 * mu);
        sum += value * glm::dvec2(1 - grazing, grazing);
      }
    }
    sum *= 2 * std::numbers::pi / (double(side) * side);
    const glm::dvec2 expected = oracle::quadratureAlbedo(mu, alpha, 400);
    EXPECT_NEAR(sum.x, expected.x, 5e-5) << mu << " " << alpha;
    EXPECT_NEAR(sum.y, expected.y, 5e-5) << mu << " " << alpha;
  }
}

// Tables of the other distributions, masking and reflectance, at their nodes and between, by normals of D cos instead
// of GGX's visible ones.
TEST(FacetAlbedo, TablesOfAllFacetsMatchQuadrature) {
  struct Choice {
    FacetModel model;
    float ior;
  };
  const Choice choices[] = {{{Ndf::Ggx, Masking::Separable}, 0},
                            {{Ndf::Beckmann, Masking::Correlated}, 1.5f},
                            {{Ndf::BlinnPhong, Masking::Separable}, 0}};
  for (const Choice& choice : choices) {
    const std::vector<glm::vec2>& table = exactAlbedoTable(choice.model, choice.ior);
    ASSERT_EQ(table.size(), gpu::kFacetAlbedoSize);
    double worst = 0;
    for (const uint32_t row : {13u, 45u}) {
      for (const uint32_t column : {15u, 32u, 50u, 63u}) {
        const double roughness = row / double(gpu::kFacetAlbedoRoughnessCount - 1);
        const double root = column / double(gpu::kFacetAlbedoMuCount - 1);
        const double mu = root * root;
        const glm::dvec2 expected =
            oracle::facetAlbedo({choice.model.ndf, choice.model.masking}, {std::sqrt(1 - mu * mu), 0, mu},
                                glm::dvec2(roughness * roughness), 120, double(choice.ior));
        const glm::dvec2 error = glm::abs(glm::dvec2(table[row * gpu::kFacetAlbedoMuCount + column]) - expected);
        worst = std::max({worst, error.x, error.y});
      }
    }
    EXPECT_LT(worst, 1.5e-3) << uint32_t(choice.model.ndf) << " " << choice.ior;
    RecordProperty("worst" + std::to_string(&choice - choices), std::to_string(worst));
  }
}
