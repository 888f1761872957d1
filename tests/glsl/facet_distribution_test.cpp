// The distributions of microfacet normals and the two maskings that the settings offer, against the papers.
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "glsl/directions.hpp"
#include "glsl/ggx_case.h"
#include "oracle/bsdf_facets.hpp"
#include "render/setting_ids.hpp"
#include "support/probe.hpp"
#include "support/statistics.hpp"
#include "test_glsl_kernels.hpp"

using namespace isophote;
using gpu::GgxCase;
using gpu::GgxResult;
using std::numbers::pi;

namespace {

constexpr Ndf kNdfs[] = {Ndf::Ggx, Ndf::Beckmann, Ndf::BlinnPhong};
constexpr Masking kMaskings[] = {Masking::Correlated, Masking::Separable};
const glm::vec2 kAlphas[] = {{1e-3f, 1e-3f}, {0.01f, 0.01f}, {0.1f, 0.1f},  {0.3f, 0.3f}, {0.5f, 0.5f},
                             {0.8f, 0.8f},   {1, 1},         {0.05f, 0.5f}, {1, 0.02f}};

std::vector<GgxResult> evaluate(const std::vector<GgxCase>& cases, Ndf ndf, Masking masking = Masking::Correlated) {
  const gpu::SpecConstant constants[] = {{setting_id::kNdf, static_cast<uint32_t>(ndf)},
                                         {setting_id::kMasking, static_cast<uint32_t>(masking)}};
  return test::runProbe<GgxCase, GgxResult>(test_glsl_kernels::kernelSource("ggx_probe"), cases, 0, constants);
}

GgxCase blank(const glm::vec2& alpha) {
  return {.wo = {0, 0, 1}, .wi = {0, 0, 1}, .wm = {0, 0, 1}, .alpha = alpha, .u = {0.5f, 0.5f}, .uSide = 0.5f};
}

std::string describe(Ndf ndf, const GgxCase& c) {
  return "ndf " + std::to_string(uint32_t(ndf)) + " alpha " + std::to_string(c.alpha.x) + ", " +
         std::to_string(c.alpha.y) + " cosines " + std::to_string(c.wo.z) + ", " + std::to_string(c.wi.z);
}

} // namespace

// Up to slopes where the density has fallen below 1e-6 of its peak: exp(-x) is known to x times the rounding of x.
TEST(FacetDistribution, DensityMatchesTheOracle) {
  for (const Ndf ndf : kNdfs) {
    std::vector<GgxCase> cases;
    for (const glm::vec2& alpha : kAlphas) {
      for (int i = 0; i < 200; ++i) {
        cases.push_back(blank(alpha));
        cases.back().wm = test::tiltedNormal(alpha, std::pow(10.0, -3 + 3.5 * i / 199), 0.7 * i);
      }
    }
    const auto results = evaluate(cases, ndf);
    double worst = 0;
    for (size_t i = 0; i < cases.size(); ++i) {
      const glm::dvec2 alpha(cases[i].alpha);
      const double expected = oracle::facetD(ndf, glm::dvec3(cases[i].wm), alpha);
      const double peak = oracle::facetD(ndf, {0, 0, 1}, alpha);
      if (expected < 1e-6 * peak) continue;
      worst = std::max(worst, std::abs(double(results[i].d) / expected - 1));
    }
    EXPECT_LE(worst, 1e-5) << uint32_t(ndf); // slopes of wm itself are rounded: 14 times 2^-22
    RecordProperty("ndf" + std::to_string(uint32_t(ndf)), std::to_string(worst));
  }
}

// Test 5 of the reference list. Integral of D cos over the hemisphere by midpoints in the logarithm of tan, which know
// nothing of the distribution. As a course prints Beckmann's and Blinn's, it is 0.09 to 0.34 at these widths.
TEST(FacetDistribution, Test5IntegralOfDCosIsOne) {
  const int count = 4000;
  const double range = std::log(1e10);
  for (const Ndf ndf : kNdfs) {
    for (const double alpha : {1e-3, 0.01, 0.1, 0.5, 1.0}) {
      std::vector<GgxCase> cases(count, blank(glm::vec2(float(alpha))));
      std::vector<double> weights(count);
      for (int i = 0; i < count; ++i) {
        const double tangent = 1e-6 * std::exp(range * (i + 0.5) / count);
        const double cosine = 1 / std::sqrt(1 + tangent * tangent);
        cases[size_t(i)].wm = {float(tangent * cosine), 0, float(cosine)};
        weights[size_t(i)] = 2 * pi * cosine * (tangent * cosine) * (cosine * cosine) * tangent * range / count;
      }
      const auto results = evaluate(cases, ndf);
      double integral = 0;
      for (size_t i = 0; i < cases.size(); ++i) integral += double(results[i].d) * weights[i];
      EXPECT_NEAR(integral, 1, 1e-5) << uint32_t(ndf) << " " << alpha;
    }
  }
}

