// Sampled images and the one descriptor set of the project.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "isophote/device.hpp"
#include "isophote/scene.hpp"

namespace isophote::gpu {

struct TextureUpload {
  const ImageData* image = nullptr;
  Wrap wrapS = Wrap::Repeat;
  Wrap wrapT = Wrap::Repeat;
  Filter filter = Filter::Linear;
  bool srgb =
      false; ///< decode on read (8-bit images; 16-bit sRGB images are converted to linear float by the uploader)
};

/// Combined image samplers at set 0, binding 0, index = position in the upload list. Images shared between entries
/// with the same pixels and colour space are stored once. Empty list: no descriptor objects at all. Move-only.
class TextureArray {
public:
  TextureArray() = default;
  TextureArray(const Device& device, std::span<const TextureUpload> textures);
  TextureArray(TextureArray&& other) noexcept;
  TextureArray& operator=(TextureArray&& other) noexcept;
  ~TextureArray();

  [[nodiscard]] uint32_t size() const { return size_; }
  [[nodiscard]] uint64_t bytes() const { return bytes_; }
  [[nodiscard]] VkDescriptorSetLayout layout() const { return layout_; } ///< null when empty
  [[nodiscard]] VkDescriptorSet set() const { return set_; }

private:
  struct StoredImage {
    VkImage image = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
    uint64_t memoryBytes = 0;
  };
  void create(const Device& device, std::span<const TextureUpload> textures);
  StoredImage storeImage(const Device& device, const TextureUpload& texture, const std::string& name);
  VkSampler storeSampler(const TextureUpload& texture);
  void createSet(std::span<const VkDescriptorImageInfo> entries);
  void destroy() noexcept;

  Device::Impl* device_ = nullptr; // not the Device itself, which may move
  uint32_t size_ = 0;
  uint64_t bytes_ = 0;
  std::vector<StoredImage> images_;
  std::vector<VkSampler> samplers_;
  VkDescriptorSetLayout layout_ = VK_NULL_HANDLE;
  VkDescriptorPool pool_ = VK_NULL_HANDLE;
  VkDescriptorSet set_ = VK_NULL_HANDLE;
};

} // namespace isophote::gpu
