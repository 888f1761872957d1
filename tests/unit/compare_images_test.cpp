// The numbers of a comparison and its verdict. Images here are means of 8 replicates with normal noise, so that the
// hypotheses of the test hold exactly; all seeds are fixed.
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "isophote/compare.hpp"
#include "isophote/error.hpp"

namespace isophote {
namespace {

constexpr uint32_t kReplicates = 8;
const char* const kColors[] = {"R", "G", "B"};

using Field = std::function<double(uint32_t x, uint32_t y)>;

/// An image whose pixels estimate `mean` with a true standard error of `error`.
Image estimated(uint32_t size, uint32_t seed, const Field& mean, const Field& error) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Image image;
  image.width = image.height = size;
  const size_t pixels = size_t(size) * size;
  for (const char* color : kColors) {
    Channel value{color, std::vector<float>(pixels)};
    Channel deviation{std::string("stderr.") + color, std::vector<float>(pixels)};
    for (uint32_t i = 0; i < pixels; ++i) {
      double sum = 0;
      double squares = 0;
      for (uint32_t r = 0; r < kReplicates; ++r) {
        const double x = normal(random);
        sum += x;
        squares += x * x;
      }
      const double variance = (squares - sum * sum / kReplicates) / (kReplicates - 1);
      const double scale = error(i % size, i / size) * std::sqrt(double(kReplicates));
      value.values[i] = static_cast<float>(mean(i % size, i / size) + scale * sum / kReplicates);
      deviation.values[i] = static_cast<float>(scale * std::sqrt(variance / kReplicates));
    }
    image.channels.push_back(std::move(value));
    image.channels.push_back(std::move(deviation));
  }
  return image;
}

Field constant(double value) {
  return [=](uint32_t, uint32_t) { return value; };
}

/// 0.2 to 2 over the image, so that neighbours differ in noise as in a render.
double scene(uint32_t x, uint32_t y) { return 0.2 + 0.1 * ((x * 7 + y * 3) % 19); }

Image sceneImage(uint32_t size, uint32_t seed, double relativeError, double bias = 0) {
  return estimated(
      size, seed, [=](uint32_t x, uint32_t y) { return scene(x, y) * (1 + bias); },
      [=](uint32_t x, uint32_t y) { return scene(x, y) * relativeError; });
}

Verdict verdictOf(const Image& a, const Image& b) { return compareImages(a, b).verdict.value(); }

struct Acceptance {
  int same = 0;
  int below5Percent = 0;
};

Acceptance acceptance(double errorA, double errorB) {
  Acceptance result;
  for (uint32_t seed = 0; seed < 200; ++seed) {
    const Verdict verdict = verdictOf(sceneImage(16, 2 * seed, errorA), sceneImage(16, 2 * seed + 1, errorB));
    result.same += verdict.same ? 1 : 0;
    result.below5Percent += verdict.p < 0.05 ? 1 : 0;
  }
  return result;
}

// Both images noisy: the bound on the degrees of freedom makes a false alarm rarer than 1e-4.
TEST(CompareVerdict, AcceptsTwoRendersOfOneSceneIn200Of200Seeds) {
  EXPECT_EQ(acceptance(0.05, 0.05).same, 200);
  EXPECT_EQ(acceptance(0.05, 0.02).same, 200);
}

// One image much less noisy than the other: the test is exact. At the family-wise level 0.001, 0.2 false alarms are
// expected in 200 and three or more happen with probability 1e-3.
TEST(CompareVerdict, HasTheStatedLevelAgainstAnAlmostExactReference) {
  const Acceptance result = acceptance(0.05, 0.0001);
  EXPECT_GE(result.same, 198);
  // Binomial(200, 0.05): below 2 or above 22 with probability 6e-4.
  EXPECT_LE(result.below5Percent, 22);
  EXPECT_GE(result.below5Percent, 2);
}

// 1% at 5% noise a pixel: 9 standard errors of the 64 x 64 mean. Smallest bias seen at this size with 99%: 0.8%.
TEST(CompareVerdict, CatchesAPlantedBiasOfOnePercent) {
  for (uint32_t seed = 0; seed < 20; ++seed) {
    const Verdict verdict = verdictOf(sceneImage(64, 100 + seed, 0.05, 0.01), sceneImage(64, 200 + seed, 0.05));
    EXPECT_FALSE(verdict.same) << seed;
    EXPECT_LT(verdict.p, 0.001) << seed;
  }
}

TEST(CompareVerdict, DoesNotSeeABiasFarBelowTheNoise) {
  EXPECT_TRUE(verdictOf(sceneImage(64, 1, 0.05, 0.0002), sceneImage(64, 2, 0.05)).same);
}

// 0.4% of the pixels: a test of 99.9% of the pixels at a per-pixel level sees nothing, the block does.
TEST(CompareVerdict, CatchesABiasInOneBlockOf4x4) {
  for (uint32_t seed = 0; seed < 20; ++seed) {
    const auto biased = [](uint32_t x, uint32_t y) { return scene(x, y) * (x / 4 == 5 && y / 4 == 9 ? 1.25 : 1.0); };
    const Image a = estimated(64, 300 + seed, biased, [](uint32_t x, uint32_t y) { return 0.05 * scene(x, y); });
    const Verdict verdict = verdictOf(a, sceneImage(64, 400 + seed, 0.05));
    EXPECT_FALSE(verdict.same) << seed;
    EXPECT_GE(verdict.failingBlocks, 1u) << seed;
    EXPECT_GE(verdict.passingFraction, 0.999) << seed;
  }
}

// Mitsuba's hole: every pixel far off in 0.25% of the image.
TEST(CompareVerdict, CatchesAFewPixelsThatAreFarOff) {
  Image a = sceneImage(64, 1, 0.01);
  for (Channel& channel : a.channels) {
    if (channel.name == "R") channel.values[64 * 20 + 33] *= 4;
  }
  const Verdict verdict = verdictOf(a, sceneImage(64, 2, 0.01));
  EXPECT_FALSE(verdict.same);
  EXPECT_GE(verdict.failingBlocks, 1u);
}

// 8 replicates have heavy tails: of 1.2e6 differences with 7 degrees of freedom, two thousand lie beyond z = 4.9, where
// the normal distribution would have one.
TEST(CompareVerdict, KeepsItsLevelInTheTailsOfEightReplicates) {
  const Verdict verdict = verdictOf(sceneImage(640, 5, 0.05), sceneImage(640, 6, 0.0001));
  EXPECT_TRUE(verdict.same);
  EXPECT_EQ(verdict.passingFraction, 1);
  EXPECT_GT(verdict.p, 0.001);
}

TEST(CompareVerdict, ExactZerosAndExactEqualsAreTheSame) {
  const Image black = estimated(8, 1, constant(0), constant(0));
  EXPECT_TRUE(verdictOf(black, black).same);
  EXPECT_EQ(verdictOf(black, black).p, 1);
  const Image grey = estimated(8, 1, constant(0.5), constant(0));
  EXPECT_TRUE(verdictOf(grey, grey).same);
  EXPECT_EQ(compareImages(black, black).relMse, 0);
}

TEST(CompareVerdict, NoiselessPixelsMayDifferByRoundingOnly) {
  const Image grey = estimated(8, 1, constant(0.5), constant(0));
  EXPECT_TRUE(verdictOf(grey, estimated(8, 1, constant(0.5 * (1 + 3e-6)), constant(0))).same);
  const Verdict off = verdictOf(grey, estimated(8, 1, constant(0.5 * (1 + 3e-5)), constant(0)));
  EXPECT_FALSE(off.same);
  EXPECT_EQ(off.p, 0);
}

TEST(CompareVerdict, UnknownErrorsAreInconclusiveNotPassing) {
  const auto spoiled = [](float value, size_t count, const char* name) {
    Image image = sceneImage(64, 1, 0.05);
    for (Channel& channel : image.channels) {
      if (channel.name == name) std::fill_n(channel.values.begin(), count, value);
    }
    return image;
  };
  const Image reference = sceneImage(64, 2, 0.05);
  const float infinity = std::numeric_limits<float>::infinity();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const float value : {infinity, nan}) {
    for (const char* name : {"stderr.G", "G"}) {
      EXPECT_FALSE(verdictOf(spoiled(value, 20, name), reference).same); // 20 of 12288 values are more than 0.1%
      const Verdict few = verdictOf(spoiled(value, 5, name), reference);
      EXPECT_TRUE(few.same);
      EXPECT_NEAR(few.passingFraction, 1 - 5 / 12288.0, 1e-12);
    }
  }
  EXPECT_FALSE(verdictOf(spoiled(infinity, 4096, "stderr.R"), spoiled(infinity, 4096, "stderr.R")).same);
}

