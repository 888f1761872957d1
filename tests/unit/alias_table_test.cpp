#include "upload/alias_table.hpp"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace isophote {
namespace {

/// What the table's bins add up to for each entry, in double.
std::vector<double> probabilities(const std::vector<gpu::AliasEntry>& table) {
  std::vector<double> result(table.size(), 0.0);
  for (size_t bin = 0; bin < table.size(); ++bin) {
    const double threshold = table[bin].threshold;
    result[bin] += threshold / static_cast<double>(table.size());
    result.at(table[bin].alias) += (1 - threshold) / static_cast<double>(table.size());
  }
  return result;
}

/// Bins and pmf agree with the weights, and the pmf sums to 1.
void expectMatches(const std::vector<double>& weights, double tolerance) {
  const auto table = buildAliasTable(weights);
  ASSERT_EQ(table.size(), weights.size());
  long double sum = 0;
  for (const double weight : weights) sum += weight;
  const auto realized = probabilities(table);
  double total = 0;
  for (size_t i = 0; i < weights.size(); ++i) {
    const double expected = static_cast<double>(weights[i] / sum);
    ASSERT_NEAR(table[i].pmf, expected, 1e-7 * expected) << i;
    ASSERT_NEAR(realized[i], expected, tolerance * expected) << i;
    total += table[i].pmf;
  }
  EXPECT_NEAR(total, 1, 1e-6);
}

TEST(AliasTable, BinsAddUpToTheWeights) {
  std::mt19937 generator(54);
  std::exponential_distribution<double> weight;
  for (const size_t count : {1, 2, 3, 7, 100, 10'000}) {
    std::vector<double> weights(count);
    for (double& w : weights) w = weight(generator);
    expectMatches(weights, 1e-6);
  }
}

TEST(AliasTable, EqualWeightsOfAHundredThousandLightsKeepTheirShare) {
  expectMatches(std::vector<double>(100'000, 0.3), 1e-6);
}

TEST(AliasTable, OneLightMayDominateAMillionTimes) {
  std::vector<double> weights(100'000, 1.0);
  weights[77] = 1e6;
  expectMatches(weights, 1e-6);
  std::vector<double> wide;
  for (int e = -30; e <= 30; ++e) wide.push_back(std::pow(10.0, 0.5 * e));
  expectMatches(wide, 1e-6);
}

TEST(AliasTable, WeightsNearTheEndsOfDoubleAreRescaled) {
  expectMatches({1e308, 1e308, 1e308, 5e307}, 1e-6);
  expectMatches({1e-300, 3e-300}, 1e-6);
}

TEST(AliasTable, ZeroWeightsAreNeverChosen) {
  std::mt19937 generator(55);
  std::uniform_real_distribution<double> weight;
  for (int run = 0; run < 400; ++run) {
    std::vector<double> weights(1 + generator() % 300);
    const bool equal = run % 2 == 0; // heights such as 7/3, whose rounding leaves a bin short at the end
    for (double& w : weights) w = generator() % 3 != 0 ? 0 : equal ? 0.7 : weight(generator);
    weights[generator() % weights.size()] = 0.7;
    const auto table = buildAliasTable(weights);
    for (size_t i = 0; i < table.size(); ++i) {
      if (weights[i] > 0) {
        EXPECT_GT(table[i].pmf, 0);
        continue;
      }
      EXPECT_EQ(table[i].threshold, 0) << run << " " << i;
      EXPECT_EQ(table[i].pmf, 0);
      EXPECT_GT(weights[table[i].alias], 0);
    }
    for (const auto& entry : table) EXPECT_TRUE(entry.threshold >= 1 || weights[entry.alias] > 0);
  }
}

TEST(AliasTable, SharesBelowTheRangeOfFloatCountAsZero) {
  const auto table = buildAliasTable(std::vector<double>{1, 1e-39, 2});
  EXPECT_EQ(table[1].pmf, 0);
  EXPECT_EQ(table[1].threshold, 0);
}

TEST(AliasTable, NoPowerGivesNoTable) {
  EXPECT_TRUE(buildAliasTable({}).empty());
  EXPECT_TRUE(buildAliasTable(std::vector<double>{0, 0, 0}).empty());
}

} // namespace
} // namespace isophote
