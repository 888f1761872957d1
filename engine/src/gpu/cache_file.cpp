#include "gpu/cache_file.hpp"

#include <cstdlib>
#include <fstream>

#include <unistd.h>

namespace isophote::gpu {
namespace {

std::filesystem::path cacheFolder() {
  if (const char* xdg = std::getenv("XDG_CACHE_HOME"); xdg && *xdg == '/')
    return std::filesystem::path(xdg) / "isophote";
  if (const char* home = std::getenv("HOME"); home && *home == '/') {
    return std::filesystem::path(home) / ".cache" / "isophote";
  }
  return {};
}

} // namespace

std::filesystem::path cacheFile(VkPhysicalDevice physical, const std::string& extension) {
  const std::filesystem::path folder = cacheFolder();
  if (folder.empty()) return {};
  VkPhysicalDeviceProperties properties{};
  vkGetPhysicalDeviceProperties(physical, &properties);
  constexpr char kDigits[] = "0123456789abcdef";
  std::string name;
  for (const uint8_t byte : properties.pipelineCacheUUID) {
    name += kDigits[byte >> 4];
    name += kDigits[byte & 15];
  }
  return folder / (name + "-" + std::to_string(properties.driverVersion) + extension);
}

std::vector<char> readCacheFile(const std::filesystem::path& file, uint64_t mostBytes) {
  std::error_code error;
  const uint64_t bytes = std::filesystem::file_size(file, error);
  if (error || bytes > mostBytes) return {};
  std::vector<char> data(bytes);
  std::ifstream stream(file, std::ios::binary);
  stream.read(data.data(), static_cast<std::streamsize>(bytes));
  if (!stream) return {};
  return data;
}

void replaceCacheFile(const std::filesystem::path& file, const std::vector<char>& data) {
  std::error_code error;
  std::filesystem::create_directories(file.parent_path(), error);
  const std::filesystem::path temporary = file.string() + "." + std::to_string(getpid()) + ".tmp";
  std::ofstream stream(temporary, std::ios::binary | std::ios::trunc);
  stream.write(data.data(), static_cast<std::streamsize>(data.size()));
  stream.close();
  if (stream) std::filesystem::rename(temporary, file, error);
  if (!stream || error) std::filesystem::remove(temporary, error);
}

} // namespace isophote::gpu
