// What one facet reflects: conductors and thin films.
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "glsl/bsdf_material_cases.hpp"
#include "glsl/facet_case.h"
#include "oracle/bsdf_fresnel.hpp"

using namespace isophote;
using gpu::FacetCase;
using gpu::FacetResult;

namespace {

std::vector<FacetResult> probeFacets(const std::vector<FacetCase>& cases) {
  return test::runProbe<FacetCase, FacetResult>(test_glsl_kernels::kernelSource("facet_probe"), cases);
}

std::vector<FacetCase> randomFacets(size_t count) {
  std::mt19937 generator(11);
  const auto u = [&generator] { return test::uniform(generator); };
  std::vector<FacetCase> cases(count);
  for (FacetCase& c : cases) {
    c.cosine = u();
    c.n = 0.05f + 4 * u();
    c.k = 6 * u();
    c.filmIor = 1 + 1.5f * u();
    c.thickness = 1500 * u();
    c.f0.x = u();
    c.f0.y = u() * u();
    c.f0.z = 0.04f;
    if ((&c - cases.data()) % 2 == 0) c.f0 = glm::vec3(0.1f * u()); // a dielectric
  }
  return cases;
}

} // namespace

TEST(Facet, ConductorMatchesComplexAmplitudes) {
  const auto cases = randomFacets(20000);
  const auto results = probeFacets(cases);
  for (size_t i = 0; i < cases.size(); ++i) {
    const double expected = oracle::fresnelConductor(double(cases[i].cosine), double(cases[i].n), double(cases[i].k));
    EXPECT_NEAR(double(results[i].conductor), expected, 2e-6)
        << cases[i].cosine << " " << cases[i].n << " " << cases[i].k;
  }
}

TEST(Facet, Test11ConductorWithoutAbsorptionIsADielectric) {
  auto cases = randomFacets(5000);
  for (FacetCase& c : cases) {
    c.k = 0;
    c.n = 1.01f + c.n;
  }
  cases[0] = {.cosine = 0, .n = 1.5f, .filmIor = 1.3f};
  cases[1] = {.cosine = 1, .n = 1.5f, .filmIor = 1.3f};
  const auto results = probeFacets(cases);
  for (size_t i = 0; i < cases.size(); ++i) {
    const double exact = oracle::fresnelDielectric(double(cases[i].cosine), double(cases[i].n));
    EXPECT_NEAR(double(results[i].conductor), double(results[i].dielectric), 2e-6) << cases[i].cosine;
    EXPECT_NEAR(double(results[i].conductor), exact, 2e-6) << cases[i].cosine;
  }
  EXPECT_EQ(results[0].conductor, 1);
}

// Reflectance at normal incidence is ((n-1)^2 + k^2) / ((n+1)^2 + k^2).
TEST(Facet, ConductorAtNormalIncidence) {
  const std::vector<FacetCase> cases{{.cosine = 1, .n = 0.2f, .k = 3.9f, .filmIor = 1.3f},
                                     {.cosine = 1, .n = 1.5f, .k = 7.6f, .filmIor = 1.3f},
                                     {.cosine = 1, .n = 1000, .k = 1000, .filmIor = 1.3f}};
  const auto results = probeFacets(cases);
  for (size_t i = 0; i < cases.size(); ++i) {
    const double n = double(cases[i].n), k = double(cases[i].k);
    const double expected = (std::pow(n - 1, 2) + k * k) / (std::pow(n + 1, 2) + k * k);
    EXPECT_NEAR(double(results[i].conductor), expected, 2e-6);
  }
}

// The phase is 2 pi 2.2 opd / um: at 1500 nm single precision knows it to 1e-5 of a turn.
TEST(Facet, FilmMatchesTheOracleWithinItsBound) {
  const auto cases = randomFacets(20000);
  const auto results = probeFacets(cases);
  double worstExcess = 0;
  for (size_t i = 0; i < cases.size(); ++i) {
    const FacetCase& c = cases[i];
    const oracle::ThinFilm film{1, double(c.filmIor), double(c.thickness)};
    const glm::dvec3 expected = oracle::filmReflectance(film, double(c.cosine), glm::dvec3(c.f0));
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(double(results[i].film[k]), expected[k], 5e-5) << c.cosine;
    EXPECT_NEAR(double(results[i].bound), oracle::filmBound(film, glm::dvec3(c.f0)), 2e-4);
    const double x = std::pow(1 - double(c.cosine), 5);
    const double coat = double(results[i].bound) * (1 - x) + x;
    if (i % 2 == 1) continue; // a metal's facets: nothing lies below them
    worstExcess = std::max(worstExcess, std::max({expected.x, expected.y, expected.z}) - coat);
  }
  RecordProperty("worstExcess", std::to_string(worstExcess));
  EXPECT_LT(worstExcess, 0.12); // of films above 600 nm with an index near 1; docs/bsdf-layers.md
}
