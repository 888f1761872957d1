// The pipelines of one feature set: those of absent features do not exist.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "gpu/kernel.hpp"
#include "isophote/features.hpp"
#include "isophote/settings.hpp"

namespace isophote {

/// What a render asks of its kernels beside features and settings.
struct KernelNeeds {
  bool depthLedger = false;           ///< some paths are followed beyond the depth limit
  bool pixelList = false;             ///< some pixels are sampled, not all
  Backend backend = Backend::Compute; ///< the scene's
  bool operator==(const KernelNeeds&) const = default;
};

struct WavefrontKernels {
  gpu::Kernel prepare;
  gpu::Kernel regenerate;
  gpu::Kernel intersectClosest;
  std::optional<gpu::Kernel> shadeEscaped; ///< with an environment
  std::optional<gpu::Kernel> shadeMedium;  ///< with scattering media
  gpu::Kernel shadeSurface;
  std::optional<gpu::Kernel> intersectShadow; ///< with a light to sample
  gpu::Kernel accumulate;
  std::optional<gpu::Kernel> findCameraMedia; ///< with volumes; once a render

  /// Those that exist, in the order of a wave.
  [[nodiscard]] std::vector<const gpu::Kernel*> all() const;
};

/// What specializes a kernel: workgroup size, features, settings.
[[nodiscard]] std::vector<gpu::SpecConstant> kernelConstants(const FeatureSet& features,
                                                             const EstimatorSettings& settings, uint32_t workgroupSize,
                                                             const KernelNeeds& needs = {});

/// The product's kernel `name` for scenes of a backend; statistics know it by the same name in both.
[[nodiscard]] gpu::KernelSource kernelOf(std::string_view name, Backend backend);

/// @param textureLayout  of the scene's texture array, null where it has none
[[nodiscard]] WavefrontKernels makeWavefrontKernels(const Device& device, const FeatureSet& features,
                                                    const EstimatorSettings& settings, uint32_t workgroupSize,
                                                    VkDescriptorSetLayout textureLayout, const KernelNeeds& needs = {});

} // namespace isophote
