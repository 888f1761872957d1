// Rendering in one call, and what tests may conclude from noisy images.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <glm/glm.hpp>
#include <gtest/gtest.h>

#include "isophote/path_tracer.hpp"
#include "oracle/reference_tracer.hpp"
#include "support/statistics.hpp"

namespace isophote::test {

// Rendering on gpuDevice().

struct RenderOptions {
  EstimatorSettings estimator{.filter = PixelFilter::Box, .seed = 1};
  ExecutionSettings execution;
  PixelRect crop;                  ///< empty: the full image
  std::vector<SampleRange> ranges; ///< rendered one after the other into one film; empty: [0, samplesPerPixel)
};

/// Fails the test where any status counter is not zero.
void expectHealthy(const RenderStatistics& statistics);

/// Renders and resolves; also expects health.
[[nodiscard]] Image renderImage(const Scene& scene, const Camera& camera, uint32_t width, uint32_t height,
                                uint32_t samplesPerPixel, const RenderOptions& options = {});

/// The plane `name`; fails the test and is all zero where the image lacks it.
[[nodiscard]] std::vector<float> plane(const Image& image, const std::string& name);

/// Every plane equal bit for bit, names and order included.
[[nodiscard]] testing::AssertionResult bitIdentical(const Image& a, const Image& b);

// Statistics. Rounding is allowed for apart from noise: a float path tracer is off by a few units in the sixth digit.
inline constexpr double kRounding = 2e-5;

/// Family-wise significance of all statistical render tests together is 0.001: none fails by chance in a thousand
/// changes of every seed. kTestFamily bounds their number.
inline constexpr uint64_t kTestFamily = 200;
inline constexpr double kFamilySignificance = 1e-3;
[[nodiscard]] double testSignificance();

/// A test that cannot see a relative bias of this size is inconclusive, which is a failure.
inline constexpr double kPowerFloor = 0.003;

/// An estimate with its uncertainty: the variance of the mean and the degrees of freedom it was estimated with.
struct Estimate {
  double mean = 0;
  double variance = 0;
  double degreesOfFreedom = 1;
};

/// Three channels per pixel, row 0 at the top.
struct MeasuredImage {
  uint32_t width = 0;
  uint32_t height = 0;
  std::vector<std::array<Estimate, 3>> pixels;
};
[[nodiscard]] MeasuredImage measured(const oracle::ReferenceImage& image);
/// From the film's replicates: 7 degrees of freedom a pixel.
[[nodiscard]] MeasuredImage measured(const Image& image);

/// t-test that the mean of `values` is `expected`, with the power floor.
[[nodiscard]] testing::AssertionResult meanIs(const Moments& values, double expected, double powerFloor = kPowerFloor);
/// The same over all pixels of one channel of an image whose pixels all have one expectation.
[[nodiscard]] testing::AssertionResult pixelMeanIs(const Image& image, const std::string& channel, double expected,
                                                   double powerFloor = kPowerFloor);

struct AgreementRule {
  double absoluteTolerance = 0;    ///< a known limit of the device, such as texture filtering in 8 bits; radiance
  double powerFloor = kPowerFloor; ///< for the mean of the whole image
};

/// Whether two images estimate the same one (reliability test 29's rule): Welch's test per pixel-channel, of
/// which 99.9% must lie within the critical value, for every 4x4 block's mean, all of which must, and for the image's
/// mean, which must also be known to the power floor. Critical values are Sidak's for the number of tests.
[[nodiscard]] testing::AssertionResult sameImage(const MeasuredImage& a, const MeasuredImage& b,
                                                 const AgreementRule& rule = {});

} // namespace isophote::test