TEST(CompareVerdict, OneSampleGivesNoVerdictOfSame) {
  Image a = sceneImage(16, 1, 0.05);
  a.channels.push_back({"sampleCount.Y", std::vector<float>(256, 1)});
  EXPECT_FALSE(verdictOf(a, a).same);
  EXPECT_EQ(verdictOf(a, a).passingFraction, 0);
}

TEST(CompareVerdict, IsAbsentWithoutErrorBars) {
  Image a = sceneImage(16, 1, 0.05);
  std::erase_if(a.channels, [](const Channel& channel) { return channel.name == "stderr.B"; });
  EXPECT_FALSE(compareImages(a, sceneImage(16, 2, 0.05)).verdict.has_value());
}

Image flat(uint32_t width, uint32_t height, glm::vec3 color) {
  Image image{.width = width, .height = height};
  for (int c = 0; c < 3; ++c)
    image.channels.push_back({kColors[c], std::vector<float>(size_t(width) * height, color[c])});
  return image;
}

// Luminance of (1, 2, 3): 0.2126 + 1.4304 + 0.2166 = 1.8596.
TEST(CompareImages, ReportsTheStatedMetrics) {
  const Comparison comparison = compareImages(flat(3, 2, {1.5f, 2, 2.5f}), flat(3, 2, {1, 2, 3}));
  const double e2 = std::pow(0.01 * 1.8596, 2);
  EXPECT_NEAR(comparison.relMse, (0.25 / (1 + e2) + 0.25 / (9 + e2)) / 3, 1e-7);
  EXPECT_NEAR(comparison.rmse, std::sqrt(0.5 / 3), 1e-7);
  EXPECT_EQ(comparison.flipMap.size(), 6u);
  EXPECT_NEAR(comparison.flip, comparison.flipMap[0], 1e-6);
  EXPECT_GT(comparison.flip, 0);
}

