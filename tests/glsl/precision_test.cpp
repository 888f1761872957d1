#include <gtest/gtest.h>

#include "glsl/precision_case.h"
#include "support/probe.hpp"
#include "test_glsl_kernels.hpp"

using namespace isophote;

TEST(FloatBits, NonFiniteValuesAreRecognizedByTheirBits) {
  const std::vector<gpu::NonFiniteCase> nonFinite{{0x7fc00000}, {0xffc00000}, {0x7f800001}, {0xff800001},
                                                  {0x7fffffff}, {0x7f800000}, {0xff800000}};
  const std::vector<gpu::NonFiniteCase> finite{{0},          {0x80000000}, {1},          {0x807fffff}, {0x00800000},
                                               {0x3f800000}, {0xbf800000}, {0x7f7fffff}, {0xff7fffff}};
  const auto& kernel = test_glsl_kernels::kernelSource("precision_nonfinite_probe");
  for (const auto& result : test::runProbe<gpu::NonFiniteCase, gpu::NonFiniteResult>(kernel, nonFinite)) {
    EXPECT_EQ(result.scalar, 1u);
    EXPECT_EQ(result.components, 7u);
  }
  for (const auto& result : test::runProbe<gpu::NonFiniteCase, gpu::NonFiniteResult>(kernel, finite)) {
    EXPECT_EQ(result.scalar, 0u);
    EXPECT_EQ(result.components, 0u);
  }
}
