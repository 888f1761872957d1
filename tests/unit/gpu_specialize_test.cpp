#include <gtest/gtest.h>

#include <bit>
#include <chrono>

#include "gpu/kernel.hpp"
#include "gpu/texture_array.hpp"
#include "isophote/error.hpp"
#include "support/gpu_device.hpp"
#include "support/probe.hpp"
#include "test_unit_kernels.hpp"
#include "unit/gpu_case.h"

using namespace isophote;
using gpu::SpecConstant;

namespace {

const gpu::KernelSource& source() { return test_unit_kernels::kernelSource("gpu_specialized_probe"); }

size_t countOpcode(const std::vector<uint32_t>& spirv, uint32_t opcode) {
  size_t count = 0;
  for (size_t at = 5; at < spirv.size(); at += spirv[at] >> 16) count += (spirv[at] & 0xffffu) == opcode;
  return count;
}

constexpr uint32_t kOpFAdd = 129;
constexpr uint32_t kOpFSub = 131;
constexpr uint32_t kOpImageSampleExplicitLod = 88;
constexpr uint32_t kOpSpecConstants[] = {48, 49, 50, 51, 52};

constexpr uint32_t kProbePushBytes = 28;

} // namespace

TEST(Specialization, RemovesWhatAConstantRulesOut) {
  const auto with = gpu::specializeSpirv(source().spirv, std::vector<SpecConstant>{{0, 64}, {1, 1}});
  const auto without = gpu::specializeSpirv(source().spirv, std::vector<SpecConstant>{{0, 64}, {1, 0}});
  EXPECT_EQ(countOpcode(with, kOpImageSampleExplicitLod), 1u);
  EXPECT_EQ(countOpcode(without, kOpImageSampleExplicitLod), 0u);
  EXPECT_LT(without.size(), with.size());
}

TEST(Specialization, LeavesNoSpecConstants) {
  const auto spirv = gpu::specializeSpirv(source().spirv, std::vector<SpecConstant>{{0, 64}});
  for (const uint32_t opcode : kOpSpecConstants) EXPECT_EQ(countOpcode(spirv, opcode), 0u);
}

TEST(Specialization, KeepsFloatArithmeticAsWritten) {
  const auto spirv = gpu::specializeSpirv(source().spirv, std::vector<SpecConstant>{{0, 64}, {1, 0}});
  EXPECT_EQ(countOpcode(spirv, kOpFAdd), 1u);
  EXPECT_EQ(countOpcode(spirv, kOpFSub), 1u);
}

TEST(Specialization, DropsTheTextureDescriptorWithItsLastUse) {
  const std::vector<SpecConstant> without{{0, 64}, {1, 0}};
  const gpu::Kernel kernel(test::gpuDevice(), source(), without, VK_NULL_HANDLE, kProbePushBytes);
  EXPECT_FALSE(kernel.usesTextures());
  const std::vector<SpecConstant> with{{0, 64}, {1, 1}};
  EXPECT_THROW(gpu::Kernel(test::gpuDevice(), source(), with, VK_NULL_HANDLE, kProbePushBytes), Error);
}

TEST(Specialization, ConstantsOfEveryTypeReachTheKernel) {
  const std::vector<SpecConstant> constants{{1, 0}, {2, 4000000000u}, {3, std::bit_cast<uint32_t>(-1.5f)}, {4, 0}};
  const auto results = test::runProbe<gpu::SpecializedCase, gpu::SpecializedResult>(source(), {{0}}, 0, constants);
  EXPECT_EQ(results[0].number, 4000000000u);
  EXPECT_EQ(results[0].measure, -1.5f);
  EXPECT_EQ(results[0].flag, 0u);
  EXPECT_EQ(results[0].red, -1.0f);
}

TEST(Specialization, ConstantsLeftOutKeepTheirDefaultsAndUnknownIdsAreIgnored) {
  const std::vector<SpecConstant> constants{{1, 0}, {99, 5}};
  const auto results = test::runProbe<gpu::SpecializedCase, gpu::SpecializedResult>(source(), {{0}}, 0, constants);
  EXPECT_EQ(results[0].number, 7u);
  EXPECT_EQ(results[0].measure, 0.25f);
  EXPECT_EQ(results[0].flag, 1u);
}

TEST(Specialization, ConstantZeroIsTheWorkgroupSize) {
  // A later entry wins over the 64 that runProbe asks for; 128 invocations then need two workgroups' worth of inputs.
  const std::vector<SpecConstant> constants{{1, 0}, {0, 32}};
  const auto results = test::runProbe<gpu::SpecializedCase, gpu::SpecializedResult>(source(), {{0}}, 0, constants);
  EXPECT_EQ(results[0].workgroupSize, 32u);
}

TEST(Specialization, AWorkgroupLargerThanTheDeviceAllowsIsRefused) {
  const std::vector<SpecConstant> constants{{0, 1u << 20}, {1, 0}};
  EXPECT_THROW(gpu::Kernel(test::gpuDevice(), source(), constants, VK_NULL_HANDLE, kProbePushBytes), LimitError);
}

TEST(Specialization, ABrokenModuleIsRefused) {
  const std::vector<uint32_t> broken{1, 2, 3, 4, 5, 6};
  EXPECT_THROW((void)gpu::specializeSpirv(broken, {}), Error);
}

TEST(Kernel, MoveLeavesNothingBehind) {
  const std::vector<SpecConstant> constants{{0, 64}, {1, 0}};
  gpu::Kernel first(test::gpuDevice(), source(), constants, VK_NULL_HANDLE, kProbePushBytes);
  const VkPipeline pipeline = first.pipeline();
  gpu::Kernel second(std::move(first));
  EXPECT_EQ(first.pipeline(), VkPipeline(VK_NULL_HANDLE));
  EXPECT_EQ(second.pipeline(), pipeline);
  gpu::Kernel third;
  third = std::move(second);
  EXPECT_EQ(third.pipeline(), pipeline);
  EXPECT_EQ(third.name(), "gpu_specialized_probe");
  EXPECT_GT(third.compileMilliseconds(), 0.0);
  EXPECT_GT(third.spirvBytes(), 0u);
}
