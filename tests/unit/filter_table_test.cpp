#include "upload/filter_table.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "shared/camera_types.h"

namespace isophote {
namespace {

constexpr PixelFilter kFilters[] = {PixelFilter::Box, PixelFilter::Gaussian, PixelFilter::BlackmanHarris};

/// The integral of the filter's weight from its left end to x, by Simpson's rule.
double integral(PixelFilter filter, double x) {
  const double start = -filterRadius(filter);
  const int pieces = 4000;
  double sum = filterWeight(filter, start) + filterWeight(filter, x);
  for (int i = 1; i < pieces; ++i) sum += (i % 2 == 0 ? 2 : 4) * filterWeight(filter, start + (x - start) * i / pieces);
  return sum * (x - start) / pieces / 3;
}

TEST(FilterTable, CdfIsTheIntegralOfTheWeight) {
  for (const PixelFilter filter : kFilters) {
    const double whole = integral(filter, filterRadius(filter));
    for (double share = 0.02; share < 1; share += 0.07) {
      const double x = (2 * share - 1) * filterRadius(filter);
      EXPECT_NEAR(filterCdf(filter, x), integral(filter, x) / whole, 1e-10) << static_cast<int>(filter) << " " << x;
    }
    EXPECT_EQ(filterCdf(filter, -filterRadius(filter)), 0);
    EXPECT_EQ(filterCdf(filter, filterRadius(filter)), 1);
  }
}

TEST(FilterTable, EntriesAreTheQuantiles) {
  for (const PixelFilter filter : kFilters) {
    const auto table = filterTable(filter);
    ASSERT_EQ(table.size(), gpu::kFilterTableSize);
    for (size_t i = 0; i < table.size(); ++i) {
      const double target = static_cast<double>(i) / (gpu::kFilterTableSize - 1);
      // One rounding to float moves the CDF by the density, at most 1.1 per pixel, times 2^-24 of the offset.
      ASSERT_NEAR(filterCdf(filter, static_cast<double>(table[i])), target, 1e-7)
          << static_cast<int>(filter) << " " << i;
    }
  }
}

TEST(FilterTable, IsAntisymmetricAndIncreasing) {
  for (const PixelFilter filter : kFilters) {
    const auto table = filterTable(filter);
    for (size_t i = 0; i < table.size(); ++i) {
      ASSERT_EQ(table[i], -table[table.size() - 1 - i]);
      if (i > 0) {
        ASSERT_GT(table[i], table[i - 1]);
      }
    }
    EXPECT_EQ(table.front(), static_cast<float>(-filterRadius(filter)));
  }
}

TEST(FilterTable, WeightsMatchTheirDefinitions) {
  EXPECT_EQ(filterWeight(PixelFilter::Box, 0.51), 0);
  EXPECT_NEAR(filterWeight(PixelFilter::Gaussian, 0.5), std::exp(-0.5), 1e-15);
  EXPECT_NEAR(filterWeight(PixelFilter::BlackmanHarris, 0), 1, 1e-15);      // the four coefficients sum to 1
  EXPECT_NEAR(filterWeight(PixelFilter::BlackmanHarris, 1.5), 6e-5, 1e-15); // and alternate to 6e-5 (Harris 1978)
}

} // namespace
} // namespace isophote
