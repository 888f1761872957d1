// What is worth keeping between runs about a device and its driver. Optional in every respect: no failure here is ever
// reported.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <vulkan/vulkan.h>

namespace isophote::gpu {

/// `isophote/<cache UUID>-<driver version><extension>` in ${XDG_CACHE_HOME}, else ~/.cache; empty where neither is
/// known.
[[nodiscard]] std::filesystem::path cacheFile(VkPhysicalDevice physical, const std::string& extension);

/// Empty where `file` cannot be read, or is larger than `mostBytes`.
[[nodiscard]] std::vector<char> readCacheFile(const std::filesystem::path& file, uint64_t mostBytes);

/// Replaces `file` in one step, so that a reader never sees half of it.
void replaceCacheFile(const std::filesystem::path& file, const std::vector<char>& data);

} // namespace isophote::gpu
