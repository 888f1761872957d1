#include "fuzz/gltf_mutator.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <vector>

#include "unit/gltf_asset.hpp"

namespace isophote::fuzz {
namespace {

using test::GltfAsset;
using Json = nlohmann::json;

constexpr std::array kNames{
    "KHR_materials_volume",
    "KHR_materials_transmission",
    "KHR_materials_diffuse_transmission",
    "KHR_materials_ior",
    "KHR_materials_clearcoat",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_iridescence",
    "KHR_materials_anisotropy",
    "KHR_materials_dispersion",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_materials_emissive_strength",
    "KHR_materials_volume_scatter",
    "KHR_texture_transform",
    "KHR_texture_basisu",
    "KHR_lights_punctual",
    "KHR_node_visibility",
    "KHR_draco_mesh_compression",
    "KHR_mesh_quantization",
    "KHR_materials_pbrSpecularGlossiness",
    "EXT_meshopt_compression",
    "EXT_mesh_gpu_instancing",
    "EXT_texture_webp",
    "EXT_lights_image_based",
    "extensions",
    "extras",
    "radius",
    "priority",
    "conductor",
    "sparse",
    "matrix",
    "rotation",
    "scale",
    "weights",
    "targets",
    "indices",
    "byteStride",
    "byteOffset",
    "byteLength",
    "count",
    "bufferView",
    "SCALAR",
    "VEC2",
    "VEC3",
    "VEC4",
    "MAT4",
    "POSITION",
    "NORMAL",
    "TANGENT",
    "TEXCOORD_0",
    "TEXCOORD_1",
    "COLOR_0",
    "JOINTS_0",
    "WEIGHTS_0",
    "MASK",
    "BLEND",
    "data:application/octet-stream;base64,AAAA",
    "image/png",
    "../x",
    "perspective",
    "orthographic",
    "spot",
    "point",
    "directional",
};

class Mutator {
public:
  Mutator(GltfAsset& asset, std::mt19937& random) : asset_(asset), random_(random) { collect(asset.json); }

  void change() {
    switch (random_() % 9) {
    case 0:
    case 1:
      number(any());
      break;
    case 2:
      remove(any());
      break;
    case 3:
      any() = Json(any());
      break;
    case 4:
      exchange(any(), any());
      break;
    case 5:
      name(any());
      break;
    case 6:
      repeat(any());
      break;
    case 7:
      member(any());
      break;
    default:
      data();
      break;
    }
  }

private:
  void collect(Json& value) {
    values_.push_back(&value);
    if (!value.is_structured()) return;
    for (Json& child : value) collect(child);
  }

  [[nodiscard]] Json& any() { return *values_[random_() % values_.size()]; }

  static bool holds(const Json& value, const Json& other) {
    if (&value == &other) return true;
    return value.is_structured() &&
           std::any_of(value.begin(), value.end(), [&](const Json& child) { return holds(child, other); });
  }

  /// Not of a value and a part of it, which would then hold each other.
  static void exchange(Json& a, Json& b) {
    if (!holds(a, b) && !holds(b, a)) std::swap(a, b);
  }

  [[nodiscard]] Json tellingNumber() {
    static const std::array<Json, 24> kNumbers{
        0,   1,    2,     3,   4,     7,    36,   -1,   255,  256,  65535,       0.5,
        1.5, -0.0, 1e-40, 1e9, 1e300, 5120, 5121, 5123, 5125, 5126, 4294967295u, std::numeric_limits<uint64_t>::max()};
    return kNumbers[random_() % kNumbers.size()];
  }

  void number(Json& value) {
    if (value.is_number_integer() && random_() % 2 == 0) {
      value = value.get<int64_t>() % 1'000'000 + (random_() % 2 == 0 ? 1 : -1);
    } else {
      value = tellingNumber();
    }
  }

  [[nodiscard]] std::string anyName() { return kNames[random_() % kNames.size()]; }

  void name(Json& value) { value = anyName(); }

  void remove(Json& value) {
    if (!value.is_structured() || value.empty()) return;
    auto at = value.begin();
    std::advance(at, random_() % value.size());
    value.erase(at);
  }

  void repeat(Json& value) {
    if (!value.is_array() || value.empty()) return;
    const Json element = value[random_() % value.size()];
    for (uint32_t i = random_() % 4 + 1; i > 0; --i) value.push_back(element);
  }

  void member(Json& value) {
    if (!value.is_object()) return;
    Json copy = any();
    if (random_() % 2 == 0) {
      value[anyName()] = std::move(copy);
    } else if (!value.contains("extensions") || value["extensions"].is_object()) {
      value["extensions"][anyName()] = std::move(copy);
    }
  }

  void data() {
    if (asset_.data.empty()) return;
    for (uint32_t i = random_() % 4 + 1; i > 0; --i)
      asset_.data[random_() % asset_.data.size()] ^= static_cast<char>(1u << random_() % 8);
  }

  GltfAsset& asset_;
  std::mt19937& random_;
  std::vector<Json*> values_;
};

uint32_t numberAt(const std::string& bytes, size_t offset) {
  uint32_t value = 0;
  std::memcpy(&value, bytes.data() + offset, sizeof(value));
  return value;
}

/// JSON and data of a GLB. False where it is none.
bool readGlb(const std::string& bytes, GltfAsset& asset) {
  constexpr size_t kHeader = 12, kChunk = 8;
  if (bytes.size() < kHeader + kChunk || !bytes.starts_with("glTF")) return false;
  const size_t length = numberAt(bytes, kHeader);
  if (length > bytes.size() - kHeader - kChunk) return false;
  asset.json = Json::parse(bytes.substr(kHeader + kChunk, length), nullptr, false);
  const size_t second = kHeader + kChunk + length;
  if (second + kChunk < bytes.size()) asset.data = bytes.substr(second + kChunk, numberAt(bytes, second));
  return !asset.json.is_discarded();
}

} // namespace

std::string mutateGltf(const std::string& bytes, std::mt19937& random) {
  GltfAsset asset;
  const bool glb = readGlb(bytes, asset);
  if (!glb) asset.json = Json::parse(bytes, nullptr, false);
  if (asset.json.is_discarded()) return bytes;
  for (uint32_t i = random() % 4 + 1; i > 0; --i) Mutator(asset, random).change();
  if (!asset.json.is_object()) return bytes;
  try {
    return glb ? asset.glb() : asset.json.dump();
  } catch (const Json::exception&) { // a name that is not UTF-8 was there before
    return bytes;
  }
}

} // namespace isophote::fuzz
