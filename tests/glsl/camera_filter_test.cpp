#include "glsl/camera_filter_case.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "gpu/buffer.hpp"
#include "shared/camera_types.h"
#include "support/gpu_device.hpp"
#include "support/probe.hpp"
#include "support/statistics.hpp"
#include "test_glsl_kernels.hpp"
#include "upload/filter_table.hpp"

namespace isophote {
namespace {

using gpu::CameraFilterCase;
using gpu::CameraFilterResult;

constexpr PixelFilter kFilters[] = {PixelFilter::Box, PixelFilter::Gaussian, PixelFilter::BlackmanHarris};

std::vector<CameraFilterResult> run(PixelFilter filter, const std::vector<CameraFilterCase>& cases) {
  const gpu::Buffer table = gpu::uploadBuffer(test::gpuDevice(), filterTable(filter), "filter table");
  return test::runProbe<CameraFilterCase, CameraFilterResult>(test_glsl_kernels::kernelSource("camera_filter_probe"),
                                                              cases, table.address());
}

// The bins' edges are 32 quantiles of the analytic filter per axis, all of them table entries; 977 expected counts
// each.
TEST(PixelFilter, SamplesFollowTheAnalyticFilterByChiSquare) {
  std::mt19937 generator(37);
  std::vector<CameraFilterCase> cases(1'000'000);
  for (auto& c : cases) {
    for (int axis = 0; axis < 2; ++axis) {
      c.u[axis] = std::ldexp(static_cast<float>(static_cast<uint32_t>(generator()) >> 8), -24);
    }
  }
  const std::vector<double> expected(32 * 32, static_cast<double>(cases.size()) / 1024);
  for (const PixelFilter filter : kFilters) {
    std::vector<uint64_t> counts(expected.size());
    for (const auto& result : run(filter, cases)) {
      const auto bin = [&](float x) {
        return std::min<size_t>(static_cast<size_t>(32 * filterCdf(filter, static_cast<double>(x))), 31);
      };
      ++counts[bin(result.offset.y) * 32 + bin(result.offset.x)];
    }
    EXPECT_GT(test::chiSquareTest(counts, expected).p, test::sidak(0.001, 3)) << static_cast<int>(filter);
  }
}

// Standard error 4e-4 of the deviation; the linear pieces of the inverse widen the outermost 2/1024 of the weight.
TEST(PixelFilter, SamplesHaveTheAnalyticVariance) {
  for (const PixelFilter filter : kFilters) {
    std::vector<CameraFilterCase> cases(1 << 16);
    for (size_t i = 0; i < cases.size(); ++i) {
      const float u = (static_cast<float>(i) + 0.5f) / static_cast<float>(cases.size());
      cases[i].u = {u, u};
    }
    test::Moments square;
    for (const auto& result : run(filter, cases)) square.add(static_cast<double>(result.offset.x) * result.offset.x);
    double weight = 0;
    double moment = 0;
    for (int i = 0; i < 200'000; ++i) {
      const double x = (i + 0.5) / 200'000 * filterRadius(filter);
      weight += filterWeight(filter, x);
      moment += filterWeight(filter, x) * x * x;
    }
    EXPECT_NEAR(square.mean() / (moment / weight), 1, 0.006) << static_cast<int>(filter);
  }
}

TEST(PixelFilter, ExtremeNumbersStayInsideTheRadius) {
  for (const PixelFilter filter : kFilters) {
    const float last = 1 - std::ldexp(1.0f, -24);
    const auto results = run(filter, {{{0, last}}, {{0.5f, std::ldexp(1.0f, -24)}}});
    const float radius = static_cast<float>(filterRadius(filter));
    EXPECT_EQ(results[0].offset.x, -radius);
    EXPECT_LE(results[0].offset.y, radius);
    EXPECT_GT(results[0].offset.y, 0.9f * radius);
    EXPECT_EQ(results[1].offset.x, 0.0f);
    EXPECT_GE(results[1].offset.y, -radius);
  }
}

} // namespace
} // namespace isophote
