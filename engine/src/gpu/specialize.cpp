#include "gpu/kernel.hpp"

#include "isophote/error.hpp"

#include <unordered_map>
#include <unordered_set>

#include <spirv-tools/optimizer.hpp>

namespace isophote::gpu {
namespace {

// SPIR-V 1.6: section 2.3 (physical layout), opcodes and modes of section 3.
constexpr size_t kHeaderWords = 5;
constexpr uint32_t kOpExecutionMode = 16;
constexpr uint32_t kOpConstant = 43;
constexpr uint32_t kOpTypeVoid = 19;           // the first of the type instructions
constexpr uint32_t kOpTypeForwardPointer = 39; // the last
constexpr uint32_t kOpDecorate = 71;
constexpr uint32_t kOpMemberDecorate = 72;
constexpr uint32_t kDecorationNoContraction = 42;
constexpr uint32_t kOpExecutionModeId = 331;
constexpr uint32_t kModeLocalSize = 17;
constexpr uint32_t kModeLocalSizeId = 38;

/// Turns LocalSizeId, whose operands are by now plain constants, into LocalSize: the former is valid only with the
/// maintenance4 feature, and nothing is left to specialize.
void fixLocalSize(std::vector<uint32_t>& spirv) {
  std::unordered_map<uint32_t, uint32_t> constants; // result id -> value of 32-bit constants
  std::vector<size_t> modes;
  for (size_t at = kHeaderWords; at < spirv.size(); at += spirv[at] >> 16) {
    const uint32_t opcode = spirv[at] & 0xffffu;
    const uint32_t words = spirv[at] >> 16;
    if (words == 0) throw Error("malformed SPIR-V");
    if (opcode == kOpConstant && words == 4) constants[spirv[at + 2]] = spirv[at + 3];
    if (opcode == kOpExecutionModeId && words == 6 && spirv[at + 2] == kModeLocalSizeId) modes.push_back(at);
  }
  for (const size_t at : modes) {
    spirv[at] = (6u << 16) | kOpExecutionMode;
    spirv[at + 2] = kModeLocalSize;
    for (size_t axis = 3; axis < 6; ++axis) spirv[at + axis] = constants.at(spirv[at + axis]);
  }
}

/// The arithmetic instructions that a compiler may contract or re-associate: OpFNegate, FAdd, FSub, FMul, FDiv, FRem,
/// FMod, and the products of vectors and matrices up to OpDot.
bool isFloatArithmetic(uint32_t opcode) {
  switch (opcode) {
  case 127:
  case 129:
  case 131:
  case 133:
  case 136:
  case 140:
  case 141:
    return true;
  default:
    return opcode >= 142 && opcode <= 148;
  }
}

/// Decorates all floating-point arithmetic with NoContraction (`precise`), so that what a compiler sees around an
/// expression, which differs between specializations, cannot change how the expression rounds.
std::vector<uint32_t> decorateNoContraction(const std::vector<uint32_t>& spirv) {
  std::unordered_set<uint32_t> decorated;
  std::vector<uint32_t> decorations;
  size_t annotations = 0; // where the first annotation or type stands
  for (size_t at = kHeaderWords; at < spirv.size(); at += spirv[at] >> 16) {
    const uint32_t opcode = spirv[at] & 0xffffu;
    const bool type = opcode >= kOpTypeVoid && opcode <= kOpTypeForwardPointer;
    if (annotations == 0 && (opcode == kOpDecorate || opcode == kOpMemberDecorate || type)) annotations = at;
    if (opcode == kOpDecorate && spirv[at + 2] == kDecorationNoContraction) decorated.insert(spirv[at + 1]);
    if (isFloatArithmetic(opcode) && !decorated.contains(spirv[at + 2])) {
      decorations.insert(decorations.end(), {3u << 16 | kOpDecorate, spirv[at + 2], kDecorationNoContraction});
    }
  }
  std::vector<uint32_t> result(spirv.begin(), spirv.begin() + static_cast<ptrdiff_t>(annotations));
  result.insert(result.end(), decorations.begin(), decorations.end());
  result.insert(result.end(), spirv.begin() + static_cast<ptrdiff_t>(annotations), spirv.end());
  return result;
}

/// Freezes and folds, removes dead branches, follows constants through local variables, then removes functions,
/// variables and constants that nothing uses any more.
///
/// Names go too. Every specialization constant is a module-scope constant, so this works function by function: inlining
/// first, as spirv-opt -O does, took five times as long on the largest kernel and left more code. Left out on purpose:
/// simplification, which rewrites (a + b) - a to b where nothing says `precise`, while the same source must round alike
/// whatever a scene has; and aggressive dead code elimination, which in SPIRV-Tools 2023.1 crashes on modules with
/// function calls. What remains of unused values is removed by the driver.
void registerPasses(spvtools::Optimizer& optimizer, std::unordered_map<uint32_t, std::vector<uint32_t>> values) {
  optimizer.RegisterPass(spvtools::CreateStripDebugInfoPass())
      .RegisterPass(spvtools::CreateSetSpecConstantDefaultValuePass(std::move(values)))
      .RegisterPass(spvtools::CreateFreezeSpecConstantValuePass())
      .RegisterPass(spvtools::CreateFoldSpecConstantOpAndCompositePass())
      .RegisterPass(spvtools::CreateDeadBranchElimPass())
      .RegisterPass(spvtools::CreateEliminateDeadFunctionsPass())
      .RegisterPass(spvtools::CreateSSARewritePass())
      .RegisterPass(spvtools::CreateCCPPass())
      .RegisterPass(spvtools::CreateDeadBranchElimPass())
      .RegisterPass(spvtools::CreateEliminateDeadFunctionsPass())
      .RegisterPass(spvtools::CreateRemoveUnusedInterfaceVariablesPass())
      .RegisterPass(spvtools::CreateDeadVariableEliminationPass())
      .RegisterPass(spvtools::CreateEliminateDeadConstantPass());
}

} // namespace

std::vector<uint32_t> specializeSpirv(std::span<const uint32_t> spirv, std::span<const SpecConstant> constants,
                                      FloatRounding rounding) {
  std::unordered_map<uint32_t, std::vector<uint32_t>> values;
  for (const auto& constant : constants) values[constant.id] = {constant.value};

  spvtools::Optimizer optimizer(SPV_ENV_VULKAN_1_3);
  std::string problem;
  optimizer.SetMessageConsumer([&](spv_message_level_t level, const char*, const spv_position_t&, const char* message) {
    if (level <= SPV_MSG_ERROR) problem += message;
  });
  registerPasses(optimizer, std::move(values));
  spvtools::OptimizerOptions options;
  options.set_run_validator(false); // the build validated the module
  options.set_preserve_spec_constants(false);

  std::vector<uint32_t> result;
  if (!optimizer.Run(spirv.data(), spirv.size(), &result, options)) {
    throw Error("SPIR-V specialization failed: " + problem);
  }
  fixLocalSize(result);
  return rounding == FloatRounding::AsWritten ? decorateNoContraction(result) : result;
}

} // namespace isophote::gpu
