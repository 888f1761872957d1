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

/// A kernel for each stage.
struct WavefrontKernels {
  gpu::Kernel regenerate;
  gpu::Kernel intersectClosest;
  std::optional<gpu::Kernel> shadeEscaped; ///< where something shines beyond surfaces
  std::optional<gpu::Kernel> shadeMedium;  ///< with scattering media
  gpu::Kernel shadeSurface;
  std::optional<gpu::Kernel> intersectShadow; ///< with a light to sample
  gpu::Kernel accumulate;
};

/// Whether some vertex can sample a light, so that there are shadow rays.
[[nodiscard]] bool samplesLights(const FeatureSet& features, const EstimatorSettings& settings, bool depthLedger);

/// What specializes a kernel: workgroup size, features, settings.
[[nodiscard]] std::vector<gpu::SpecConstant> kernelConstants(const FeatureSet& features,
                                                             const EstimatorSettings& settings, uint32_t workgroupSize,
                                                             const KernelNeeds& needs = {});

/// The product's kernel `name` for scenes of a backend; statistics know it by the same name in both.
[[nodiscard]] gpu::KernelSource kernelOf(std::string_view name, Backend backend);

/// What both ways of work share, and each way's own kernels once it is asked for. Borrows the Device.
class RenderKernels {
public:
  /// @param textureLayout  of the scene's texture array, null where it has none
  RenderKernels(const Device& device, const FeatureSet& features, const EstimatorSettings& settings,
                uint32_t workgroupSize, VkDescriptorSetLayout textureLayout, const KernelNeeds& needs = {});

  /// Builds the kernels of this way, unless they are there. Auto: of both.
  void add(Pipeline pipeline);

  gpu::Kernel prepare;
  std::optional<gpu::Kernel> findCameraMedia; ///< with volumes; once a render
  std::optional<WavefrontKernels> wavefront;
  std::optional<gpu::Kernel> fused;

  /// Those that exist, in the order of a wave.
  [[nodiscard]] std::vector<const gpu::Kernel*> all() const;

private:
  [[nodiscard]] gpu::Kernel make(const char* name) const;
  [[nodiscard]] std::optional<gpu::Kernel> makeIf(bool needed, const char* name) const;

  const Device* device_;
  FeatureSet features_;
  bool shadowRays_;
  Backend backend_;
  std::vector<gpu::SpecConstant> constants_;
  VkDescriptorSetLayout textureLayout_;
};

} // namespace isophote
