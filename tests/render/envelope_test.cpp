// The sweeps of `isophote envelope`: points of them that break first by default, and all published ranges in the slow
// suite.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "envelope/closed_forms.hpp"
#include "envelope/sweep.hpp"
#include "support/gpu_device.hpp"

namespace isophote::envelope {
namespace {

using test::gpuDevice;

Sweep sweepCalled(const std::string& name) {
  const std::vector<Sweep> sweeps = allSweeps();
  const auto found = std::find_if(sweeps.begin(), sweeps.end(), [&](const Sweep& s) { return s.name == name; });
  if (found != sweeps.end()) return *found;
  ADD_FAILURE() << "no sweep " << name;
  return sweeps.front();
}

Point pointOf(const Sweep& sweep, double value, const Effort& effort) {
  return sweep.measured ? sweep.measured(gpuDevice(), value) : measure(gpuDevice(), sweep.at(value), value, effort);
}

struct Gate {
  const char* sweep;
  double value;
  double bound; ///< of the error, its interval included; at least twice what docs/envelope has
  double halfWidth = 2e-4;
};

std::string gateName(const testing::TestParamInfo<Gate>& info) {
  std::string name = std::string(info.param.sweep) + std::to_string(info.index);
  std::erase_if(name, [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); });
  return name;
}

class EnvelopeGates : public testing::TestWithParam<Gate> {};

TEST_P(EnvelopeGates, TheErrorStaysBelowItsBound) {
  const Gate& gate = GetParam();
  const Point point = pointOf(sweepCalled(gate.sweep), gate.value, {.halfWidth = gate.halfWidth});
  EXPECT_LE(point.bound(), gate.bound) << point.error << " +- " << point.halfWidth << " " << point.failure;
}

// Values where something gave way once, or would first.
INSTANTIATE_TEST_SUITE_P(RenderEnvelope, EnvelopeGates,
                         testing::Values(Gate{"scale-cavity", 0x1p-20, 1e-6}, Gate{"distance-cavity", 1e7, 1e-6},
                                         Gate{"roughness-sun", 0.03, 1e-3, 4e-4}, Gate{"ior", 10, 6e-3, 2e-3},
                                         Gate{"solid-angle-sphere", 1e-10, 1e-4}, Gate{"aspect-floor", 1e7, 1e-4},
                                         Gate{"nearness", 1e5, 1e-4}, Gate{"lights", 1e5, 1e-2, 4e-3},
                                         Gate{"texture", 16384, 1e-3, 4e-4}, Gate{"accumulation", 0x1p30, 1e-6}),
                         gateName);

TEST(RenderEnvelopeSlow, EveryPublishedRangeHolds) {
  std::ifstream file(ISOPHOTE_SOURCE_DIR "/docs/envelope/envelope.json");
  const auto published = nlohmann::json::parse(file);
  for (const auto& entry : published.at("sweeps")) {
    const Sweep sweep = sweepCalled(entry.at("name"));
    for (const auto& [key, limit] : {std::pair{"below_0.1_percent", 1e-3}, {"below_1_percent", 1e-2}}) {
      const auto& range = entry.at(key);
      if (range.is_null()) continue;
      bool within = false;
      for (const double value : sweep.values) {
        within = within || value == range.at("first");
        // The margin: twice the limit, for a quarter of the samples. Where those say too little, all of them.
        if (within) {
          Point point = pointOf(sweep, value, {.halfWidth = limit / 2, .divideBy = 4});
          if (point.halfWidth > limit) point = pointOf(sweep, value, {.halfWidth = limit / 2});
          EXPECT_LE(point.bound(), 2 * limit) << sweep.name << " at " << value << ": " << point.failure;
        }
        if (value == range.at("last")) within = false;
      }
    }
  }
}

Sweep threeValues() { return {"three", "", "", {1, 2, 3}, 2, {}}; }

TEST(EnvelopeRange, EndsAtTheFirstValueWhoseIntervalReachesTheLimit) {
  const std::vector<Point> points = {{.value = 1, .error = -5e-4, .halfWidth = 6e-4},
                                     {.value = 2, .error = 1e-4, .halfWidth = 1e-4},
                                     {.value = 3, .error = 0, .halfWidth = 9e-4}};
  const Range fine = rangeBelow(threeValues(), points, 1e-3);
  EXPECT_TRUE(fine.any);
  EXPECT_EQ(fine.first, 2);
  EXPECT_EQ(fine.last, 3);
  EXPECT_FALSE(fine.fromStart);
  EXPECT_TRUE(fine.toEnd);
  EXPECT_TRUE(rangeBelow(threeValues(), points, 1e-2).fromStart);
  std::vector<Point> failed = points;
  failed[1].failure = "dropped";
  EXPECT_FALSE(rangeBelow(threeValues(), failed, 1e-2).any);
}

// Against an integral over directions instead of facets.
TEST(EnvelopeClosedForms, TheSunInRoughMetalIsTheIntegralOverItsDisk) {
  for (const double alpha : {1.0, 0.3, 0.01}) {
    const double radius = 0.2;
    double sum = 0;
    constexpr int kSteps = 200000;
    for (int i = 0; i < kSteps; ++i) {
      const double theta = radius * (i + 0.5) / kSteps;
      const double c = std::cos(theta / 2), t = std::tan(theta / 2) / alpha;
      const double d = 1 / (kPi * alpha * alpha * std::pow(c, 4) * std::pow(1 + t * t, 2));
      const double lambda = (std::sqrt(1 + std::pow(alpha * std::tan(theta), 2)) - 1) / 2;
      sum += d / (1 + lambda) / 4 * 2 * kPi * std::sin(theta) * radius / kSteps;
    }
    EXPECT_NEAR(ggxReflectionOfDisk(alpha, radius), sum, 1e-6 * sum) << alpha;
  }
}

TEST(EnvelopeClosedForms, KnownValues) {
  EXPECT_NEAR(fresnelReflectance(1, 1.5), 0.04, 1e-12);
  EXPECT_NEAR(fresnelReflectance(std::cos(80 * kPi / 180), 1.5), 0.387704, 1e-6);
  EXPECT_NEAR(plateTransmittance(std::sqrt(0.5), 1.5), 0.904327, 1e-6);
  EXPECT_NEAR(polygonIrradiance({{-.5, 1, -.5}, {.5, 1, -.5}, {.5, 1, .5}, {-.5, 1, .5}}), 0.752275, 1e-6);
}

} // namespace
} // namespace isophote::envelope
