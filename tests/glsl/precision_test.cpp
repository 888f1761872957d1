#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "glsl/precision_case.h"
#include "support/probe.hpp"
#include "test_glsl_kernels.hpp"

using namespace isophote;

namespace {

/// Significands of full length, exponents in [-20, 20], signs of both kinds. Half of the cases make a b - c d cancel: d
/// is a b / c, rounded.
std::vector<gpu::ExactCase> exactCases() {
  std::mt19937 generator(60);
  std::uniform_real_distribution<float> significand(1, 2);
  std::uniform_int_distribution<int> exponent(-20, 20);
  const auto draw = [&] {
    const float value = std::ldexp(significand(generator), exponent(generator));
    return generator() % 2 == 0 ? value : -value;
  };
  std::vector<gpu::ExactCase> cases;
  for (int i = 0; i < 20000; ++i) {
    gpu::ExactCase c{draw(), draw(), draw(), draw()};
    if (i % 2 == 1) c.d = c.a * c.b / c.c;
    cases.push_back(c);
  }
  return cases;
}

std::vector<gpu::ExactResult> runExact(const std::vector<gpu::ExactCase>& cases) {
  const auto& kernel = test_glsl_kernels::kernelSource("precision_exact_probe");
  return test::runProbe<gpu::ExactCase, gpu::ExactResult>(kernel, cases);
}

/// Distance in units of the last place of the single-precision number nearest to `exact`.
double ulps(float value, double exact) {
  const double unit = std::ldexp(1.0, std::ilogb(static_cast<float>(exact)) - 23);
  return std::abs(static_cast<double>(value) - exact) / unit;
}

} // namespace

TEST(FloatBits, NonFiniteValuesAreRecognizedByTheirBits) {
  const std::vector<gpu::NonFiniteCase> nonFinite{{0x7fc00000}, {0xffc00000}, {0x7f800001}, {0xff800001},
                                                  {0x7fffffff}, {0x7f800000}, {0xff800000}};
  const std::vector<gpu::NonFiniteCase> finite{{0},          {0x80000000}, {1},          {0x807fffff}, {0x00800000},
                                               {0x3f800000}, {0xbf800000}, {0x7f7fffff}, {0xff7fffff}};
  const auto& kernel = test_glsl_kernels::kernelSource("precision_nonfinite_probe");
  for (const auto& result : test::runProbe<gpu::NonFiniteCase, gpu::NonFiniteResult>(kernel, nonFinite)) {
    EXPECT_EQ(result.scalar, 1u);
    EXPECT_EQ(result.components, 7u);
  }
  for (const auto& result : test::runProbe<gpu::NonFiniteCase, gpu::NonFiniteResult>(kernel, finite)) {
    EXPECT_EQ(result.scalar, 0u);
    EXPECT_EQ(result.components, 0u);
  }
}

TEST(Precise, SumAndItsErrorAddUpExactly) {
  const auto cases = exactCases();
  const auto results = runExact(cases);
  for (size_t i = 0; i < cases.size(); ++i) {
    const double exact = static_cast<double>(cases[i].a) + cases[i].b; // 24 + 24 bits at most 41 apart: may round
    ASSERT_EQ(results[i].sum.x, cases[i].a + cases[i].b) << i;
    ASSERT_EQ(static_cast<double>(results[i].sum.x) + results[i].sum.y, exact) << i;
  }
}

TEST(ExactProduct, ProductAndItsErrorAddUpExactly) {
  const auto cases = exactCases();
  const auto results = runExact(cases);
  for (size_t i = 0; i < cases.size(); ++i) {
    const double exact = static_cast<double>(cases[i].a) * cases[i].b; // 48 bits: exact
    ASSERT_EQ(results[i].product.x, cases[i].a * cases[i].b) << i;
    ASSERT_EQ(static_cast<double>(results[i].product.x) + results[i].product.y, exact) << i;
  }
}

TEST(ExactProduct, DifferenceOfProductsIsWithinTwoUlpAlsoWhereItCancels) {
  const auto cases = exactCases();
  const auto results = runExact(cases);
  double worst = 0;
  double worstNaive = 0;
  for (size_t i = 0; i < cases.size(); ++i) {
    const auto& c = cases[i];
    // Both products are exact in double; where they cancel so is the difference, elsewhere it is right to 2^-53.
    const double exact = static_cast<double>(c.a) * c.b - static_cast<double>(c.c) * c.d;
    if (exact == 0) {
      ASSERT_EQ(results[i].difference, 0.0f) << i;
      continue;
    }
    worst = std::max(worst, ulps(results[i].difference, exact));
    worstNaive = std::max(worstNaive, ulps(c.a * c.b - c.c * c.d, exact));
  }
  EXPECT_LT(worst, 2.0);
  EXPECT_GT(worstNaive, 1e6) << "the cases are no test";
}
