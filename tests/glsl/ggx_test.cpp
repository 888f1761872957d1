#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "glsl/directions.hpp"
#include "glsl/ggx_case.h"
#include "oracle/bsdf_ggx.hpp"
#include "support/probe.hpp"
#include "support/statistics.hpp"
#include "test_glsl_kernels.hpp"

using namespace isophote;
using gpu::GgxCase;
using gpu::GgxResult;
using std::numbers::pi;

namespace {

const glm::vec2 kAlphas[] = {{5e-5f, 5e-5f}, {1e-3f, 1e-3f}, {3e-3f, 3e-3f}, {0.01f, 0.01f}, {0.1f, 0.1f},
                             {0.5f, 0.5f},   {1, 1},         {0.01f, 0.5f},  {1, 0.02f}};

std::vector<GgxResult> evaluate(const std::vector<GgxCase>& cases) {
  return test::runProbe<GgxCase, GgxResult>(test_glsl_kernels::kernelSource("ggx_probe"), cases);
}

glm::vec2 uniformPair(std::mt19937& generator) {
  const float x = test::uniform(generator);
  return {x, test::uniform(generator)};
}

double relativeError(float actual, double expected) { return std::abs(double(actual) / expected - 1); }

GgxCase blank(const glm::vec2& alpha) {
  return {.wo = {0, 0, 1}, .wi = {0, 0, 1}, .wm = {0, 0, 1}, .alpha = alpha, .u = {0.5f, 0.5f}};
}

} // namespace

TEST(Ggx, DistributionMatchesTheOracleDownToTheSmallestAlpha) {
  std::vector<GgxCase> cases;
  for (const glm::vec2& alpha : kAlphas) {
    for (int i = 0; i < 400; ++i) {
      GgxCase c = blank(alpha);
      c.wm = test::tiltedNormal(alpha, std::pow(10.0, -3 + 6.0 * i / 399), 0.7 * i);
      cases.push_back(c);
    }
  }
  const auto results = evaluate(cases);
  for (size_t i = 0; i < cases.size(); ++i) {
    const double expected = oracle::ggxD(glm::dvec3(cases[i].wm), glm::dvec2(cases[i].alpha));
    EXPECT_LE(relativeError(results[i].d, expected), 2e-6) << cases[i].alpha.x << " " << cases[i].wm.z;
  }
}

// Integral of D cos over the hemisphere by midpoints in the logarithm of tan, which know nothing of GGX.
TEST(Ggx, DistributionIsNormalizedFromAlpha1e3To1) {
  const int count = 4000;
  const double range = std::log(1e10);
  for (const double alpha : {1e-3, 2e-3, 0.01, 0.05, 0.2, 0.5, 1.0}) {
    std::vector<GgxCase> cases(count, blank(glm::vec2(float(alpha))));
    std::vector<double> weights(count);
    for (int i = 0; i < count; ++i) {
      const double tangent = 1e-6 * std::exp(range * (i + 0.5) / count);
      const double cosine = 1 / std::sqrt(1 + tangent * tangent);
      cases[size_t(i)].wm = {float(tangent * cosine), 0, float(cosine)};
      // 2 pi cos sin dtheta, dtheta = cos^2 dtan, dtan = tan dlog(tan)
      weights[size_t(i)] = 2 * pi * cosine * (tangent * cosine) * (cosine * cosine) * tangent * range / count;
    }
    const auto results = evaluate(cases);
    double integral = 0;
    for (size_t i = 0; i < cases.size(); ++i) integral += double(results[i].d) * weights[i];
    EXPECT_NEAR(integral, 1, 1e-5) << alpha;
  }
}

