// Noise and bias told apart on images whose noise and bias are known.
#include <cmath>
#include <functional>
#include <random>

#include <gtest/gtest.h>

#include "isophote/error.hpp"
#include "isophote/error_split.hpp"
#include "isophote/trade_off.hpp"

namespace isophote {
namespace {

constexpr uint32_t kSide = 16;
constexpr uint32_t kReplicates = 8;

/// The truth of value `i`: 0.5 to 2.
double truth(size_t i) { return 0.5 + 0.1 * static_cast<double>(i * 7 % 16); }

/// An image of eight replicates: `truth` times 1 + `bias`(value), with normal noise of `noise` times the truth.
Image drawn(uint64_t seed, double noise, const std::function<double(size_t)>& bias) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Image image{.width = kSide, .height = kSide};
  for (const char* name : {"R", "G", "B", "stderr.R", "stderr.G", "stderr.B"})
    image.channels.push_back({name, std::vector<float>(size_t{kSide} * kSide)});
  for (size_t c = 0; c < 3; ++c) {
    for (size_t pixel = 0; pixel < size_t{kSide} * kSide; ++pixel) {
      const size_t i = 3 * pixel + c;
      double sum = 0, squares = 0;
      for (uint32_t r = 0; r < kReplicates; ++r) {
        const double x = normal(random);
        sum += x;
        squares += x * x;
      }
      const double scale = noise * truth(i) * std::sqrt(double(kReplicates));
      const double variance = (squares - sum * sum / kReplicates) / (kReplicates - 1);
      image.channels[c].values[pixel] = static_cast<float>(truth(i) * (1 + bias(i)) + scale * sum / kReplicates);
      image.channels[3 + c].values[pixel] = static_cast<float>(scale * std::sqrt(variance / kReplicates));
    }
  }
  return image;
}

const std::function<double(size_t)> kNone = [](size_t) { return 0.0; };

/// What 300 studies of four runs say, each with a reference of its own.
struct Studies {
  double noiseSquare = 0; ///< means
  double biasSquare = 0;
  double totalSquare = 0;
  double brightness = 0;
  int biasCovered = 0;
  int brightnessCovered = 0;
  int noiseCovered = 0;
  int biasSeen = 0; ///< by one of the two, at 3.3 deviations
};
constexpr int kStudies = 300;

Studies study(double noise, double referenceNoise, const std::function<double(size_t)>& bias, double biasSquare,
              double brightness) {
  Studies studies;
  for (uint64_t s = 0; s < kStudies; ++s) {
    ErrorSplitter splitter(drawn(10 * s, referenceNoise, kNone));
    for (uint64_t run = 1; run <= 4; ++run) splitter.add(drawn(10 * s + run, noise, bias));
    const ErrorSplit split = splitter.split();
    studies.noiseSquare += split.noiseSquare.value / kStudies;
    studies.biasSquare += split.biasSquare.value / kStudies;
    studies.totalSquare += split.totalSquare.value / kStudies;
    studies.brightness += split.brightness.value / kStudies;
    studies.noiseCovered += split.noiseSquare.holds(noise * noise) ? 1 : 0;
    studies.biasCovered += split.biasSquare.holds(biasSquare) ? 1 : 0;
    studies.brightnessCovered += split.brightness.holds(brightness) ? 1 : 0;
    studies.biasSeen += std::max(split.biasDeviations, std::abs(split.brightnessDeviations)) > 3.3 ? 1 : 0;
  }
  return studies;
}

// The standard deviation of a covered share of 95% over 300 studies is 1.3%: within 91.5% and, for intervals that may
// be too wide, 100%. The squares are relative to the reference instead of the truth: an error of its relative variance.
TEST(ErrorSplit, FindsNoBiasInTheNoiseOfRunsAndReference) {
  const Studies studies = study(0.1, 0.05, kNone, 0, 0);
  EXPECT_NEAR(studies.noiseSquare, 0.01, 0.0002);
  // Its own deviation is 4e-6, the reference's noise in the weights adds 6 v^2 = 4e-5; v itself is 2.5e-3.
  EXPECT_NEAR(studies.biasSquare, 0, 8e-5);
  EXPECT_NEAR(studies.brightness, 0, 5e-4);
  EXPECT_GE(studies.biasCovered, 0.915 * kStudies);
  EXPECT_GE(studies.brightnessCovered, 0.915 * kStudies);
  EXPECT_LE(studies.brightnessCovered, 0.985 * kStudies);
  EXPECT_GE(studies.noiseCovered, 0.9 * kStudies);
  EXPECT_LE(studies.biasSeen, 5); // 0.1% each way expected
}

TEST(ErrorSplit, MeasuresABiasBelowTheNoise) {
  // +6% and -2% in turn: RMS sqrt(0.002), mean near 2%, under noise of 10%.
  const auto bias = [](size_t i) { return i / 3 % 2 == 0 ? 0.06 : -0.02; };
  double sum = 0, whole = 0;
  for (size_t i = 0; i < size_t{3} * kSide * kSide; ++i) {
    sum += bias(i) * truth(i);
    whole += truth(i);
  }
  const Studies studies = study(0.1, 0.02, bias, 0.002, sum / whole);
  EXPECT_NEAR(studies.biasSquare, 0.002, 6e-5); // the weights: 4 v times the mean bias = 3e-5
  EXPECT_NEAR(studies.totalSquare, 0.012, 2e-4);
  EXPECT_NEAR(studies.brightness, sum / whole, 5e-4);
  EXPECT_GE(studies.biasCovered, 0.915 * kStudies);
  EXPECT_GE(studies.brightnessCovered, 0.915 * kStudies);
  EXPECT_EQ(studies.biasSeen, kStudies);
}

// The test's own test: a bias of 1% everywhere is seen in each study, under noise of 5%.
TEST(ErrorSplit, SeesABiasOfOnePercent) {
  EXPECT_EQ(study(
                0.05, 0.01, [](size_t) { return 0.01; }, 1e-4, 0.01)
                .biasSeen,
            kStudies);
}

TEST(ErrorSplit, KnowsNothingOfBiasFromOneRun) {
  ErrorSplitter splitter(drawn(1, 0.1, kNone));
  splitter.add(drawn(2, 0.1, kNone));
  EXPECT_TRUE(std::isinf(splitter.split().biasSquare.upper));
  EXPECT_NEAR(splitter.referenceSquare(), 0.01, 0.001);
}

TEST(ErrorSplit, ShowsMeanAndDifference) {
  ErrorSplitter splitter(drawn(1, 0, kNone));
  splitter.add(drawn(2, 0, [](size_t) { return 0.1; }));
  EXPECT_NEAR(splitter.meanImage().find("G")->values[5], 1.1 * truth(16), 1e-5);
  EXPECT_NEAR(splitter.differenceImage().find("G")->values[5], 0.1, 1e-3);
}

TEST(ErrorSplit, RefusesAReferenceWithoutErrorBars) {
  Image image = drawn(1, 0.1, kNone);
  image.channels.resize(3);
  EXPECT_THROW(ErrorSplitter{image}, UsageError);
}

// As of a denoised image. The mean of 300 studies of 1536 pairs of values each: noise to 0.3%, bias^2 to 6e-5.
TEST(ErrorSplit, TellsTheNoiseOfRunsWithoutErrorBarsByHowTheyDiffer) {
  const auto bias = [](size_t i) { return i / 3 % 2 == 0 ? 0.06 : -0.02; };
  double noise = 0, biasSquare = 0, brightnessSquares = 0;
  for (int study = 0; study < kStudies; ++study) {
    const auto seed = static_cast<uint64_t>(100 * study);
    ErrorSplitter splitter(drawn(seed, 0.001, kNone));
    for (uint64_t run = 1; run <= 3; ++run) {
      Image image = drawn(seed + run, 0.1, bias);
      image.channels.resize(3);
      splitter.add(image);
    }
    const ErrorSplit split = splitter.split();
    noise += split.noiseSquare.value / kStudies;
    biasSquare += split.biasSquare.value / kStudies;
    const double halfWidth = (split.brightness.upper - split.brightness.lower) / 2;
    brightnessSquares += halfWidth * halfWidth / kStudies;
    EXPECT_EQ(splitter.noiseSquares()[0], splitter.noiseSquares()[1]);
  }
  EXPECT_NEAR(noise, 0.01, 1e-4); // e, 1% of the mean, takes less from it
  EXPECT_NEAR(biasSquare, 0.002, 6e-5);
  // Normal 95% of the root of the sum over 768 values of squared errors, over their sum; a mean of three runs.
  double squares = 0, whole = 0;
  for (size_t i = 0; i < size_t{3} * kSide * kSide; ++i) {
    squares += 0.01 * truth(i) * truth(i) / 3;
    whole += truth(i);
  }
  EXPECT_NEAR(brightnessSquares / (1.96 * 1.96 * squares / (whole * whole)), 1,
              0.3); // 600 squares of one deviation: 8%
}

TEST(Interval, OfTheMeanOfThreeValues) {
  // Student's t of two degrees of freedom: 4.30265.
  const double values[] = {1, 2, 3};
  const Interval interval = meanInterval(values);
  EXPECT_DOUBLE_EQ(interval.value, 2);
  EXPECT_NEAR(interval.upper, 2 + 4.30265 / std::sqrt(3.0), 1e-4);
  EXPECT_TRUE(std::isinf(meanInterval({values, 1}).upper));
}

TEST(Interval, OfPairsForgetsWhatBothSuffer) {
  // The machine is 1, 5 and 2 times as slow; the ratio is 3 throughout.
  const double a[] = {3, 15, 6.06}, b[] = {1, 5, 2};
  const Interval ratio = ratioInterval(a, b);
  EXPECT_NEAR(ratio.value, 3.01, 0.01);
  EXPECT_LT(ratio.upper, 3.06);
}

TEST(TradeOff, TimeAndErrorFollowFromEachOther) {
  const TradeOff way{.cost = 0.04, .biasSquare = 1e-4};
  EXPECT_DOUBLE_EQ(errorAfter(way, 1), std::sqrt(0.0401));
  EXPECT_NEAR(secondsToError(way, errorAfter(way, 7)), 7, 1e-9);
  EXPECT_TRUE(std::isinf(secondsToError(way, 0.01)));
}

TEST(TradeOff, TheFrontHoldsWhatNothingBeats) {
  const TradeOff ways[] = {{4, 0}, {2, 1}, {3, 1}, {1, 5}, {4, 0}, {5, 0}, {1, 6}};
  EXPECT_EQ(paretoFront(ways), (std::vector<size_t>{3, 1, 0}));
}

} // namespace
} // namespace isophote