// Smith's masking leaves each direction the projected area of the flat surface: the weak white furnace. So the length
// that the device masks by must be the integral of D |dot|, which the oracle takes from the slopes themselves.
TEST(FacetDistribution, MaskingConservesProjectedArea) {
  std::mt19937 generator(7);
  for (const Ndf ndf : kNdfs) {
    std::vector<GgxCase> cases;
    for (const glm::vec2& alpha : kAlphas) {
      for (const double cosine : {1e-6, 1e-4, 1e-3, 0.01, 0.03, 0.1, 0.2, 0.4, 0.6, 0.7, 0.72, 0.9, 0.99, 1.0}) {
        cases.push_back(blank(alpha));
        cases.back().wo = test::directionOf(cosine, 6 * double(test::uniform(generator)));
      }
    }
    const auto results = evaluate(cases, ndf);
    double worst = 0;
    for (size_t i = 0; i < cases.size(); ++i) {
      const double expected = oracle::projectedArea(ndf, glm::dvec3(cases[i].wo), glm::dvec2(cases[i].alpha));
      const double error = std::abs(double(results[i].projectedLength) / expected - 1);
      EXPECT_LE(error, 1e-5) << describe(ndf, cases[i]);
      worst = std::max(worst, error);
    }
    RecordProperty("ndf" + std::to_string(uint32_t(ndf)), std::to_string(worst));
  }
}

TEST(FacetDistribution, VisibilityAndDensitiesMatchTheOracle) {
  std::mt19937 generator(9);
  for (const Ndf ndf : kNdfs) {
    std::vector<GgxCase> cases;
    for (const glm::vec2& alpha : kAlphas) {
      for (const double cosine : {1e-4, 0.02, 0.3, 0.8}) {
        for (const double other : {1e-3, 0.1, 0.6, 1.0}) {
          GgxCase c = blank(alpha);
          c.wo = test::directionOf(cosine, 6 * double(test::uniform(generator)));
          c.wi = test::directionOf(other, 6 * double(test::uniform(generator)));
          c.wm = test::tiltedNormal(alpha, 2 * double(test::uniform(generator)), 6 * double(test::uniform(generator)));
          cases.push_back(c);
        }
      }
    }
    for (const Masking masking : kMaskings) {
      const auto results = evaluate(cases, ndf, masking);
      for (size_t i = 0; i < cases.size(); ++i) {
        const GgxCase& c = cases[i];
        const glm::dvec3 wo(c.wo), wi(c.wi), wm(c.wm);
        const glm::dvec2 alpha(c.alpha);
        const double visibility = oracle::facetG2({ndf, masking}, wo, wi, alpha) / (4 * wo.z * wi.z);
        EXPECT_NEAR(double(results[i].visibility), visibility, 1e-5 * visibility) << describe(ndf, c);
        const double seen = oracle::pdfFacetSeen(ndf, wo, wm, alpha);
        const double cancelled = std::ldexp(1.0, -22) / std::max(glm::dot(wo, wm), 1e-30);
        EXPECT_NEAR(double(results[i].pdfNormal), seen, (1e-5 + cancelled) * seen) << describe(ndf, c);
        if (seen > 0) {
          const double reflected = seen / (4 * glm::dot(wo, wm));
          EXPECT_NEAR(double(results[i].pdfReflection), reflected, (1e-5 + cancelled) * reflected) << describe(ndf, c);
        }
      }
    }
  }
}

