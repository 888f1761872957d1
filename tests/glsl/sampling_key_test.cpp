#include "glsl/sampling_key_case.h"

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "isophote/settings.hpp"
#include "shared/film_types.h"
#include "support/probe.hpp"
#include "support/statistics.hpp"
#include "test_glsl_kernels.hpp"

namespace isophote {
namespace {

using gpu::kReplicateCount;
using gpu::SamplingKeyCase;
using gpu::SamplingKeyResult;

constexpr uint32_t kSamplerConstant = 64; // id of kSampler in shared/settings.inc
constexpr double kLevel = 0.001;          // family-wise over the tests of one TEST

std::vector<SamplingKeyResult> run(const std::vector<SamplingKeyCase>& cases, SamplerKind kind) {
  const gpu::SpecConstant constants[] = {{kSamplerConstant, static_cast<uint32_t>(kind)}};
  return test::runProbe<SamplingKeyCase, SamplingKeyResult>(test_glsl_kernels::kernelSource("sampling_key_probe"),
                                                            cases, 0, constants);
}

uint32_t reverseBits(uint32_t x) {
  uint32_t result = 0;
  for (int bit = 0; bit < 32; ++bit) result |= (x >> bit & 1u) << (31 - bit);
  return result;
}

std::array<uint32_t, 4> hash(std::array<uint32_t, 4> v) {
  // x += y w, y += z x, z += x y, w += y z, each from what the last one left.
  const auto mix = [&] {
    v[0] += v[1] * v[3];
    v[1] += v[2] * v[0];
    v[2] += v[0] * v[1];
    v[3] += v[1] * v[2];
  };
  for (uint32_t& word : v) word = word * 1664525u + 1013904223u;
  mix();
  for (uint32_t& word : v) word ^= word >> 16;
  mix();
  return v;
}

/// Sobol coordinate from direction numbers: the identity, and x + 1 (Joe and Kuo 2008, dimensions 1 and 2).
uint32_t sobol(uint32_t index, int dimension) {
  uint32_t direction = 0x80000000u;
  uint32_t result = 0;
  for (int bit = 0; bit < 32; ++bit) {
    if (index >> bit & 1u) result ^= direction;
    direction = dimension == 0 ? direction >> 1 : direction ^ direction >> 1;
  }
  return result;
}

/// Nested uniform scrambling from the most significant bit down.
uint32_t scramble(uint32_t value, uint32_t seed) {
  uint32_t x = reverseBits(value);
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= seed >> 16 | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return reverseBits(x);
}

/// @param sequences  that the samples take turns in
glm::uvec2 oracleSobol(const SamplingKeyCase& c, uint32_t sequences) {
  const auto seeds = hash({c.pixel, c.pair * kReplicateCount + c.sampleIndex % sequences, c.seed.x, c.seed.y});
  const uint32_t index = scramble(c.sampleIndex / sequences, seeds[0]);
  return {scramble(sobol(index, 0), seeds[1]), scramble(sobol(index, 1), seeds[2])};
}

glm::uvec2 oracleIndependent(const SamplingKeyCase& c) {
  auto state = hash({c.pixel, c.sampleIndex, c.seed.x, c.seed.y});
  state[0] ^= c.pair;
  for (size_t i = 1; i < 4; ++i) state[i] = ~state[i];
  const auto result = hash(state);
  return {result[0], result[1]};
}

std::vector<SamplingKeyCase> randomKeys(uint32_t count) {
  std::mt19937 generator(2);
  std::vector<SamplingKeyCase> cases;
  for (uint32_t i = 0; i < count; ++i) {
    const uint32_t sampleIndex = static_cast<uint32_t>(generator()) >> (generator() % 32);
    cases.push_back({static_cast<uint32_t>(generator()),
                     sampleIndex,
                     {static_cast<uint32_t>(generator()), static_cast<uint32_t>(generator())},
                     static_cast<uint32_t>(generator()) >> (3 + generator() % 29)});
  }
  return cases;
}

TEST(Sampler, AllKindsMatchTheOracleToTheBit) {
  const auto cases = randomKeys(200'000);
  const auto sobolResults = run(cases, SamplerKind::Sobol);
  const auto jointResults = run(cases, SamplerKind::SobolJoint);
  const auto independentResults = run(cases, SamplerKind::Independent);
  for (size_t i = 0; i < cases.size(); ++i) {
    ASSERT_EQ(sobolResults[i].bits, oracleSobol(cases[i], kReplicateCount)) << i;
    ASSERT_EQ(jointResults[i].bits, oracleSobol(cases[i], 1)) << i;
    ASSERT_EQ(independentResults[i].bits, oracleIndependent(cases[i])) << i;
    for (int axis = 0; axis < 2; ++axis) {
      ASSERT_EQ(sobolResults[i].unit[axis], std::ldexp(static_cast<float>(sobolResults[i].bits[axis] >> 8), -24)) << i;
      ASSERT_LT(sobolResults[i].unit[axis], 1.0f);
    }
  }
}

/// Every aligned block of 2^m points of every sequence has exactly one point in each of its elementary intervals
/// 2^-a x 2^-(m-a). @param sequences  that the samples take turns in
void expectZeroTwoSequences(SamplerKind kind, uint32_t sequences) {
  const uint32_t log2Count = 9;
  const uint32_t count = 1u << log2Count;
  std::vector<SamplingKeyCase> cases;
  const uint32_t pixels[] = {0, 0x00010000, 0x12345678};
  const uint32_t pairs[] = {0, 1, 4095};
  for (const uint32_t pixel : pixels) {
    for (const uint32_t pair : pairs) {
      for (uint32_t sequence = 0; sequence < sequences; ++sequence) {
        for (uint32_t i = 0; i < count; ++i) cases.push_back({pixel, i * sequences + sequence, {7, 9}, pair});
      }
    }
  }
  const auto results = run(cases, kind);
  for (size_t sequence = 0; sequence < results.size() / count; ++sequence) {
    for (uint32_t m = 1; m <= log2Count; ++m) {
      for (uint32_t block = 0; block < count >> m; ++block) {
        for (uint32_t a = 0; a <= m; ++a) {
          std::vector<bool> seen(size_t{1} << m);
          for (uint32_t i = 0; i < 1u << m; ++i) {
            const glm::uvec2 bits = results[sequence * count + (block << m) + i].bits;
            const uint64_t column = static_cast<uint64_t>(bits.x) >> (32 - a);
            const uint64_t row = static_cast<uint64_t>(bits.y) >> (32 - (m - a));
            const size_t cell = static_cast<size_t>(column << (m - a) | row);
            ASSERT_FALSE(seen[cell]) << sequence << " " << m << " " << block << " " << a;
            seen[cell] = true;
          }
        }
      }
    }
  }
}

TEST(Sampler, EveryReplicateIsAZeroTwoSequence) { expectZeroTwoSequences(SamplerKind::Sobol, kReplicateCount); }

TEST(Sampler, JointReplicatesAreOneZeroTwoSequence) { expectZeroTwoSequences(SamplerKind::SobolJoint, 1); }

/// Counts of points in a square grid.
std::vector<uint64_t> grid(const std::vector<double>& x, const std::vector<double>& y, uint32_t size) {
  std::vector<uint64_t> counts(size * size);
  for (size_t i = 0; i < x.size(); ++i) {
    ++counts[static_cast<size_t>(y[i] * size) * size + static_cast<size_t>(x[i] * size)];
  }
  return counts;
}

/// p-value that pairs of numbers are independent and uniform: the smaller of chi-square on a 16 x 16 grid and
/// correlation, each of which may reject.
double independence(const std::vector<double>& x, const std::vector<double>& y) {
  const std::vector<double> expected(256, static_cast<double>(x.size()) / 256);
  const double p = std::min(test::chiSquareTest(grid(x, y, 16), expected).p, test::correlationTest(x, y));
  return 1 - (1 - p) * (1 - p);
}

/// One number per pixel of a 512 x 512 image.
std::vector<double> perPixel(SamplerKind kind, uint32_t sampleIndex, uint32_t pair, int axis, glm::uvec2 seed = {1, 0},
                             uint32_t shift = 0) {
  std::vector<SamplingKeyCase> cases;
  for (uint32_t y = 0; y < 512; ++y) {
    for (uint32_t x = 0; x < 512; ++x) cases.push_back({(x + shift) | y << 16, sampleIndex, seed, pair});
  }
  std::vector<double> values;
  for (const auto& result : run(cases, kind)) values.push_back(static_cast<double>(result.unit[axis]));
  return values;
}

// 262144 pixels: a correlation of 1.1% or a cell 15% off its share is seen.
TEST(Sampler, NumbersOfDifferentKeysAreIndependentAndUniform) {
  for (const SamplerKind kind : {SamplerKind::Sobol, SamplerKind::Independent}) {
    const auto base = perPixel(kind, 0, 2, 0);
    const double p[] = {
        independence(base, perPixel(kind, 0, 2, 1)),         // axes of a pair
        independence(base, perPixel(kind, 0, 3, 0)),         // neighbouring pairs
        independence(base, perPixel(kind, 0, 2 + 4, 0)),     // the same use at the next path vertex
        independence(base, perPixel(kind, 1, 2, 0)),         // replicates
        independence(base, perPixel(kind, 0, 2, 0, {2, 0})), // seeds
        independence(base, perPixel(kind, 0, 2, 0, {1, 1})),
        independence(base, perPixel(kind, 0, 2, 0, {1, 0}, 1)), // neighbouring pixels
        independence(perPixel(kind, 4096, 2, 0), perPixel(kind, 4097, 6, 1)),
    };
    const double level = test::sidak(kLevel, 2 * std::size(p));
    for (size_t i = 0; i < std::size(p); ++i) EXPECT_GT(p[i], level) << static_cast<int>(kind) << " " << i;
  }
}

TEST(Sampler, SampleRangesCanBeCutAnywhere) {
  // A pure function: the same key gives the same number whatever else is in the dispatch.
  const auto cases = randomKeys(1000);
  const std::vector<SamplingKeyCase> tail(cases.begin() + 613, cases.end());
  const auto all = run(cases, SamplerKind::Sobol);
  const auto part = run(tail, SamplerKind::Sobol);
  for (size_t i = 0; i < tail.size(); ++i) ASSERT_EQ(part[i].bits, all[613 + i].bits);
}

/// Variance over 200 pixels of one replicate's mean of a smooth function of two pairs, and the test of its expectation.
test::Moments integrate(SamplerKind kind, uint32_t count) {
  std::vector<SamplingKeyCase> cases;
  for (uint32_t pixel = 0; pixel < 200; ++pixel) {
    for (uint32_t i = 0; i < count; ++i) {
      for (uint32_t pair = 2; pair <= 3; ++pair) cases.push_back({pixel, i * kReplicateCount, {3, 4}, pair});
    }
  }
  const auto results = run(cases, kind);
  test::Moments means;
  for (uint32_t pixel = 0; pixel < 200; ++pixel) {
    double sum = 0;
    for (uint32_t i = 0; i < count; ++i) {
      for (uint32_t pair = 0; pair < 2; ++pair) {
        const glm::dvec2 u(results[(pixel * count + i) * 2 + pair].unit);
        sum += std::exp(u.x) * std::sin(2 * u.y + 0.3); // smooth, not symmetric
      }
    }
    means.add(sum / (2 * count));
  }
  return means;
}

// (e - 1) (cos 0.3 - cos 2.3) / 2
const double kSmoothIntegral = (std::exp(1.0) - 1) * 0.5 * (std::cos(0.3) - std::cos(2.3));

// Owen-scrambled (0,2)-sequences converge as N^-3 (variance) for smooth integrands, independent numbers as N^-1 (Owen
// 1997, "Scrambled Net Variance for Integrals of Smooth Functions").
TEST(Sampler, SobolConvergesFasterThanIndependentAndBothToTheIntegral) {
  const auto sobolFew = integrate(SamplerKind::Sobol, 16);
  const auto sobolMany = integrate(SamplerKind::Sobol, 1024);
  const auto independentFew = integrate(SamplerKind::Independent, 16);
  const auto independentMany = integrate(SamplerKind::Independent, 1024);
  const double level = test::sidak(kLevel, 4);
  for (const auto& means : {sobolFew, sobolMany, independentFew, independentMany}) {
    EXPECT_GT(test::meanTest(means, kSmoothIntegral), level);
  }
  // 64 times the samples: exponents from variances with 200 degrees of freedom are good to +-0.05.
  const double sobolExponent = std::log(sobolFew.variance() / sobolMany.variance()) / std::log(64.0);
  const double independentExponent = std::log(independentFew.variance() / independentMany.variance()) / std::log(64.0);
  RecordProperty("sobolVarianceExponent", std::to_string(sobolExponent));
  EXPECT_GT(sobolExponent, 2.5);
  EXPECT_NEAR(independentExponent, 1, 0.2);
}

// Pairs of one pixel are matched at random but for what every prefix of 2^m points being a net in each pair forces:
// samples 2k and 2k + 1 lie in opposite halves in every pair. A product of centered numbers, one from each of two
// pairs, has 9/16 of its variance between halves; that part counts twice, finer ones 1 + 2^-l times: 1.58 to 1.60 times
// the variance of independent numbers in all. 2048 pixels: the ratio is good to +-3%.
TEST(Sampler, PairsOfOnePixelAreMatchedAtRandomWithinNets) {
  const uint32_t pixels = 2048;
  const uint32_t count = 64;
  const uint32_t pairs[] = {2, 3, 6, 7};
  std::vector<SamplingKeyCase> cases;
  for (uint32_t pixel = 0; pixel < pixels; ++pixel) {
    for (uint32_t i = 0; i < count; ++i) {
      for (const uint32_t pair : pairs) cases.push_back({pixel, i * kReplicateCount + 5, {3, 4}, pair});
    }
  }
  const auto results = run(cases, SamplerKind::Sobol);
  for (uint32_t first = 0; first < 4; ++first) {
    for (uint32_t second = 0; second < first; ++second) {
      for (int axis = 0; axis < 2; ++axis) {
        test::Moments means;
        for (uint32_t pixel = 0; pixel < pixels; ++pixel) {
          double sum = 0;
          for (uint32_t i = 0; i < count; ++i) {
            const SamplingKeyResult* sample = &results[(pixel * count + i) * 4];
            sum += (sample[first].unit.x - 0.5) * (sample[second].unit[axis] - 0.5);
          }
          means.add(sum / count);
        }
        EXPECT_GT(test::meanTest(means, 0), test::sidak(kLevel, 12));
        EXPECT_NEAR(means.variance() * 144 * count, 1.59, 0.2);
      }
    }
  }
}

} // namespace
} // namespace isophote
