#include "gpu/texture_array.hpp"

#include "isophote/error.hpp"

#include "gpu/buffer.hpp"
#include "gpu/device_impl.hpp"
#include "gpu/memory.hpp"
#include "gpu/texture_pixels.hpp"
#include "gpu/vulkan_check.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

namespace isophote::gpu {
namespace {

constexpr uint64_t kStagingBytes = 16ull << 20;
constexpr VkImageSubresourceRange kWholeImage{
    .aspectMask = VK_IMAGE_ASPECT_COLOR_BIT, .levelCount = 1, .layerCount = 1};

std::string nameOf(const TextureUpload& texture, size_t number) {
  std::string name = "texture[" + std::to_string(number) + "]";
  if (texture.image && !texture.image->name.empty()) name += " " + texture.image->name;
  return name;
}

void requireValid(const Device::Impl& device, const TextureUpload& texture, const std::string& name) {
  const ImageData* image = texture.image;
  if (!image || image->width == 0 || image->height == 0) throw Error(name + ": no pixels");
  if (image->bitsPerChannel != 8 && image->bitsPerChannel != 16) throw Error(name + ": neither 8 nor 16 bits");
  const uint64_t bytes = static_cast<uint64_t>(image->width) * image->height * 4 * (image->bitsPerChannel / 8);
  if (image->pixels.size() != bytes) throw Error(name + ": fewer or more pixels than its size says");
  const uint32_t limit = device.limits.maxImageDimension2D;
  if (image->width > limit || image->height > limit) {
    throw LimitError(name + " has " + std::to_string(image->width) + " x " + std::to_string(image->height) +
                     " pixels; " + device.info.name + " reads at most " + std::to_string(limit) + " a side");
  }
}

bool sameContent(const TextureUpload& a, const TextureUpload& b) {
  if (a.srgb != b.srgb) return false;
  if (a.image == b.image) return true;
  return a.image->width == b.image->width && a.image->height == b.image->height &&
         a.image->bitsPerChannel == b.image->bitsPerChannel && a.image->pixels == b.image->pixels;
}

VkSamplerAddressMode addressMode(Wrap wrap) {
  switch (wrap) {
  case Wrap::ClampToEdge:
    return VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  case Wrap::MirroredRepeat:
    return VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT;
  case Wrap::Repeat:
    break;
  }
  return VK_SAMPLER_ADDRESS_MODE_REPEAT;
}

VkImage createImage(const Device::Impl& device, const ImageData& image, VkFormat format) {
  const VkImageCreateInfo info{.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                               .imageType = VK_IMAGE_TYPE_2D,
                               .format = format,
                               .extent = {image.width, image.height, 1},
                               .mipLevels = 1,
                               .arrayLayers = 1,
                               .samples = VK_SAMPLE_COUNT_1_BIT,
                               .tiling = VK_IMAGE_TILING_OPTIMAL,
                               .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                               .initialLayout = VK_IMAGE_LAYOUT_UNDEFINED};
  VkImage handle = VK_NULL_HANDLE;
  check(vkCreateImage(device.handle, &info, nullptr, &handle), "vkCreateImage");
  return handle;
}

void recordTransition(VkCommandBuffer commands, VkImage image, VkImageLayout from, VkImageLayout to) {
  const VkImageMemoryBarrier2 barrier{
      .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
      .srcStageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
      .srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT,
      .dstStageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
      .dstAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT | VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
      .oldLayout = from,
      .newLayout = to,
      .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
      .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
      .image = image,
      .subresourceRange = kWholeImage};
  const VkDependencyInfo dependency{
      .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .imageMemoryBarrierCount = 1, .pImageMemoryBarriers = &barrier};
  vkCmdPipelineBarrier2(commands, &dependency);
}

/// Copies the pixels in bands of rows of at most kStagingBytes (one row at least).
void uploadPixels(const Device& device, VkImage image, const ImageData& data, const TextureFormat& format) {
  const uint64_t rowBytes = static_cast<uint64_t>(data.width) * format.bytesPerPixel;
  const uint32_t bandRows = static_cast<uint32_t>(std::clamp<uint64_t>(kStagingBytes / rowBytes, 1, data.height));
  const Buffer staging(device, rowBytes * bandRows, Memory::Host, "texture staging");
  for (uint32_t row = 0; row < data.height; row += bandRows) {
    const uint32_t rows = std::min(bandRows, data.height - row);
    const std::vector<std::byte> pixels = texturePixels(data, format.format, row, row + rows);
    std::memcpy(staging.mapped(), pixels.data(), pixels.size());
    device.impl().transfer([&](VkCommandBuffer commands) {
      constexpr VkImageLayout kDestination = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
      if (row == 0) recordTransition(commands, image, VK_IMAGE_LAYOUT_UNDEFINED, kDestination);
      const VkBufferImageCopy region{.imageSubresource = {.aspectMask = VK_IMAGE_ASPECT_COLOR_BIT, .layerCount = 1},
                                     .imageOffset = {0, static_cast<int32_t>(row), 0},
                                     .imageExtent = {data.width, rows, 1}};
      vkCmdCopyBufferToImage(commands, staging.handle(), image, kDestination, 1, &region);
      if (row + rows == data.height) {
        recordTransition(commands, image, kDestination, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
      }
    });
  }
}

} // namespace

TextureArray::TextureArray(const Device& device, std::span<const TextureUpload> textures)
    : device_(&device.impl()), size_(static_cast<uint32_t>(textures.size())) {
  if (textures.empty()) return;
  const VkPhysicalDeviceLimits& limits = device_->limits;
  const uint32_t limit = std::min({limits.maxPerStageDescriptorSampledImages, limits.maxPerStageDescriptorSamplers,
                                   limits.maxDescriptorSetSampledImages, limits.maxDescriptorSetSamplers});
  if (size_ > limit) {
    throw LimitError("the scene has " + std::to_string(size_) + " textures; " + device_->info.name + " binds at most " +
                     std::to_string(limit));
  }
  try {
    create(device, textures);
  } catch (...) {
    destroy();
    throw;
  }
}

void TextureArray::create(const Device& device, std::span<const TextureUpload> textures) {
  std::vector<VkDescriptorImageInfo> entries;
  for (size_t i = 0; i < textures.size(); ++i) {
    const std::string name = nameOf(textures[i], i);
    requireValid(*device_, textures[i], name);
    VkImageView view = VK_NULL_HANDLE;
    for (size_t earlier = 0; earlier < i && !view; ++earlier) {
      if (sameContent(textures[earlier], textures[i])) view = entries[earlier].imageView;
    }
    if (!view) view = storeImage(device, textures[i], name).view;
    VkSampler sampler = VK_NULL_HANDLE;
    for (size_t earlier = 0; earlier < i && !sampler; ++earlier) {
      const TextureUpload& other = textures[earlier];
      const bool same = other.wrapS == textures[i].wrapS && other.wrapT == textures[i].wrapT;
      if (same && other.filter == textures[i].filter) sampler = entries[earlier].sampler;
    }
    if (!sampler) sampler = storeSampler(textures[i]);
    entries.push_back({sampler, view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL});
  }
  createSet(entries);
}

TextureArray::StoredImage TextureArray::storeImage(const Device& device, const TextureUpload& texture,
                                                   const std::string& name) {
  const TextureFormat format = textureFormat(*texture.image, texture.srgb, device.isCpu());
  StoredImage& stored = images_.emplace_back(); // filled step by step, so that destroy() finds what exists
  stored.image = createImage(*device_, *texture.image, format.format);
  device_->name(stored.image, VK_OBJECT_TYPE_IMAGE, name);
  VkMemoryRequirements requirements{};
  vkGetImageMemoryRequirements(device_->handle, stored.image, &requirements);
  const Allocation allocation = allocateMemory(*device_, requirements, Memory::Device, false, name);
  stored.memory = allocation.memory;
  stored.memoryBytes = allocation.bytes;
  bytes_ += allocation.bytes;
  check(vkBindImageMemory(device_->handle, stored.image, stored.memory, 0), "vkBindImageMemory");
  const VkImageViewCreateInfo info{.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                   .image = stored.image,
                                   .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                   .format = format.format,
                                   .subresourceRange = kWholeImage};
  check(vkCreateImageView(device_->handle, &info, nullptr, &stored.view), "vkCreateImageView");
  device_->name(stored.view, VK_OBJECT_TYPE_IMAGE_VIEW, name);
  uploadPixels(device, stored.image, *texture.image, format);
  return stored;
}

VkSampler TextureArray::storeSampler(const TextureUpload& texture) {
  const VkFilter filter = texture.filter == Filter::Nearest ? VK_FILTER_NEAREST : VK_FILTER_LINEAR;
  const VkSamplerCreateInfo info{.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                                 .magFilter = filter,
                                 .minFilter = filter,
                                 .mipmapMode = VK_SAMPLER_MIPMAP_MODE_NEAREST,
                                 .addressModeU = addressMode(texture.wrapS),
                                 .addressModeV = addressMode(texture.wrapT),
                                 .addressModeW = VK_SAMPLER_ADDRESS_MODE_REPEAT};
  VkSampler sampler = VK_NULL_HANDLE;
  check(vkCreateSampler(device_->handle, &info, nullptr, &sampler), "vkCreateSampler");
  samplers_.push_back(sampler);
  return sampler;
}

void TextureArray::createSet(std::span<const VkDescriptorImageInfo> entries) {
  const VkDescriptorSetLayoutBinding binding{.binding = 0,
                                             .descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                             .descriptorCount = size_,
                                             .stageFlags = VK_SHADER_STAGE_COMPUTE_BIT};
  const VkDescriptorSetLayoutCreateInfo layoutInfo{
      .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO, .bindingCount = 1, .pBindings = &binding};
  check(vkCreateDescriptorSetLayout(device_->handle, &layoutInfo, nullptr, &layout_), "vkCreateDescriptorSetLayout");
  device_->name(layout_, VK_OBJECT_TYPE_DESCRIPTOR_SET_LAYOUT, "textures");
  const VkDescriptorPoolSize poolSize{.type = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, .descriptorCount = size_};
  const VkDescriptorPoolCreateInfo poolInfo{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                            .maxSets = 1,
                                            .poolSizeCount = 1,
                                            .pPoolSizes = &poolSize};
  check(vkCreateDescriptorPool(device_->handle, &poolInfo, nullptr, &pool_), "vkCreateDescriptorPool");
  device_->name(pool_, VK_OBJECT_TYPE_DESCRIPTOR_POOL, "textures");
  const VkDescriptorSetAllocateInfo setInfo{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                            .descriptorPool = pool_,
                                            .descriptorSetCount = 1,
                                            .pSetLayouts = &layout_};
  check(vkAllocateDescriptorSets(device_->handle, &setInfo, &set_), "vkAllocateDescriptorSets");
  device_->name(set_, VK_OBJECT_TYPE_DESCRIPTOR_SET, "textures");
  const VkWriteDescriptorSet write{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                   .dstSet = set_,
                                   .descriptorCount = size_,
                                   .descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                   .pImageInfo = entries.data()};
  vkUpdateDescriptorSets(device_->handle, 1, &write, 0, nullptr);
}

void TextureArray::destroy() noexcept {
  if (!device_) return;
  if (pool_) vkDestroyDescriptorPool(device_->handle, pool_, nullptr);
  if (layout_) vkDestroyDescriptorSetLayout(device_->handle, layout_, nullptr);
  for (const VkSampler sampler : samplers_) vkDestroySampler(device_->handle, sampler, nullptr);
  for (const StoredImage& stored : images_) {
    if (stored.view) vkDestroyImageView(device_->handle, stored.view, nullptr);
    if (stored.image) vkDestroyImage(device_->handle, stored.image, nullptr);
    freeMemory(*device_, {stored.memory, stored.memoryBytes, false});
  }
}

TextureArray::TextureArray(TextureArray&& other) noexcept
    : device_(std::exchange(other.device_, nullptr)), size_(std::exchange(other.size_, 0)),
      bytes_(std::exchange(other.bytes_, 0)), images_(std::exchange(other.images_, {})),
      samplers_(std::exchange(other.samplers_, {})), layout_(std::exchange(other.layout_, VK_NULL_HANDLE)),
      pool_(std::exchange(other.pool_, VK_NULL_HANDLE)), set_(std::exchange(other.set_, VK_NULL_HANDLE)) {}

TextureArray& TextureArray::operator=(TextureArray&& other) noexcept {
  TextureArray moved(std::move(other));
  std::swap(device_, moved.device_);
  std::swap(size_, moved.size_);
  std::swap(bytes_, moved.bytes_);
  std::swap(images_, moved.images_);
  std::swap(samplers_, moved.samplers_);
  std::swap(layout_, moved.layout_);
  std::swap(pool_, moved.pool_);
  std::swap(set_, moved.set_);
  return *this;
}

TextureArray::~TextureArray() { destroy(); }

} // namespace isophote::gpu
