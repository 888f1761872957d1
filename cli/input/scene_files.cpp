#include "input/scene_files.hpp"

#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <optional>
#include <system_error>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "isophote/error.hpp"

namespace isophote::cli {
namespace {

/// The JSON text of a .gltf, or the first chunk of a .glb (glTF 2.0, 4.4).
std::string jsonText(const std::filesystem::path& scene) {
  std::ifstream in(scene, std::ios::binary);
  char header[20] = {};
  in.read(header, sizeof(header));
  if (in.gcount() == sizeof(header) && std::memcmp(header, "glTF", 4) == 0) {
    uint32_t length = 0;
    std::memcpy(&length, header + 12, sizeof(length));
    std::string text(std::min<uintmax_t>(length, std::filesystem::file_size(scene)), '\0');
    in.read(text.data(), static_cast<std::streamsize>(text.size()));
    return text;
  }
  in.clear();
  in.seekg(0);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::optional<int> hexDigit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return std::nullopt;
}

/// RFC 3986, 2.1.
std::string percentDecoded(const std::string& uri) {
  std::string text;
  for (size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] == '%' && i + 2 < uri.size()) {
      const auto high = hexDigit(uri[i + 1]);
      const auto low = hexDigit(uri[i + 2]);
      if (high && low) {
        text += static_cast<char>(*high * 16 + *low);
        i += 2;
        continue;
      }
    }
    text += uri[i];
  }
  return text;
}

} // namespace

std::vector<std::filesystem::path> sceneFiles(const std::filesystem::path& scene) {
  std::vector<std::filesystem::path> files = {scene};
  const auto asset = nlohmann::json::parse(jsonText(scene), nullptr, false);
  if (!asset.is_object()) return files;
  for (const char* kind : {"buffers", "images"}) {
    if (!asset.contains(kind) || !asset[kind].is_array()) continue;
    for (const auto& item : asset[kind]) {
      if (!item.is_object() || !item.contains("uri") || !item["uri"].is_string()) continue;
      const std::string uri = item["uri"].get<std::string>();
      if (uri.starts_with("data:")) continue;
      const auto file = scene.parent_path() / percentDecoded(uri);
      std::error_code error;
      if (std::filesystem::is_regular_file(file, error)) files.push_back(file);
    }
  }
  return files;
}

std::string hashFiles(const std::vector<std::filesystem::path>& files) {
  uint64_t hash = 0xcbf29ce484222325u;
  std::vector<char> block(1u << 20);
  for (const auto& file : files) {
    std::ifstream in(file, std::ios::binary);
    while (in) {
      in.read(block.data(), static_cast<std::streamsize>(block.size()));
      for (std::streamsize i = 0; i < in.gcount(); ++i) {
        hash = (hash ^ static_cast<uint8_t>(block[static_cast<size_t>(i)])) * 0x100000001b3u;
      }
    }
  }
  return fmt::format("{:016x}", hash);
}

void refuseOverwriting(const std::filesystem::path& output, const std::vector<std::filesystem::path>& inputs) {
  for (const auto& input : inputs) {
    std::error_code error; // equivalent() fails where the output does not exist yet
    if (std::filesystem::equivalent(output, input, error)) {
      throw UsageError(fmt::format("{} is an input of this render; choose another output", output.string()));
    }
  }
}

} // namespace isophote::cli
