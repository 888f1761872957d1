#include "gpu/pipeline_cache.hpp"

#include "gpu/vulkan_check.hpp"

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include <unistd.h>

namespace isophote::gpu {
namespace {

/// Larger files are not ours; a driver would spend longer reading them than compiling.
constexpr uint64_t kMaxFileBytes = 256ull << 20;

std::filesystem::path cacheFolder() {
  if (const char* xdg = std::getenv("XDG_CACHE_HOME"); xdg && *xdg == '/')
    return std::filesystem::path(xdg) / "isophote";
  if (const char* home = std::getenv("HOME"); home && *home == '/') {
    return std::filesystem::path(home) / ".cache" / "isophote";
  }
  return {};
}

VkPhysicalDeviceProperties propertiesOf(VkPhysicalDevice physical) {
  VkPhysicalDeviceProperties properties{};
  vkGetPhysicalDeviceProperties(physical, &properties);
  return properties;
}

std::vector<char> readFile(const std::filesystem::path& file) {
  std::error_code error;
  const uint64_t bytes = std::filesystem::file_size(file, error);
  if (error || bytes > kMaxFileBytes) return {};
  std::vector<char> data(bytes);
  std::ifstream stream(file, std::ios::binary);
  stream.read(data.data(), static_cast<std::streamsize>(bytes));
  if (!stream) return {};
  return data;
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

void replaceFile(const std::filesystem::path& file, const std::vector<char>& data) {
  std::error_code error;
  std::filesystem::create_directories(file.parent_path(), error);
  const std::filesystem::path temporary = file.string() + "." + std::to_string(getpid()) + ".tmp";
  std::ofstream stream(temporary, std::ios::binary | std::ios::trunc);
  stream.write(data.data(), static_cast<std::streamsize>(data.size()));
  stream.close();
  if (stream) std::filesystem::rename(temporary, file, error);
  if (!stream || error) std::filesystem::remove(temporary, error);
}

} // namespace

std::filesystem::path pipelineCacheFile(VkPhysicalDevice physical) {
  const std::filesystem::path folder = cacheFolder();
  if (folder.empty()) return {};
  const VkPhysicalDeviceProperties properties = propertiesOf(physical);
  constexpr char kDigits[] = "0123456789abcdef";
  std::string name;
  for (const uint8_t byte : properties.pipelineCacheUUID) {
    name += kDigits[byte >> 4];
    name += kDigits[byte & 15];
  }
  return folder / (name + "-" + std::to_string(properties.driverVersion) + ".bin");
}

VkPipelineCache loadPipelineCache(VkDevice device, VkPhysicalDevice physical, const std::filesystem::path& file) {
  std::vector<char> data = file.empty() ? std::vector<char>{} : readFile(file);
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
    replaceFile(file, data);
  } catch (...) {
    // Out of memory, or a path the file system refuses: the next run compiles again.
  }
}

} // namespace isophote::gpu