// Chi-square of sampled normals, seen and unseen, against the oracle's densities, over 16 x 16 bins of the slope's
// azimuth and of s = 1 / sqrt(1 + slope^2 / 4). Significance 1e-3 over all cases (Sidak); 1e5 samples and 256 bins
// reject a density that is off by 3% root mean square. The integral of the density is 1 to 2e-3.
TEST(FacetDistribution, SampledNormalsFollowTheirDensity) {
  const int bins = 16;
  const int nodes = 40; // wide facets seen from near the horizon show a strip of half of them, 0.1 wide
  const size_t count = 100000;
  const std::pair<glm::vec2, double> cases[] = {{{0.01f, 0.01f}, 0.02}, {{0.1f, 0.1f}, 0.05}, {{0.5f, 0.5f}, 0.5},
                                                {{1, 1}, 0.1},          {{0.1f, 0.6f}, 0.3},  {{1e-3f, 1e-3f}, 0.5}};
  const Ndf ndfs[] = {Ndf::Beckmann, Ndf::BlinnPhong}; // of GGX: ggx_test.cpp
  const double significance = test::sidak(1e-3, 2 * std::size(ndfs) * std::size(cases));
  std::mt19937 generator(11);
  for (const Ndf ndf : ndfs) {
    for (const auto& [width, cosine] : cases) {
      GgxCase c = blank(width);
      c.wo = test::directionOf(cosine, 0.8);
      std::vector<GgxCase> inputs(count, c);
      for (GgxCase& input : inputs) {
        input.u = {test::uniform(generator), 0};
        input.u.y = test::uniform(generator);
        input.uSide = test::uniform(generator);
      }
      const glm::dvec2 alpha(width);
      const auto binOf = [&](const glm::vec3& normal) {
        const glm::dvec2 slope = glm::dvec2(normal) / double(normal.z) / alpha / 2.0;
        const int s = std::min(int(bins / std::sqrt(1 + glm::dot(slope, slope))), bins - 1);
        const int a = std::min(int(bins * (std::atan2(slope.y, slope.x) / (2 * pi) + 0.5)), bins - 1);
        return size_t(s * bins + a);
      };
      std::vector<uint64_t> seen(bins * bins), unseen(bins * bins);
      for (const GgxResult& result : evaluate(inputs, ndf)) {
        ++seen[binOf(result.sampled)];
        ++unseen[binOf(result.sampledUnseen)];
      }
      std::vector<double> expectedSeen(bins * bins), expectedUnseen(bins * bins);
      double mass = 0;
      for (int i = 0; i < bins * nodes; ++i) {
        for (int j = 0; j < bins * nodes; ++j) {
          const double s = (i + 0.5) / (bins * nodes);
          const double phi = 2 * pi * ((j + 0.5) / (bins * nodes) - 0.5);
          const double slope = 2 * std::sqrt(1 / (s * s) - 1);
          const glm::dvec3 wm =
              glm::normalize(glm::dvec3(alpha.x * slope * std::cos(phi), alpha.y * slope * std::sin(phi), 1));
          // dwm = wm.z^3 alpha.x alpha.y d(slope^2) / 2 dphi, d(slope^2) = 8 / s^3 ds
          const double solidAngle =
              std::pow(wm.z, 3) * alpha.x * alpha.y * 4 / std::pow(s, 3) * 2 * pi / std::pow(double(bins * nodes), 2);
          const size_t bin = size_t(i / nodes * bins + j / nodes);
          const double density = oracle::pdfFacetSeen(ndf, glm::dvec3(c.wo), wm, alpha);
          expectedSeen[bin] += double(count) * density * solidAngle;
          expectedUnseen[bin] += double(count) * oracle::facetD(ndf, wm, alpha) * wm.z * solidAngle;
          mass += density * solidAngle;
        }
      }
      EXPECT_NEAR(mass, 1, 2e-3) << describe(ndf, c);
      EXPECT_GT(test::chiSquareTest(seen, expectedSeen).p, significance) << describe(ndf, c);
      EXPECT_GT(test::chiSquareTest(unseen, expectedUnseen).p, significance) << describe(ndf, c);
    }
  }
}

TEST(FacetDistribution, SamplesStayInTheirDomainForExtremeRandomNumbers) {
  const float last = 1 - std::ldexp(1.0f, -24);
  for (const Ndf ndf : kNdfs) {
    std::vector<GgxCase> cases;
    for (const glm::vec2& alpha : kAlphas) {
      for (const double cosine : {1e-6, 0.05, 1.0}) {
        for (const float x : {0.0f, 0.25f, last}) {
          for (const float y : {0.0f, std::ldexp(1.0f, -24), 0.5f, last}) {
            for (const float side : {0.0f, last}) {
              GgxCase c = blank(alpha);
              c.wo = test::directionOf(cosine, 3.14159265);
              c.u = {x, y};
              c.uSide = side;
              cases.push_back(c);
            }
          }
        }
      }
    }
    for (const GgxResult& result : evaluate(cases, ndf)) {
      for (const glm::vec3& normal : {result.sampled, result.sampledUnseen}) {
        EXPECT_NEAR(double(glm::length(glm::dvec3(normal))), 1, 1e-6);
        EXPECT_GT(normal.z, 0);
      }
      EXPECT_TRUE(std::isfinite(result.pdfSampled));
      EXPECT_GE(result.pdfSampled, 0);
    }
  }
}