TEST(CompareImages, RefusesWhatCannotBeCompared) {
  const Image image = flat(4, 4, {1, 1, 1});
  Image grey = image;
  grey.channels.pop_back();
  EXPECT_THROW((void)compareImages(image, flat(4, 5, {1, 1, 1})), UsageError);
  EXPECT_THROW((void)compareImages(grey, image), UsageError);
  EXPECT_THROW((void)compareImages(image, grey), UsageError);
  EXPECT_THROW((void)compareImages(Image{}, Image{}), UsageError);
}

TEST(CompareImages, SurvivesNansAndInfinities) {
  Image a = flat(8, 8, {1, 1, 1});
  a.channels[0].values[3] = std::numeric_limits<float>::quiet_NaN();
  a.channels[1].values[9] = std::numeric_limits<float>::infinity();
  const Comparison comparison = compareImages(a, flat(8, 8, {1, 1, 1}));
  EXPECT_TRUE(std::isnan(comparison.relMse));
  EXPECT_TRUE(comparison.flip > 0 && comparison.flip <= 1);
}

TEST(CompareImages, PsnrIsThatOfWhatADisplayShows) {
  const Image quarter = flat(4, 4, {0.25f, 0.25f, 0.25f}), half = flat(4, 4, {0.5f, 0.5f, 0.5f});
  const double difference =
      double(toneMap(glm::vec3(0.5f), ToneMap::Neutral).x) - double(toneMap(glm::vec3(0.25f), ToneMap::Neutral).x);
  EXPECT_NEAR(compareImages(half, quarter).psnr, -20 * std::log10(difference), 1e-5);
  EXPECT_TRUE(std::isinf(compareImages(half, half).psnr));
}

} // namespace
} // namespace isophote
