// Small glTF assets built in tests: JSON in memory, data in one buffer, written to a folder that goes away again.
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>
#include <unistd.h>

#include "isophote/gltf.hpp"

namespace isophote::test {

using Json = nlohmann::json;

class TemporaryFolder {
public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "isophote-gltf-XXXXXX").string();
    if (!mkdtemp(name.data())) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  std::filesystem::path write(const std::string& name, const std::string& bytes) const {
    const std::filesystem::path file = path_ / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << bytes;
    return file;
  }

private:
  std::filesystem::path path_;
};

inline std::string base64(const std::string& bytes) {
  static const char* kAlphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t bits = 0;
    for (size_t k = 0; k < 3; ++k) {
      bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    }
    for (size_t k = 0; k < 4; ++k) text += i + k > bytes.size() ? '=' : kAlphabet[bits >> (18 - 6 * k) & 63u];
  }
  return text;
}

inline std::string littleEndian32(uint64_t value) {
  std::string bytes;
  for (int i = 0; i < 4; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xffu);
  return bytes;
}

constexpr int kInt8 = 5120;
constexpr int kUInt8 = 5121;
constexpr int kInt16 = 5122;
constexpr int kUInt16 = 5123;
constexpr int kUInt32 = 5125;
constexpr int kFloat32 = 5126;

/// An asset under construction. `json` is free to be changed in any way before it is written.
struct GltfAsset {
  Json json = {{"asset", {{"version", "2.0"}}}};
  std::string data; ///< of buffer 0

  /// Appends bytes as a buffer view aligned to 4. Returns its index.
  size_t addView(const std::string& bytes) {
    data.resize((data.size() + 3) / 4 * 4);
    return add("bufferViews", {{"buffer", 0}, {"byteOffset", append(bytes)}, {"byteLength", bytes.size()}});
  }

  /// Appends values as a tightly packed accessor. Returns its index.
  template <class T>
  size_t addAccessor(const std::vector<T>& values, int componentType, const std::string& type,
                     bool normalized = false) {
    std::string bytes(values.size() * sizeof(T), '\0');
    std::memcpy(bytes.data(), values.data(), bytes.size());
    const size_t components = type == "SCALAR" ? 1 : type == "MAT4" ? 16 : static_cast<size_t>(type[3] - '0');
    Json accessor = {{"bufferView", addView(bytes)},
                     {"componentType", componentType},
                     {"count", values.size() / components},
                     {"type", type}};
    if (normalized) accessor["normalized"] = true;
    return add("accessors", accessor);
  }

  size_t addFloats(const std::vector<float>& values, const std::string& type) {
    return addAccessor(values, kFloat32, type);
  }

  size_t addIndices(const std::vector<uint16_t>& values) { return addAccessor(values, kUInt16, "SCALAR"); }

  size_t add(const std::string& array, const Json& item) {
    json[array].push_back(item);
    return json[array].size() - 1;
  }

  size_t addImage(const std::string& encoded, const std::string& mimeType = "image/png") {
    return add("images", {{"bufferView", addView(encoded)}, {"mimeType", mimeType}});
  }

  [[nodiscard]] Json& primitive() { return json["meshes"][0]["primitives"][0]; }
  [[nodiscard]] Json& attribute(const std::string& name) { return primitive()["attributes"][name]; }
  /// The first material, which the first primitive uses; made on demand.
  [[nodiscard]] Json& material() {
    if (!json.contains("materials")) {
      json["materials"].push_back(Json::object());
      primitive()["material"] = 0;
    }
    return json["materials"][0];
  }

  [[nodiscard]] std::string gltf() const {
    Json complete = json;
    if (!data.empty() && !complete.contains("buffers")) {
      complete["buffers"] = {
          {{"byteLength", data.size()}, {"uri", "data:application/octet-stream;base64," + base64(data)}}};
    }
    return complete.dump();
  }

  [[nodiscard]] std::string glb() const {
    Json complete = json;
    if (!data.empty() && !complete.contains("buffers")) complete["buffers"] = {{{"byteLength", data.size()}}};
    std::string text = complete.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string padded = data;
    padded.resize((padded.size() + 3) / 4 * 4, '\0');
    std::string chunks = littleEndian32(text.size()) + "JSON" + text;
    if (!padded.empty()) chunks += littleEndian32(padded.size()) + std::string("BIN\0", 4) + padded;
    return "glTF" + littleEndian32(2) + littleEndian32(chunks.size() + 12) + chunks;
  }

private:
  size_t append(const std::string& bytes) {
    const size_t offset = data.size();
    data += bytes;
    return offset;
  }
};

/// One triangle (0,0,0) (1,0,0) (0,1,0) without indices, on one node of one scene.
inline GltfAsset triangleAsset() {
  GltfAsset asset;
  const size_t positions = asset.addFloats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
  asset.json["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", positions}}}}}}}};
  asset.json["nodes"] = {{{"mesh", 0}}};
  asset.json["scenes"] = {{{"nodes", {0}}}};
  return asset;
}

/// The triangle with texture coordinates, ready for textures.
inline GltfAsset texturedTriangleAsset() {
  GltfAsset asset = triangleAsset();
  asset.attribute("TEXCOORD_0") = asset.addFloats({0, 0, 1, 0, 0, 1}, "VEC2");
  return asset;
}

inline Scene load(const std::string& bytes, const LoadOptions& options = {}) {
  const TemporaryFolder folder;
  return loadGltf(folder.write("asset.gltf", bytes), options);
}

inline Scene load(const GltfAsset& asset, const LoadOptions& options = {}) { return load(asset.gltf(), options); }

/// True where one warning contains `text`.
inline bool warns(const Scene& scene, const std::string& text) {
  for (const std::string& warning : scene.warnings) {
    if (warning.find(text) != std::string::npos) return true;
  }
  return false;
}

} // namespace isophote::test
