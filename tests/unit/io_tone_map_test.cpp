#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "isophote/image.hpp"

namespace isophote {
namespace {

constexpr ToneMap kAll[] = {ToneMap::Neutral, ToneMap::Agx, ToneMap::Aces, ToneMap::Srgb, ToneMap::Linear};

double srgb(double linear) { return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055; }

void expectNear(glm::vec3 actual, glm::dvec3 expected, double tolerance) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(actual[c], expected[c], tolerance) << "channel " << c;
}

TEST(ToneMapping, StaysInRangeForEveryInput) {
  const float infinity = std::numeric_limits<float>::infinity();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float values[] = {0, -0.0f, 1e-45f, 1e-10f, 0.18f, 1, 100, 1e15f, 3.4e38f, infinity, -infinity, -1, nan};
  for (const ToneMap operation : kAll) {
    for (const float r : values) {
      for (const float g : values) {
        for (const float b : values) {
          const glm::vec3 mapped = toneMap({r, g, b}, operation);
          for (int c = 0; c < 3; ++c) EXPECT_TRUE(mapped[c] >= 0 && mapped[c] <= 1) << r << ' ' << g << ' ' << b;
        }
      }
    }
  }
}

TEST(ToneMapping, GreysStayGreyAndRiseFromBlackToWhite) {
  for (const ToneMap operation : kAll) {
    EXPECT_LT(toneMap(glm::vec3(0), operation).r, 0.002f);
    EXPECT_GT(toneMap(glm::vec3(1e15f), operation).r, 0.99f);
    float previous = -1;
    for (double ev = -14; ev < 14; ev += 0.01) {
      const glm::vec3 mapped = toneMap(glm::vec3(static_cast<float>(std::exp2(ev))), operation);
      // The AgX polynomial has a dip of 2e-4 at its very end; everything else rises.
      EXPECT_GE(mapped.r, previous - 1e-3f) << ev;
      // AgX's published matrices are inverse to each other within 2.3e-4, a seventeenth of an 8-bit step.
      EXPECT_NEAR(mapped.r, mapped.g, 2.5e-4);
      EXPECT_NEAR(mapped.r, mapped.b, 2.5e-4);
      previous = mapped.r;
    }
  }
}

// Below 0.8 the operator is the identity less the Fresnel offset of 0.04, above it compresses to 1 - 0.0576 / (peak -
// 0.52).
TEST(ToneMapping, NeutralIsTheKhronosSpecification) {
  expectNear(toneMap({0.5f, 0.3f, 0.1f}, ToneMap::Neutral), {srgb(0.46), srgb(0.26), srgb(0.06)}, 1e-6);
  // offset x^2 / 0.16 remains of the lowest channel x = 0.04: 0.01
  expectNear(toneMap({0.5f, 0.3f, 0.04f}, ToneMap::Neutral), {srgb(0.47), srgb(0.27), srgb(0.01)}, 1e-6);
  const double peak = 10 - 0.04;
  const double newPeak = 1 - 0.24 * 0.24 / (peak + 0.24 - 0.76);
  expectNear(toneMap({10, 10, 10}, ToneMap::Neutral), glm::dvec3(srgb(newPeak)), 1e-6);
  const double scale = newPeak / peak;
  const double white = 1 - 1 / (0.15 * (peak - newPeak) + 1);
  const auto saturated = [&](double value) { return srgb((value - 0.04) * scale * (1 - white) + newPeak * white); };
  expectNear(toneMap({10, 1, 0.1f}, ToneMap::Neutral), {saturated(10), saturated(1), saturated(0.1)}, 1e-6);
}

TEST(ToneMapping, AcesIsTheRationalCurve) {
  const auto curve = [](double x) { return srgb((x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14)); };
  expectNear(toneMap({0.18f, 1, 5}, ToneMap::Aces), {curve(0.18), curve(1), curve(5)}, 1e-6);
}

// AgX's curve pivots at middle grey, shown at half of the display's code values. The fit's stated RMS error is 0.002.
TEST(ToneMapping, AgxShowsMiddleGreyAtHalf) {
  expectNear(toneMap(glm::vec3(0.18f), ToneMap::Agx), glm::dvec3(0.5), 0.006);
}

TEST(ToneMapping, AgxTurnsBrightPrimariesTowardsWhite) {
  const glm::vec3 blue = toneMap({0, 0, 1000}, ToneMap::Agx);
  EXPECT_GT(blue.r, 0.5f);
  EXPECT_GT(blue.g, 0.5f);
}

TEST(ToneMapping, SrgbEncodesAndLinearOnlyClamps) {
  expectNear(toneMap({0.001f, 0.5f, 2}, ToneMap::Srgb), {srgb(0.001), srgb(0.5), 1}, 1e-6);
  expectNear(toneMap({0.001f, 0.5f, 2}, ToneMap::Linear), {0.001, 0.5, 1}, 1e-7);
}

} // namespace
} // namespace isophote
