#include "support/statistics.hpp"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace isophote::test {
namespace {

constexpr uint32_t kSeed = 20240607;

// Values from closed forms: Q(1, x) = exp(-x), Q(1/2, x) = erfc(sqrt x), I_x(1, b) = 1 - (1 - x)^b, Student with 1 and
// 2 degrees of freedom.
TEST(Statistics, IncompleteGammaMatchesClosedForms) {
  for (const double x : {1e-6, 0.1, 0.9, 1.9, 2.1, 10.0, 50.0, 300.0}) {
    EXPECT_NEAR(incompleteGammaQ(1, x) / std::exp(-x), 1, 1e-10) << x;
    EXPECT_NEAR(incompleteGammaQ(0.5, x) / std::erfc(std::sqrt(x)), 1, 1e-10) << x;
    const double three = std::exp(-x) * (1 + x + x * x / 2);
    EXPECT_NEAR(incompleteGammaQ(3, x) / three, 1, 1e-10) << x;
  }
  EXPECT_EQ(incompleteGammaQ(4, 0), 1);
}

TEST(Statistics, IncompleteGammaOfLargeShapeMatchesThePoissonSum) {
  // Q(n, x) = P(Poisson(x) < n).
  for (const int n : {50, 400, 6000}) {
    for (const double z : {-3.0, -0.5, 0.0, 0.5, 3.0}) {
      const double x = n + z * std::sqrt(n);
      double sum = 0;
      for (int k = 0; k < n; ++k) sum += std::exp(k * std::log(x) - x - std::lgamma(k + 1.0));
      EXPECT_NEAR(incompleteGammaQ(n, x), sum, 1e-9) << n << " " << z;
    }
  }
}

TEST(Statistics, IncompleteBetaMatchesClosedForms) {
  for (const double x : {0.0, 1e-9, 0.01, 0.3, 0.5, 0.77, 0.999, 1.0}) {
    EXPECT_NEAR(incompleteBeta(1, 3.5, x), 1 - std::pow(1 - x, 3.5), 1e-13) << x;
    EXPECT_NEAR(incompleteBeta(2, 2, x), x * x * (3 - 2 * x), 1e-13) << x;
    EXPECT_NEAR(incompleteBeta(0.5, 0.5, x), 2 / M_PI * std::asin(std::sqrt(x)), 1e-12) << x;
  }
}

TEST(Statistics, StudentMatchesClosedForms) {
  for (const double t : {0.0, 0.1, 1.0, 4.5, 30.0}) {
    EXPECT_NEAR(studentTwoSided(t, 1), 1 - 2 / M_PI * std::atan(t), 1e-12);
    EXPECT_NEAR(studentTwoSided(-t, 2), 1 - t / std::sqrt(2 + t * t), 1e-12);
    EXPECT_NEAR(studentTwoSided(t, 1e8), normalTwoSided(t), 1e-6); // lgamma cancels to about 1e-7 there
  }
}

// Critical values computed for the project's test plan: family-wise 0.001.
TEST(Statistics, QuantilesMatchPublishedCriticalValues) {
  EXPECT_NEAR(normalTwoSidedQuantile(0.05), 1.959963985, 1e-8);
  EXPECT_NEAR(normalTwoSidedQuantile(sidak(0.001, 20)), 4.06, 0.01);
  EXPECT_NEAR(normalTwoSidedQuantile(sidak(0.001, 1000)), 4.89, 0.01);
  EXPECT_NEAR(studentTwoSidedQuantile(sidak(0.001, 20), 31), 4.70, 0.01);
  EXPECT_NEAR(studentTwoSidedQuantile(0.05, 10), 2.228139, 1e-5);
  EXPECT_NEAR(chiSquareSurvival(18.30704, 10), 0.05, 1e-6);
  EXPECT_EQ(normalTwoSided(0), 1);
}

TEST(Statistics, MomentsMatchTwoPassSums) {
  Moments moments;
  for (const double value : {1e9 + 4, 1e9 + 7, 1e9 + 13, 1e9 + 16}) moments.add(value);
  EXPECT_EQ(moments.count(), 4u);
  EXPECT_NEAR(moments.mean(), 1e9 + 10, 1e-6);
  EXPECT_NEAR(moments.variance(), 30, 1e-6);
  EXPECT_NEAR(moments.standardError(), std::sqrt(30.0 / 4), 1e-6);
}

std::vector<uint64_t> fill(std::mt19937& generator, const std::vector<double>& probabilities, int samples) {
  std::discrete_distribution<size_t> distribution(probabilities.begin(), probabilities.end());
  std::vector<uint64_t> counts(probabilities.size());
  for (int i = 0; i < samples; ++i) ++counts[distribution(generator)];
  return counts;
}

// 200 true hypotheses at level 0.1: a count outside [4, 40] has probability below 1e-5.
TEST(Statistics, ChiSquareRejectsTrueHypothesesAtItsLevel) {
  std::mt19937 generator(kSeed);
  std::vector<double> probabilities;
  for (int i = 0; i < 64; ++i) probabilities.push_back(std::exp(-0.15 * i)); // the tail has to be pooled
  double sum = 0;
  for (const double p : probabilities) sum += p;
  for (double& p : probabilities) p /= sum;
  const int samples = 4000;
  std::vector<double> expected;
  for (const double p : probabilities) expected.push_back(p * samples);
  int rejected = 0;
  uint64_t pooled = 0;
  for (int run = 0; run < 200; ++run) {
    const ChiSquareResult result = chiSquareTest(fill(generator, probabilities, samples), expected);
    rejected += result.p < 0.1;
    pooled = result.pooledBins;
  }
  EXPECT_GE(rejected, 4);
  EXPECT_LE(rejected, 40);
  EXPECT_GT(pooled, 0u);
}

// The power the probes rely on: 1e6 samples, 400 bins, half of them 1% too full. Non-centrality 1e6 * 1e-4 = 100
// against a standard deviation of 28 of the statistic.
TEST(Statistics, ChiSquareSeesAPlantedOnePercentBias) {
  std::mt19937 generator(kSeed);
  const int samples = 1'000'000;
  std::vector<double> fair(400, 1.0 / 400);
  std::vector<double> biased = fair;
  for (size_t i = 0; i < biased.size(); ++i) biased[i] *= i % 2 == 0 ? 1.01 : 0.99;
  const std::vector<double> expected(400, samples / 400.0);
  EXPECT_GT(chiSquareTest(fill(generator, fair, samples), expected).p, 0.001);
  EXPECT_LT(chiSquareTest(fill(generator, biased, samples), expected).p, 0.05);
  // With bias in the same direction over a hemisphere (16 coarse bins) the same 1% is far beyond any level used.
  std::vector<double> coarse(16, 1.0 / 16);
  for (size_t i = 0; i < coarse.size(); ++i) coarse[i] *= i < 8 ? 1.01 : 0.99;
  EXPECT_LT(chiSquareTest(fill(generator, coarse, samples), std::vector<double>(16, samples / 16.0)).p, 1e-9);
}

TEST(Statistics, ChiSquareRejectsSamplesWhereNoneAreExpected) {
  const std::vector<uint64_t> observed{500, 500, 1};
  const std::vector<double> expected{500, 501, 0};
  const ChiSquareResult result = chiSquareTest(observed, expected);
  EXPECT_EQ(result.p, 0);
  EXPECT_GT(result.stray, 9e-4);
}

TEST(Statistics, MeanTestAcceptsTheTruthAndSeesAPlantedOnePercentBias) {
  std::mt19937 generator(kSeed);
  std::exponential_distribution<double> distribution(1);
  Moments values;
  for (int i = 0; i < 1'000'000; ++i) values.add(distribution(generator));
  EXPECT_GT(meanTest(values, 1), 0.001);
  EXPECT_LT(meanTest(values, 1.01), 1e-9); // 1% is 10 standard errors
}

TEST(Statistics, MeanTestOfConstantsComparesThem) {
  Moments constant;
  constant.add(2);
  constant.add(2);
  EXPECT_EQ(meanTest(constant, 2), 1);
  EXPECT_EQ(meanTest(constant, 2.001), 0);
  Moments broken;
  broken.add(1);
  broken.add(std::nan(""));
  EXPECT_EQ(meanTest(broken, 1), 0);
}

TEST(Statistics, WelchTestComparesMeansOfUnequalVariance) {
  std::mt19937 generator(kSeed);
  std::normal_distribution<double> narrow(5, 0.1);
  std::normal_distribution<double> wide(5, 3);
  Moments a;
  Moments b;
  Moments shifted;
  for (int i = 0; i < 2000; ++i) {
    const double value = narrow(generator);
    a.add(value);
    shifted.add(1.1 * value);
  }
  for (int i = 0; i < 50000; ++i) b.add(wide(generator));
  EXPECT_GT(welchTest(a, b), 0.001);
  EXPECT_LT(welchTest(shifted, b), 1e-9);
}

TEST(Statistics, CorrelationTestSeesOnePercent) {
  std::mt19937 generator(kSeed);
  std::normal_distribution<double> distribution;
  std::vector<double> a;
  std::vector<double> b;
  std::vector<double> mixed;
  for (int i = 0; i < 400'000; ++i) {
    a.push_back(distribution(generator));
    b.push_back(distribution(generator));
    mixed.push_back(b.back() + 0.01 * a.back()); // 6.3 standard errors
  }
  EXPECT_GT(correlationTest(a, b), 0.001);
  EXPECT_LT(correlationTest(a, mixed), 1e-6);
}

} // namespace
} // namespace isophote::test
