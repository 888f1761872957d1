// The files a scene is made of: for the header's hash, and so that no output replaces an input.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace isophote::cli {

/// The .gltf or .glb itself and every file its buffers and images name, in the asset's order. The asset has been
/// loaded, so its JSON is sound.
[[nodiscard]] std::vector<std::filesystem::path> sceneFiles(const std::filesystem::path& scene);

/// FNV-1a (Fowler, Noll, Vo), 64 bits, over the bytes of all files in turn, as 16 hexadecimal digits.
[[nodiscard]] std::string hashFiles(const std::vector<std::filesystem::path>& files);

/// @throws UsageError where `output` is one of `inputs`, also under another name
void refuseOverwriting(const std::filesystem::path& output, const std::vector<std::filesystem::path>& inputs);

} // namespace isophote::cli