TEST(Ggx, MaskingAndDensitiesMatchTheOracleUpToGrazing) {
  std::mt19937 generator(7);
  std::vector<GgxCase> cases;
  for (const glm::vec2& alpha : kAlphas) {
    for (const double cosine : {1e-6, 1e-4, 1e-2, 0.05, 0.3, 0.7, 1.0}) {
      for (const double other : {1e-6, 1e-3, 0.1, 0.5, 0.99}) {
        GgxCase c = blank(alpha);
        c.wo = test::directionOf(cosine, 6 * uniformPair(generator).x);
        c.wi = test::directionOf(other, 6 * uniformPair(generator).x);
        const glm::vec2 u = uniformPair(generator);
        c.wm = test::tiltedNormal(alpha, std::tan(1.5 * double(u.x)), 6 * double(u.y));
        cases.push_back(c);
      }
    }
  }
  const auto results = evaluate(cases);
  for (size_t i = 0; i < cases.size(); ++i) {
    const GgxCase& c = cases[i];
    const glm::dvec3 wo(c.wo);
    const glm::dvec3 wi(c.wi);
    const glm::dvec3 wm(c.wm);
    const glm::dvec2 alpha(c.alpha);
    const double g1 = oracle::ggxG1(wo, alpha);
    const double g2 = oracle::ggxG2(wo, wi, alpha);
    const std::string label = "alpha " + std::to_string(alpha.x) + ", " + std::to_string(alpha.y) + " cosines " +
                              std::to_string(wo.z) + ", " + std::to_string(wi.z);
    EXPECT_LE(relativeError(results[i].g1, g1), 2e-6) << label;
    EXPECT_LE(relativeError(results[i].visibility, g2 / (4 * wo.z * wi.z)), 2e-6) << label;
    EXPECT_LE(relativeError(results[i].weight, g2 / g1), 2e-6) << label;
    const double density = oracle::pdfVisibleNormal(wo, wm, alpha);
    // The dot product of wo and wm cancels where they are nearly orthogonal: absolute error 2^-22.
    const double cancelled = std::ldexp(1.0, -22) / std::max(glm::dot(wo, wm), 1e-30);
    if (density > 0) {
      EXPECT_LE(relativeError(results[i].pdfNormal, density), 4e-6 + cancelled) << label;
    }
    const double reflected = g1 * oracle::ggxD(wm, alpha) / (4 * wo.z);
    EXPECT_LE(relativeError(results[i].pdfReflection, reflected), 4e-6) << label;
  }
}

// Chi-square of sampled normals against the oracle's density, over 24 x 24 bins that the distribution itself makes
// equal: s = tan^2 / (1 + tan^2) of the slope divided by alpha, and its azimuth. D cos dwm = ds dphi / 2 pi.
// Significance 1e-3 over all cases (Sidak); 4e5 samples and 576 bins reject a density that is off by 2% root mean
// square.
TEST(Ggx, VisibleNormalsFollowTheirDensity) {
  const int bins = 24;
  const int nodes = 16;
  const size_t count = 400000;
  const std::pair<glm::vec2, double> cases[] = {{{0.01f, 0.01f}, 1.0}, {{0.01f, 0.01f}, 0.02}, {{0.1f, 0.1f}, 0.05},
                                                {{0.5f, 0.5f}, 0.5},   {{1, 1}, 0.05},         {{0.1f, 0.6f}, 0.3},
                                                {{1e-3f, 1e-3f}, 0.5}};
  const double significance = test::sidak(1e-3, std::size(cases));
  std::mt19937 generator(11);
  for (const auto& [width, cosine] : cases) {
    GgxCase c = blank(width);
    c.wo = test::directionOf(cosine, 0.8);
    std::vector<GgxCase> inputs(count, c);
    for (GgxCase& input : inputs) input.u = uniformPair(generator);
    const glm::dvec2 alpha(width);
    std::vector<uint64_t> observed(bins * bins);
    for (const GgxResult& result : evaluate(inputs)) {
      const glm::dvec2 slope = glm::dvec2(result.sampled) / double(result.sampled.z) / alpha;
      const int s = std::min(int(bins / std::sqrt(1 + glm::dot(slope, slope))), bins - 1);
      const int a = std::min(int(bins * (std::atan2(slope.y, slope.x) / (2 * pi) + 0.5)), bins - 1);
      ++observed[size_t(s * bins + a)];
    }
    std::vector<double> expected(bins * bins);
    for (int i = 0; i < bins * nodes; ++i) {
      for (int j = 0; j < bins * nodes; ++j) {
        const double stretchedCosine = (i + 0.5) / (bins * nodes);
        const double phi = 2 * pi * ((j + 0.5) / (bins * nodes) - 0.5);
        const double slope = std::sqrt(1 / (stretchedCosine * stretchedCosine) - 1);
        const glm::dvec3 wm =
            glm::normalize(glm::dvec3(alpha.x * slope * std::cos(phi), alpha.y * slope * std::sin(phi), 1));
        const double density = oracle::pdfVisibleNormal(glm::dvec3(c.wo), wm, alpha) / (oracle::ggxD(wm, alpha) * wm.z);
        expected[size_t(i / nodes * bins + j / nodes)] +=
            double(count) * density * 2 * stretchedCosine / std::pow(bins * nodes, 2);
      }
    }
    const auto result = test::chiSquareTest(observed, expected);
    EXPECT_GT(result.p, significance) << "alpha " << alpha.x << " " << alpha.y << " cosine " << cosine << " statistic "
                                      << result.statistic << " of " << result.degreesOfFreedom;
  }
}

