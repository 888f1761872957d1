#include "gpu/kernel.hpp"

#include "isophote/error.hpp"

#include "gpu/device_impl.hpp"
#include "gpu/vulkan_check.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace isophote::gpu {
namespace {

constexpr uint32_t kMaxPushBytes = 128; // what every Vulkan device offers
constexpr size_t kHeaderWords = 5;      // SPIR-V 1.6, section 2.3

/// Product of the local size, which specializeSpirv leaves as literals.
uint64_t workgroupInvocations(std::span<const uint32_t> spirv) {
  constexpr uint32_t kOpExecutionMode = 16;
  constexpr uint32_t kModeLocalSize = 17;
  for (size_t at = kHeaderWords; at < spirv.size(); at += spirv[at] >> 16) {
    if ((spirv[at] & 0xffffu) == kOpExecutionMode && spirv[at + 2] == kModeLocalSize) {
      return uint64_t{spirv[at + 3]} * spirv[at + 4] * spirv[at + 5];
    }
  }
  return 0;
}

/// Whether any variable of the module is decorated with a descriptor set.
bool hasDescriptors(std::span<const uint32_t> spirv) {
  constexpr uint32_t kOpDecorate = 71;
  constexpr uint32_t kDecorationDescriptorSet = 34;
  for (size_t at = kHeaderWords; at < spirv.size(); at += spirv[at] >> 16) {
    if ((spirv[at] & 0xffffu) == kOpDecorate && spirv[at + 2] == kDecorationDescriptorSet) return true;
  }
  return false;
}

VkPipelineLayout createLayout(const Device::Impl& device, VkDescriptorSetLayout set, uint32_t pushBytes) {
  const VkPushConstantRange range{.stageFlags = VK_SHADER_STAGE_COMPUTE_BIT, .offset = 0, .size = pushBytes};
  const VkPipelineLayoutCreateInfo info{.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                        .setLayoutCount = set ? 1u : 0u,
                                        .pSetLayouts = &set,
                                        .pushConstantRangeCount = pushBytes > 0 ? 1u : 0u,
                                        .pPushConstantRanges = &range};
  VkPipelineLayout layout = VK_NULL_HANDLE;
  check(vkCreatePipelineLayout(device.handle, &info, nullptr, &layout), "vkCreatePipelineLayout");
  return layout;
}

VkPipeline createPipeline(const Device::Impl& device, std::span<const uint32_t> spirv, VkPipelineLayout layout) {
  const VkShaderModuleCreateInfo moduleInfo{
      .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, .codeSize = spirv.size_bytes(), .pCode = spirv.data()};
  VkShaderModule module = VK_NULL_HANDLE;
  check(vkCreateShaderModule(device.handle, &moduleInfo, nullptr, &module), "vkCreateShaderModule");
  const VkComputePipelineCreateInfo info{.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
                                         .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                                                   .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                                                   .module = module,
                                                   .pName = "main"},
                                         .layout = layout};
  VkPipeline pipeline = VK_NULL_HANDLE;
  const VkResult result = vkCreateComputePipelines(device.handle, device.cache, 1, &info, nullptr, &pipeline);
  vkDestroyShaderModule(device.handle, module, nullptr);
  check(result, "vkCreateComputePipelines");
  return pipeline;
}

} // namespace

Kernel::Kernel(const Device& device, const KernelSource& source, std::span<const SpecConstant> constants,
               VkDescriptorSetLayout textureLayout, uint32_t pushBytes)
    : device_(&device.impl()), name_(source.name), pushBytes_(pushBytes) {
  if (pushBytes > kMaxPushBytes) throw Error("kernel " + name_ + ": more than 128 bytes of push constants");
  try {
    build(source, constants, textureLayout);
  } catch (...) {
    destroy();
    throw;
  }
}

void Kernel::build(const KernelSource& source, std::span<const SpecConstant> constants,
                   VkDescriptorSetLayout textureLayout) {
  const auto start = std::chrono::steady_clock::now();
  // A CPU driver has no fused operations to lose.
  const FloatRounding rounding = device_->info.kind == "cpu" ? FloatRounding::AsWritten : FloatRounding::Free;
  const std::vector<uint32_t> spirv = specializeSpirv(source.spirv, constants, rounding);
  spirvBytes_ = static_cast<uint32_t>(spirv.size() * sizeof(uint32_t));
  usesTextures_ = hasDescriptors(spirv);
  const uint32_t groupLimit =
      std::min(device_->limits.maxComputeWorkGroupInvocations, device_->limits.maxComputeWorkGroupSize[0]);
  if (const uint64_t invocations = workgroupInvocations(spirv); invocations == 0 || invocations > groupLimit) {
    throw LimitError("kernel " + name_ + " asks for workgroups of " + std::to_string(invocations) + "; " +
                     device_->info.name + " runs 1 to " + std::to_string(groupLimit));
  }
  if (usesTextures_ && !textureLayout) throw Error("kernel " + name_ + " reads textures, but there are none");
  layout_ = createLayout(*device_, usesTextures_ ? textureLayout : VK_NULL_HANDLE, pushBytes_);
  pipeline_ = createPipeline(*device_, spirv, layout_);
  const std::chrono::duration<double, std::milli> elapsed = std::chrono::steady_clock::now() - start;
  compileMilliseconds_ = elapsed.count();
  device_->name(layout_, VK_OBJECT_TYPE_PIPELINE_LAYOUT, name_);
  device_->name(pipeline_, VK_OBJECT_TYPE_PIPELINE, name_);
}

void Kernel::destroy() noexcept {
  if (pipeline_) vkDestroyPipeline(device_->handle, pipeline_, nullptr);
  if (layout_) vkDestroyPipelineLayout(device_->handle, layout_, nullptr);
}

Kernel::Kernel(Kernel&& other) noexcept
    : device_(std::exchange(other.device_, nullptr)), name_(std::move(other.name_)),
      layout_(std::exchange(other.layout_, VK_NULL_HANDLE)), pipeline_(std::exchange(other.pipeline_, VK_NULL_HANDLE)),
      pushBytes_(other.pushBytes_), spirvBytes_(other.spirvBytes_), compileMilliseconds_(other.compileMilliseconds_),
      usesTextures_(other.usesTextures_) {}

Kernel& Kernel::operator=(Kernel&& other) noexcept {
  Kernel moved(std::move(other));
  std::swap(device_, moved.device_);
  std::swap(name_, moved.name_);
  std::swap(layout_, moved.layout_);
  std::swap(pipeline_, moved.pipeline_);
  std::swap(pushBytes_, moved.pushBytes_);
  std::swap(spirvBytes_, moved.spirvBytes_);
  std::swap(compileMilliseconds_, moved.compileMilliseconds_);
  std::swap(usesTextures_, moved.usesTextures_);
  return *this;
}

Kernel::~Kernel() { destroy(); }

} // namespace isophote::gpu
