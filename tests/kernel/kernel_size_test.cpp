// Drivers inline every call: a function that is called in two places is compiled twice, and so is all that it calls.
#include <map>
#include <vector>

#include <gtest/gtest.h>

#include "isophote_kernels.hpp"
#include "render/wavefront_kernels.hpp"

namespace isophote::test {
namespace {

constexpr double kMargin = 1.1;

/// Instructions of the functions of a module, and whom they call.
class CallGraph {
public:
  explicit CallGraph(const std::vector<uint32_t>& spirv) {
    constexpr uint32_t kHeaderWords = 5, kOpEntryPoint = 15, kOpFunction = 54, kOpFunctionEnd = 56,
                       kOpFunctionCall = 57;
    Function* function = nullptr;
    for (size_t at = kHeaderWords; at < spirv.size(); at += spirv[at] >> 16) {
      const uint32_t opcode = spirv[at] & 0xffffu;
      if (opcode == kOpEntryPoint) entry_ = spirv[at + 2];
      if (opcode == kOpFunction) function = &functions_[spirv[at + 2]];
      if (function != nullptr) ++function->instructions;
      if (opcode == kOpFunctionCall) function->calls.push_back(spirv[at + 3]);
      if (opcode == kOpFunctionEnd) function = nullptr;
    }
  }

  /// Of the entry point, every call inlined.
  [[nodiscard]] uint64_t inlinedInstructions() { return inlined(entry_); }

private:
  struct Function {
    uint64_t instructions = 0;
    uint64_t inlined = 0; ///< with what it calls; 0: not yet added up
    std::vector<uint32_t> calls;
  };

  uint64_t inlined(uint32_t id) {
    Function& function = functions_.at(id);
    if (function.inlined == 0) {
      function.inlined = function.instructions;
      for (const uint32_t callee : function.calls) function.inlined += inlined(callee);
    }
    return function.inlined;
  }

  uint32_t entry_ = 0;
  std::map<uint32_t, Function> functions_;
};

FeatureSet everything() {
  FeatureSet features;
  for (const FeatureDescription& description : allFeatures()) features.add(description.feature);
  return features;
}

TEST(KernelSize, NoKernelIsCompiledManyTimesOver) {
  const std::map<std::string, double> instructions = {{"intersect_closest", 5183}, {"intersect_shadow", 9001},
                                                      {"shade_escaped", 6318},     {"shade_medium", 14617},
                                                      {"shade_surface", 77292},    {"fused", 114210}};
  const auto constants = kernelConstants(everything(), EstimatorSettings{}, 64);
  for (const auto& [name, expected] : instructions) {
    const gpu::KernelSource source = isophote_kernels::kernelSource(name.c_str());
    CallGraph graph(gpu::specializeSpirv(source.spirv, constants, gpu::FloatRounding::Free));
    EXPECT_LE(static_cast<double>(graph.inlinedInstructions()), kMargin * expected) << name;
  }
}

} // namespace
} // namespace isophote::test
