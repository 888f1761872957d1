#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "glsl/fresnel_case.h"
#include "oracle/bsdf_fresnel.hpp"
#include "support/probe.hpp"
#include "test_glsl_kernels.hpp"

using namespace isophote;
using gpu::FresnelCase;
using gpu::FresnelResult;

namespace {

std::vector<FresnelResult> evaluate(const std::vector<FresnelCase>& cases) {
  return test::runProbe<FresnelCase, FresnelResult>(test_glsl_kernels::kernelSource("fresnel_probe"), cases);
}

float dielectric(double cosine, double eta) {
  return evaluate({{.cosine = float(cosine), .eta = float(eta)}})[0].dielectric;
}

// Midpoints of 2 cos dcos = d(cos^2).
double cosineWeightedMean(double eta) {
  const int count = 20000;
  std::vector<FresnelCase> cases(count);
  for (int i = 0; i < count; ++i) {
    cases[size_t(i)] = {.cosine = float(std::sqrt((i + 0.5) / count)), .eta = float(eta)};
  }
  double sum = 0;
  for (const FresnelResult& result : evaluate(cases)) sum += double(result.dielectric);
  return sum / count;
}

} // namespace

TEST(Fresnel, DielectricTakesTabulatedValuesForGlass) {
  const std::pair<double, double> table[] = {
      {0, 0.04}, {45, 0.0502399}, {56.30993247402021, 0.0739645}, {60, 0.0891867}, {80, 0.387704}};
  for (const auto& [degrees, expected] : table) {
    EXPECT_NEAR(dielectric(std::cos(degrees * std::numbers::pi / 180), 1.5), expected, 1e-6) << degrees;
  }
}

TEST(Fresnel, DielectricIsExactAtItsLimits) {
  for (const double cosine : {0.0, 1e-30, 1e-6, 0.1, 0.5, 0.999, 1.0}) EXPECT_EQ(dielectric(cosine, 1), 0.0f) << cosine;
  for (const double eta : {1 / 1.5, 1.5, 3.0, 1.0001}) EXPECT_NEAR(dielectric(0, eta), 1, 1e-6) << eta;
  // Total internal reflection from glass begins at cos = sqrt(1 - 1/2.25) = 0.745.
  for (const double cosine : {0.0, 0.3, 0.7, 0.745}) EXPECT_EQ(dielectric(cosine, 1 / 1.5), 1.0f) << cosine;
  EXPECT_LT(dielectric(0.7455, 1 / 1.5), 0.99f);
}

TEST(Fresnel, DielectricMeansAreThoseOfBothSidesOfGlass) {
  EXPECT_NEAR(cosineWeightedMean(1.5), 0.0917780, 1e-4);
  EXPECT_NEAR(cosineWeightedMean(1 / 1.5), 0.596346, 1e-4);
}

TEST(Fresnel, DielectricMatchesTheOracle) {
  std::vector<FresnelCase> cases;
  for (const double eta : {1 / 3.0, 0.5, 1 / 1.5, 0.9, 0.999, 1.0001, 1.01, 1.33, 1.5, 2.4, 3.0}) {
    for (int i = 0; i <= 2000; ++i) cases.push_back({.cosine = float(i) / 2000, .eta = float(eta)});
    for (const double cosine : {1e-30, 1e-12, 1e-6, 1e-4})
      cases.push_back({.cosine = float(cosine), .eta = float(eta)});
  }
  const auto results = evaluate(cases);
  double worst = 0;
  for (size_t i = 0; i < cases.size(); ++i) {
    const double cosine = double(cases[i].cosine);
    const double eta = double(cases[i].eta);
    const double expected = oracle::fresnelDielectric(cosine, eta);
    // The reflectance falls from 1 like g = sqrt(eta^2 - 1 + cos^2), whose square is rounded to 2^-23; slope <= 4 /
    // eta^2.
    const double g = std::sqrt(std::max(eta * eta - 1 + cosine * cosine, 0.0));
    const double slope = 4 / (std::min(eta, 1.0) * std::min(eta, 1.0));
    const double rounding = std::ldexp(1.0, -23);
    const double tolerance = 1e-6 + (g < 0.1 ? slope * rounding / std::max(g, std::sqrt(rounding)) : 0);
    const double error = std::abs(double(results[i].dielectric) - expected);
    EXPECT_LE(error, tolerance) << "cos " << cosine << " eta " << eta;
    if (g >= 0.1) worst = std::max(worst, error);
  }
  RecordProperty("worstErrorAwayFromCriticalAngle", std::to_string(worst));
}

TEST(Fresnel, SchlickMatchesTheOracleAndItsEndsAreExact) {
  std::vector<FresnelCase> cases;
  for (int i = 0; i <= 1000; ++i) {
    cases.push_back({.cosine = float(i) / 1000, .eta = 1, .f0 = {0.04f, 0, 0.9f}, .f90 = {1, 0.5f, 0}});
  }
  const auto results = evaluate(cases);
  for (size_t i = 0; i < cases.size(); ++i) {
    const glm::dvec3 expected =
        oracle::fresnelSchlick(glm::dvec3(cases[i].f0), glm::dvec3(cases[i].f90), double(cases[i].cosine));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(double(results[i].schlick[c]), expected[c], 5e-7) << cases[i].cosine;
  }
  EXPECT_EQ(results.back().schlick, cases.back().f0);
  EXPECT_EQ(results.front().schlick.y, 0.5f);
}
