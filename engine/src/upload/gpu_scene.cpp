#include "upload/gpu_scene.hpp"

#include "isophote/error.hpp"

#include "gpu/device_impl.hpp"
#include "gpu/texture_pixels.hpp"
#include "upload/acceleration.hpp"
#include "upload/pack_scene.hpp"

#include "shared/scene_view.h"

#include <algorithm>
#include <chrono>
#include <set>
#include <span>
#include <string>
#include <utility>

namespace isophote {
namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

// One array of the packed scene and where its address goes.
struct ArrayUpload {
  const char* name;
  std::span<const std::byte> bytes;
  gpu::Address* address;
};

template <class T> ArrayUpload arrayUpload(const char* name, const std::vector<T>& values, gpu::Address& address) {
  return {name, std::as_bytes(std::span(values)), &address};
}

constexpr const char* kNodeBuffer = "scene.nodes";

std::vector<ArrayUpload> arrayUploads(const PackedScene& packed, gpu::SceneView& view) {
  std::vector<ArrayUpload> all{
      arrayUpload(kNodeBuffer, packed.nodes, view.nodes),
      arrayUpload("scene.triangles", packed.triangles, view.triangles),
      arrayUpload("scene.rangeStarts", packed.rangeStarts, view.rangeStarts),
      arrayUpload("scene.instances", packed.instances, view.instances),
      arrayUpload("scene.geometries", packed.geometries, view.geometries),
      arrayUpload("scene.indices", packed.indices, view.indices),
      arrayUpload("scene.normals", packed.normals, view.normals),
      arrayUpload("scene.tangents", packed.tangents, view.tangents),
      arrayUpload("scene.colors", packed.colors, view.colors),
      arrayUpload("scene.uvs", packed.uvs, view.uvs),
      arrayUpload("scene.materials", packed.materials, view.materials),
      arrayUpload("scene.textureSlots", packed.textureSlots, view.textureSlots),
      arrayUpload("scene.lightAlias", packed.lightAlias, view.lightAlias),
      arrayUpload("scene.lightTree", packed.lightTree, view.lightTree),
      arrayUpload("scene.lightTrails", packed.lightTrails, view.lightTrails),
      arrayUpload("scene.emissiveTriangles", packed.emissiveTriangles, view.emissiveTriangles),
      arrayUpload("scene.punctualLights", packed.punctualLights, view.punctualLights),
      arrayUpload("scene.environmentPixels", packed.environmentPixels, view.environment.pixels),
      arrayUpload("scene.environmentMarginal", packed.environmentMarginal, view.environment.marginal),
      arrayUpload("scene.environmentConditional", packed.environmentConditional, view.environment.conditional),
  };
  std::erase_if(all, [](const ArrayUpload& upload) { return upload.bytes.empty(); });
  return all;
}

gpu::SceneView countsOf(const PackedScene& packed) {
  gpu::SceneView view{};
  view.environment.width = packed.environmentWidth;
  view.environment.height = packed.environmentHeight;
  view.environment.cosRotation = packed.environmentCosRotation;
  view.environment.sinRotation = packed.environmentSinRotation;
  view.lightCount = static_cast<uint32_t>(packed.lightAlias.size());
  view.emissiveTriangleCount = static_cast<uint32_t>(packed.emissiveTriangles.size());
  view.punctualLightCount = static_cast<uint32_t>(packed.punctualLights.size());
  view.sunCount = packed.sunCount;
  view.instanceCount = static_cast<uint32_t>(packed.instances.size());
  view.lightTreeScale = packed.lightTreeScale;
  view.emitterScale = packed.emitterScale;
  return view;
}

// Bytes of all textures; an image read in one color space is stored once.
uint64_t textureBytes(const Device& device, const Scene& scene, const std::vector<PackedTexture>& textures) {
  std::set<std::pair<uint32_t, bool>> stored;
  uint64_t bytes = 0;
  for (const PackedTexture& texture : textures) {
    if (!stored.insert({texture.image, texture.srgb}).second) continue;
    const ImageData& image = scene.images[texture.image];
    const gpu::TextureFormat format = gpu::textureFormat(image, texture.srgb, device.isCpu());
    bytes += static_cast<uint64_t>(image.width) * image.height * format.bytesPerPixel;
  }
  return bytes;
}

// Refuses before the first byte is uploaded.
void requireMemory(const Device& device, const std::vector<ArrayUpload>& arrays, uint64_t textures) {
  const uint64_t limit = device.impl().maxAllocationBytes;
  uint64_t needed = textures;
  for (const ArrayUpload& array : arrays) {
    needed += array.bytes.size();
    if (array.bytes.size() > limit)
      throw LimitError(std::string(array.name) + " needs " + std::to_string(array.bytes.size()) + " bytes; " +
                       device.info().name + " allocates at most " + std::to_string(limit) + " at once");
  }
  const uint64_t held = device.allocatedBytes();
  const uint64_t available = device.info().memoryBytes - std::min(device.info().memoryBytes, held);
  if (needed > available)
    throw LimitError("the scene needs " + std::to_string(needed) + " bytes; " + std::to_string(available) +
                     " are available on " + device.info().name);
}

gpu::TextureArray uploadTextures(const Device& device, const Scene& scene, const std::vector<PackedTexture>& textures) {
  std::vector<gpu::TextureUpload> uploads;
  for (const PackedTexture& texture : textures)
    uploads.push_back({&scene.images[texture.image], texture.wrapS, texture.wrapT, texture.filter, texture.srgb});
  return gpu::TextureArray(device, uploads);
}

void setBvhStatistics(const BvhStatistics& bvh, SceneStatistics& statistics) {
  statistics.triangles = bvh.triangles;
  statistics.instancedTriangles = bvh.instancedTriangles;
  statistics.bvhNodes = bvh.nodes;
  statistics.sahCost = bvh.sahCost;
  statistics.bvhMaxDepth = bvh.maxDepth;
  statistics.bvhSeconds = 1e-3 * bvh.milliseconds;
}

} // namespace