TEST(Ggx, SamplesStayInTheirDomainForExtremeRandomNumbers) {
  const float last = 1 - std::ldexp(1.0f, -24);
  std::vector<GgxCase> cases;
  for (const glm::vec2& alpha : kAlphas) {
    for (const double cosine : {1e-6, 1e-3, 0.05, 0.5, 0.9999, 1.0}) {
      for (const float x : {0.0f, std::ldexp(1.0f, -24), 0.25f, 0.5f, 0.75f, last}) {
        for (const float y : {0.0f, std::ldexp(1.0f, -24), 0.5f, last}) {
          GgxCase c = blank(alpha);
          c.wo = test::directionOf(cosine, 3.14159265);
          c.u = {x, y};
          cases.push_back(c);
        }
      }
    }
  }
  for (const GgxResult& result : evaluate(cases)) {
    EXPECT_NEAR(double(glm::length(glm::dvec3(result.sampled))), 1, 1e-6);
    EXPECT_GT(result.sampled.z, 0);
    EXPECT_TRUE(std::isfinite(result.pdfSampled));
    EXPECT_GE(result.pdfSampled, 0);
  }
}

// Mean of G2 / G1 over reflections of visible normals = directional albedo at F = 1. The values are converged double
// quadrature; (1, 1) is 1 - ln 2. Stratified samples: 700 x 700 leave less than 3e-4.
TEST(Ggx, SampledWeightsAddUpToTheKnownAlbedo) {
  struct Known {
    double mu, alpha, albedo;
  };
  const Known table[] = {{1, 1, 1 - std::numbers::ln2}, {1, 0.5, 0.687848}, {0.5, 0.5, 0.698251},
                         {0.1, 0.5, 0.860106},          {0.5, 1, 0.450694}, {0.5, 0.25, 0.857265},
                         {0.1, 0.25, 0.891624},         {1, 0.1, 0.988304}};
  const int side = 700;
  for (const Known& known : table) {
    GgxCase c = blank(glm::vec2(float(known.alpha)));
    c.wo = test::directionOf(known.mu, 0.3);
    std::vector<GgxCase> cases(size_t(side) * side, c);
    for (int i = 0; i < side * side; ++i) {
      cases[size_t(i)].u = {float((i % side + 0.5) / side), float((i / side + 0.5) / side)};
    }
    std::vector<GgxCase> reflections;
    for (const GgxResult& result : evaluate(cases)) {
      GgxCase reflection = c;
      reflection.wi = 2 * glm::dot(c.wo, result.sampled) * result.sampled - c.wo;
      if (reflection.wi.z > 0) reflections.push_back(reflection);
    }
    double sum = 0;
    for (const GgxResult& result : evaluate(reflections)) {
      EXPECT_TRUE(result.weight >= 0 && result.weight <= 1 + 1e-6f) << result.weight;
      sum += double(result.weight);
    }
    EXPECT_NEAR(sum / (side * side), known.albedo, 3e-4) << "mu " << known.mu << " alpha " << known.alpha;
  }
}
