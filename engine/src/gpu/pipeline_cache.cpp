#include "gpu/pipeline_cache.hpp"

#include "gpu/cache_file.hpp"
#include "gpu/vulkan_check.hpp"

#include <cstring>
#include <vector>

namespace isophote::gpu {
namespace {

/// Larger files are not ours; a driver would spend longer reading them than compiling.
constexpr uint64_t kMaxFileBytes = 256ull << 20;

VkPhysicalDeviceProperties propertiesOf(VkPhysicalDevice physical) {
  VkPhysicalDeviceProperties properties{};
  vkGetPhysicalDeviceProperties(physical, &properties);
  return properties;
}

/// Drivers should refuse foreign data themselves; some crash on it.
bool belongsTo(const std::vector<char>& data, VkPhysicalDevice physical) {
  VkPipelineCacheHeaderVersionOne header{};
  if (data.size() < sizeof(header)) return false;
  std::memcpy(&header, data.data(), sizeof(header));
  const VkPhysicalDeviceProperties properties = propertiesOf(physical);
  return header.headerSize == sizeof(header) && header.headerVersion == VK_PIPELINE_CACHE_HEADER_VERSION_ONE &&
         header.vendorID == properties.vendorID && header.deviceID == properties.deviceID &&
         std::memcmp(header.pipelineCacheUUID, properties.pipelineCacheUUID, VK_UUID_SIZE) == 0;
}

} // namespace

VkPipelineCache loadPipelineCache(VkDevice device, VkPhysicalDevice physical, const std::filesystem::path& file) {
  std::vector<char> data = file.empty() ? std::vector<char>{} : readCacheFile(file, kMaxFileBytes);
  if (!belongsTo(data, physical)) data.clear();
  const VkPipelineCacheCreateInfo info{.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO,
                                       .initialDataSize = data.size(),
                                       .pInitialData = data.data()};
  VkPipelineCache cache = VK_NULL_HANDLE;
  check(vkCreatePipelineCache(device, &info, nullptr, &cache), "vkCreatePipelineCache");
  return cache;
}

void savePipelineCache(VkDevice device, VkPipelineCache cache, const std::filesystem::path& file) noexcept {
  if (file.empty()) return;
  try {
    size_t bytes = 0;
    if (vkGetPipelineCacheData(device, cache, &bytes, nullptr) != VK_SUCCESS || bytes > kMaxFileBytes) return;
    std::vector<char> data(bytes);
    if (vkGetPipelineCacheData(device, cache, &bytes, data.data()) != VK_SUCCESS) return;
    data.resize(bytes);
    replaceCacheFile(file, data);
  } catch (...) {
    // Out of memory, or a path the file system refuses: the next run compiles again.
  }
}

} // namespace isophote::gpu
