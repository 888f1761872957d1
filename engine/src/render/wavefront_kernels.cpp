#include "render/wavefront_kernels.hpp"

#include "isophote_kernels.hpp"
#include "render/setting_ids.hpp"
#include "shared/path_types.h"

#include <algorithm>
#include <string>

namespace isophote {
namespace {

// Those that trace rays: they are compiled once for each backend (RAY_QUERY in engine/CMakeLists.txt).
constexpr std::string_view kTracingKernels[] = {"intersect_closest", "intersect_shadow", "find_camera_media", "fused"};

// Whether a ray that met no surface can see anything.
bool shinesBeyondSurfaces(const FeatureSet& features) {
  return features.has(Feature::kHasEnvironment) || features.has(Feature::kHasSuns) ||
         features.has(Feature::kHasSphereLights);
}

} // namespace

// With BSDF sampling only, just the lights that no direction can find.
bool samplesLights(const FeatureSet& features, const EstimatorSettings& settings, bool depthLedger) {
  if (settings.maxDepth == 0 && !depthLedger) return false;
  if (features.has(Feature::kHasPunctualLights)) return true;
  return settings.lightSampling != LightSampling::BsdfOnly &&
         (features.has(Feature::kHasEmissiveTriangles) || features.has(Feature::kHasSphereLights) ||
          features.has(Feature::kHasSuns) || features.has(Feature::kHasEnvironment));
}

std::vector<gpu::SpecConstant> kernelConstants(const FeatureSet& features, const EstimatorSettings& settings,
                                               uint32_t workgroupSize, const KernelNeeds& needs) {
  std::vector<gpu::SpecConstant> constants = {{0, workgroupSize}};
  for (const FeatureDescription& description : allFeatures()) {
    constants.push_back({static_cast<uint32_t>(description.feature), features.has(description.feature) ? 1u : 0u});
  }
  constants.push_back({setting_id::kSampler, static_cast<uint32_t>(settings.sampler)});
  constants.push_back({setting_id::kLightSampling, static_cast<uint32_t>(settings.lightSampling)});
  constants.push_back({setting_id::kMultipleScattering, settings.multipleScattering ? 1u : 0u});
  constants.push_back({setting_id::kLightSelection, static_cast<uint32_t>(settings.lightSelection)});
  constants.push_back({setting_id::kTriangleLightSampling, static_cast<uint32_t>(settings.triangleLightSampling)});
  constants.push_back({setting_id::kDirectionSampling, static_cast<uint32_t>(settings.directionSampling)});
  constants.push_back({setting_id::kNdf, static_cast<uint32_t>(settings.ndf)});
  constants.push_back({setting_id::kMasking, static_cast<uint32_t>(settings.masking)});
  constants.push_back({setting_id::kFresnel, static_cast<uint32_t>(settings.fresnel)});
  constants.push_back({setting_id::kMisHeuristic, static_cast<uint32_t>(settings.misHeuristic)});
  constants.push_back({setting_id::kSphereLightSampling, static_cast<uint32_t>(settings.sphereLightSampling)});
  constants.push_back({setting_id::kShadowTransmission, static_cast<uint32_t>(settings.shadowTransmission)});
  constants.push_back({setting_id::kRussianRoulette, static_cast<uint32_t>(settings.russianRoulette)});
  constants.push_back({setting_id::kIntersection, static_cast<uint32_t>(settings.intersection)});
  constants.push_back({setting_id::kRayOffset, static_cast<uint32_t>(settings.rayOffset)});
  constants.push_back({setting_id::kTrigonometry, static_cast<uint32_t>(settings.trigonometry)});
  constants.push_back({setting_id::kTextureFilter, static_cast<uint32_t>(settings.textureFilter)});
  constants.push_back({setting_id::kDepthLedger, needs.depthLedger ? 1u : 0u});
  constants.push_back({setting_id::kPixelList, needs.pixelList ? 1u : 0u});
  constants.push_back({setting_id::kClamp, settings.clamp < kNoClamp ? 1u : 0u});
  return constants;
}

gpu::KernelSource kernelOf(std::string_view name, Backend backend) {
  gpu::KernelSource source = isophote_kernels::kernelSource(name);
  const bool traces =
      std::find(std::begin(kTracingKernels), std::end(kTracingKernels), name) != std::end(kTracingKernels);
  if (backend == Backend::RayQuery && traces)
    source.spirv = isophote_kernels::kernelSource(std::string(name) + "_ray_query").spirv;
  return source;
}

std::vector<const gpu::Kernel*> RenderKernels::all() const {
  std::vector<const gpu::Kernel*> kernels = {&prepare};
  const auto add = [&](const std::optional<gpu::Kernel>& kernel) {
    if (kernel) kernels.push_back(&*kernel);
  };
  if (wavefront) {
    kernels.push_back(&wavefront->regenerate);
    kernels.push_back(&wavefront->intersectClosest);
    add(wavefront->shadeEscaped);
    add(wavefront->shadeMedium);
    kernels.push_back(&wavefront->shadeSurface);
    add(wavefront->intersectShadow);
    kernels.push_back(&wavefront->accumulate);
  }
  add(fused);
  add(findCameraMedia);
  return kernels;
}

RenderKernels::RenderKernels(const Device& device, const FeatureSet& features, const EstimatorSettings& settings,
                             uint32_t workgroupSize, VkDescriptorSetLayout textureLayout, const KernelNeeds& needs)
    : device_(&device), features_(features), shadowRays_(samplesLights(features, settings, needs.depthLedger)),
      backend_(needs.backend), constants_(kernelConstants(features, settings, workgroupSize, needs)),
      textureLayout_(textureLayout) {
  prepare = make("prepare");
  findCameraMedia = makeIf(features.has(Feature::kHasVolumes), "find_camera_media");
}

void RenderKernels::add(Pipeline pipeline) {
  if (pipeline != Pipeline::Wavefront && !fused) fused = make("fused");
  if (pipeline != Pipeline::Fused && !wavefront) {
    wavefront = WavefrontKernels{.regenerate = make("regenerate"),
                                 .intersectClosest = make("intersect_closest"),
                                 .shadeEscaped = makeIf(shinesBeyondSurfaces(features_), "shade_escaped"),
                                 .shadeMedium = makeIf(features_.has(Feature::kHasScatteringMedia), "shade_medium"),
                                 .shadeSurface = make("shade_surface"),
                                 .intersectShadow = makeIf(shadowRays_, "intersect_shadow"),
                                 .accumulate = make("accumulate")};
  }
}

gpu::Kernel RenderKernels::make(const char* name) const {
  return {*device_, kernelOf(name, backend_), constants_, textureLayout_, sizeof(gpu::KernelArgs)};
}

std::optional<gpu::Kernel> RenderKernels::makeIf(bool needed, const char* name) const {
  return needed ? std::optional(make(name)) : std::nullopt;
}

} // namespace isophote