GpuScene::GpuScene(const Device& device, const Scene& scene, Backend backend, BvhBuild bvhBuild)
    : impl_(std::make_unique<Impl>()) {
  if (backend == Backend::RayQuery && !device.impl().acceleration)
    throw UsageError("a scene for ray query needs a device that was made with it");
  const auto packStart = Clock::now();
  const PackedScene packed = packScene(scene, backend, bvhBuild);
  SceneStatistics& statistics = impl_->statistics;
  statistics.backend = backend;
  setBvhStatistics(packed.bvh, statistics);
  statistics.packSeconds = secondsSince(packStart) - statistics.bvhSeconds;
  impl_->features = packed.features;
  impl_->materialNames = packed.materialNames;
  impl_->worldOrigin = packed.worldOrigin;
  impl_->worldCenter = packed.worldCenter;
  impl_->worldRadius = packed.worldRadius;
  impl_->emitterScale = packed.emitterScale;

  const auto uploadStart = Clock::now();
  gpu::SceneView view = countsOf(packed);
  const std::vector<ArrayUpload> arrays = arrayUploads(packed, view);
  requireMemory(device, arrays, textureBytes(device, scene, packed.textures));
  for (const ArrayUpload& array : arrays) {
    gpu::Buffer buffer(device, array.bytes.size(), gpu::Memory::Device, array.name);
    gpu::writeBuffer(device, buffer, 0, array.bytes);
    *array.address = buffer.address();
    statistics.buffers.push_back({array.name, buffer.bytes()});
    (array.name == kNodeBuffer ? statistics.bvhBytes : statistics.sceneBytes) += buffer.bytes();
    impl_->buffers.push_back(std::move(buffer));
  }
  if (backend == Backend::RayQuery && !packed.instances.empty()) {
    const auto buildStart = Clock::now();
    impl_->acceleration = buildAcceleration(device, packed, view.triangles);
    view.topLevel = impl_->acceleration.topLevel();
    statistics.bvhBytes = impl_->acceleration.bytes();
    statistics.buffers.push_back({"scene.acceleration", statistics.bvhBytes});
    statistics.bvhSeconds = secondsSince(buildStart);
  }
  impl_->view = gpu::uploadBuffer(device, std::vector<gpu::SceneView>{view}, "scene.view");
  impl_->viewContents = view;
  impl_->tables = packed.tables;
  statistics.buffers.push_back({"scene.view", impl_->view.bytes()});
  impl_->textures = uploadTextures(device, scene, packed.textures);
  statistics.textureBytes = impl_->textures.bytes();
  statistics.sceneBytes += impl_->view.bytes() + statistics.textureBytes;
  statistics.uploadSeconds = secondsSince(uploadStart);
  if (backend == Backend::RayQuery) statistics.uploadSeconds -= statistics.bvhSeconds;
}

GpuScene::GpuScene(GpuScene&&) noexcept = default;
GpuScene& GpuScene::operator=(GpuScene&&) noexcept = default;
GpuScene::~GpuScene() = default;

const FeatureSet& GpuScene::features() const { return impl_->features; }
const SceneStatistics& GpuScene::statistics() const { return impl_->statistics; }

} // namespace isophote
