// A compute kernel: embedded SPIR-V, specialized, with push constants and at most the texture array as descriptors.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "isophote/device.hpp"

namespace isophote::gpu {

/// SPIR-V embedded at build time, by the stem of its .comp file ("generate", "probe_ggx"). The build emits one
/// translation unit per kernel list that defines this table's entries.
struct KernelSource {
  const char* name;
  std::span<const uint32_t> spirv;
};

struct SpecConstant {
  uint32_t id = 0;
  uint32_t value = 0; ///< bool as 0/1, int, uint, or the bits of a float
};

enum class FloatRounding : uint32_t {
  Free,     ///< the driver may contract and re-associate, as GPUs need for speed
  AsWritten ///< every operation rounds by itself: differently specialized kernels give the same bits
};

/// Freezes `constants` into the module and removes what they make unreachable (spirv-opt: freeze, fold, dead branch and
/// dead code elimination), so that a feature a scene lacks leaves neither code nor bindings behind.
[[nodiscard]] std::vector<uint32_t> specializeSpirv(std::span<const uint32_t> spirv,
                                                    std::span<const SpecConstant> constants,
                                                    FloatRounding rounding = FloatRounding::Free);

/// One compute pipeline with its layout. Move-only, named for debuggers.
class Kernel {
public:
  Kernel() = default;
  /// Specializes `source` by `constants` (constant 0 is the workgroup size) and builds the pipeline.
  /// @param textureLayout  set 0, or null where the specialized module reads no texture
  /// @param pushBytes      size of the push-constant block, <= 128
  Kernel(const Device& device, const KernelSource& source, std::span<const SpecConstant> constants,
         VkDescriptorSetLayout textureLayout, uint32_t pushBytes);
  Kernel(Kernel&& other) noexcept;
  Kernel& operator=(Kernel&& other) noexcept;
  ~Kernel();

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] VkPipeline pipeline() const { return pipeline_; }
  [[nodiscard]] VkPipelineLayout layout() const { return layout_; }
  [[nodiscard]] uint32_t pushBytes() const { return pushBytes_; }
  [[nodiscard]] uint32_t spirvBytes() const { return spirvBytes_; }
  [[nodiscard]] double compileMilliseconds() const { return compileMilliseconds_; }
  [[nodiscard]] bool usesTextures() const { return usesTextures_; } ///< the specialized module declares set 0

private:
  void build(const KernelSource& source, std::span<const SpecConstant> constants, VkDescriptorSetLayout textureLayout);
  void destroy() noexcept;

  Device::Impl* device_ = nullptr; // not the Device itself, which may move
  std::string name_;
  VkPipelineLayout layout_ = VK_NULL_HANDLE;
  VkPipeline pipeline_ = VK_NULL_HANDLE;
  uint32_t pushBytes_ = 0;
  uint32_t spirvBytes_ = 0;
  double compileMilliseconds_ = 0;
  bool usesTextures_ = false;
};

} // namespace isophote::gpu
