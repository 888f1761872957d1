// The kernel that a scene of diffuse materials gets, beside one whose other materials were never written: shade_surface
// compiled with the files of tests/kernel/lambert_only in place of the product's.
#include <cstdlib>
#include <map>
#include <vector>

#include <gtest/gtest.h>
#include <spirv-tools/optimizer.hpp>

#include "isophote_kernels.hpp"
#include "lambert_only_kernels.hpp"
#include "render/wavefront_kernels.hpp"

namespace isophote::test {
namespace {

/// How often each opcode stands in the kernel as a driver's optimizer would see it: inlined, without dead code.
using OpcodeCounts = std::map<uint32_t, int>;

constexpr uint32_t kOpFunction = 54;

OpcodeCounts countOpcodes(const gpu::KernelSource& source, const FeatureSet& features) {
  const auto constants = kernelConstants(features, EstimatorSettings{}, 64);
  const auto specialized = gpu::specializeSpirv(source.spirv, constants, gpu::FloatRounding::Free);
  spvtools::Optimizer optimizer(SPV_ENV_VULKAN_1_3);
  optimizer.RegisterPerformancePasses();
  spvtools::OptimizerOptions options;
  options.set_run_validator(false);
  std::vector<uint32_t> spirv;
  EXPECT_TRUE(optimizer.Run(specialized.data(), specialized.size(), &spirv, options));
  OpcodeCounts counts;
  bool code = false;
  for (size_t at = 5; at < spirv.size(); at += spirv[at] >> 16) {
    const uint32_t opcode = spirv[at] & 0xffffu;
    code = code || opcode == kOpFunction;
    if (code) ++counts[opcode];
  }
  return counts;
}

int total(const OpcodeCounts& counts) {
  int sum = 0;
  for (const auto& [opcode, count] : counts) sum += count;
  return sum;
}

// Arithmetic on floats, calls of the extended set (12: sqrt, min, clamp ...) and conditional branches (250).
bool isWork(uint32_t opcode) { return opcode == 12 || opcode == 250 || (opcode >= 127 && opcode <= 148); }

void expectSameKernel(const FeatureSet& features) {
  const auto product = countOpcodes(isophote_kernels::kernelSource("shade_surface"), features);
  const auto control = countOpcodes(lambert_only_kernels::kernelSource("shade_surface"), features);
  for (const auto* counts : {&product, &control}) {
    for (const auto& [opcode, count] : *counts) {
      if (!isWork(opcode)) continue;
      const auto of = [work = opcode](const OpcodeCounts& all) { return all.contains(work) ? all.at(work) : 0; };
      EXPECT_EQ(of(product), of(control)) << "opcode " << opcode;
    }
  }
  // The product copies a larger struct of the material: a few loads that drivers drop.
  EXPECT_LE(total(product), total(control) + total(control) / 200);
}

FeatureSet with(std::initializer_list<Feature> list) {
  FeatureSet features;
  for (const Feature feature : list) features.add(feature);
  return features;
}

} // namespace

TEST(LambertOnly, DiffuseSceneUnderLampsHasTheKernelOfADiffuseRenderer) {
  expectSameKernel(with({Feature::kHasEmissiveTriangles}));
}

TEST(LambertOnly, DiffuseSceneUnderTheSkyHasTheKernelOfADiffuseRenderer) {
  expectSameKernel(with({Feature::kHasEnvironment}));
}

TEST(LambertOnly, DiffuseSceneOfPointLightsHasTheKernelOfADiffuseRenderer) {
  expectSameKernel(with({Feature::kHasPunctualLights}));
}

TEST(LambertOnly, OtherMaterialsAreSeenByTheComparison) {
  const auto diffuse = with({Feature::kHasEmissiveTriangles});
  for (const Feature material : {Feature::kHasSpecular, Feature::kHasClearcoat, Feature::kHasSheen}) {
    FeatureSet features = diffuse;
    features.add(material);
    EXPECT_GT(total(countOpcodes(isophote_kernels::kernelSource("shade_surface"), features)),
              1.1 * total(countOpcodes(isophote_kernels::kernelSource("shade_surface"), diffuse)));
  }
}

} // namespace isophote::test
