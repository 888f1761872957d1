// Small assets in compressed forms: a bent sheet as Draco, as meshopt with every mode and filter, and a WebP texture.
#pragma once

#include <cmath>

#include "support/compress.hpp"
#include "unit/gltf_asset.hpp"

namespace isophote::test {

/// (n + 1)^2 vertices on z = x^2 / 4 over the unit square.
inline CompressibleMesh bentSheet(uint32_t n) {
  CompressibleMesh mesh;
  for (uint32_t row = 0; row <= n; ++row) {
    for (uint32_t column = 0; column <= n; ++column) {
      const float x = static_cast<float>(column) / static_cast<float>(n);
      const float y = static_cast<float>(row) / static_cast<float>(n);
      mesh.positions.emplace_back(x, y, x * x / 4);
      mesh.normals.push_back(glm::normalize(glm::vec3(-x / 2, 0, 1)));
      mesh.uvs.emplace_back(x, y);
    }
  }
  for (uint32_t row = 0; row < n; ++row) {
    for (uint32_t column = 0; column < n; ++column) {
      const uint32_t a = row * (n + 1) + column;
      const uint32_t b = a + n + 1;
      for (const uint32_t index : {a, a + 1, b + 1, a, b + 1, b}) mesh.indices.push_back(index);
    }
  }
  return mesh;
}

inline GltfAsset dracoAsset(DracoMethod method, uint32_t n = 4) {
  const DracoStream stream = encodeDraco(bentSheet(n), method);
  GltfAsset asset;
  const size_t view = asset.addView(stream.bytes);
  const auto accessor = [&](int componentType, const char* type, size_t count) {
    return asset.add("accessors", {{"componentType", componentType}, {"count", count}, {"type", type}});
  };
  Json attributes = {{"POSITION", accessor(kFloat32, "VEC3", stream.points)},
                     {"NORMAL", accessor(kFloat32, "VEC3", stream.points)},
                     {"TEXCOORD_0", accessor(kFloat32, "VEC2", stream.points)}};
  Json primitive = {{"attributes", attributes}, {"indices", accessor(kUInt16, "SCALAR", stream.faces * 3)}};
  primitive["extensions"]["KHR_draco_mesh_compression"] = {
      {"bufferView", view},
      {"attributes", {{"POSITION", kDracoPosition}, {"NORMAL", kDracoNormal}, {"TEXCOORD_0", kDracoUv}}}};
  asset.json["meshes"] = {{{"primitives", {primitive}}}};
  asset.json["nodes"] = {{{"mesh", 0}}};
  asset.json["scenes"] = {{{"nodes", {0}}}};
  asset.json["extensionsUsed"] = {"KHR_draco_mesh_compression"};
  asset.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  return asset;
}

inline std::string bytesOf(const auto& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(values[0])};
}

/// Adds a view of `count` elements that is packed as `extension` says. Returns its index.
inline size_t addPackedView(GltfAsset& asset, const std::string& extension, const std::string& packed,
                            const std::string& mode, const std::string& filter, size_t count, size_t stride) {
  const size_t source = asset.addView(packed);
  const Json parameters = {{"buffer", 0},
                           {"byteOffset", asset.json["bufferViews"][source]["byteOffset"]},
                           {"byteLength", packed.size()},
                           {"byteStride", stride},
                           {"count", count},
                           {"mode", mode},
                           {"filter", filter}};
  Json view = {{"buffer", 1}, {"byteLength", count * stride}, {"extensions", {{extension, parameters}}}};
  if (mode == "ATTRIBUTES") view["byteStride"] = stride;
  return asset.add("bufferViews", view);
}

/// Two copies of the sheet: triangles with plain positions and octahedral normals, and a sequence of indices with
/// exponential positions, the second turned twice by quaternions of EXT_mesh_gpu_instancing.
inline GltfAsset meshoptAsset(const std::string& extension = "EXT_meshopt_compression", uint32_t n = 4) {
  const CompressibleMesh sheet = bentSheet(n);
  const size_t count = sheet.positions.size();
  std::vector<glm::vec4> normals;
  for (const glm::vec3 normal : sheet.normals) normals.emplace_back(normal, 0);
  const std::vector<glm::vec4> turns = {{0, 0, 0, 1}, {0, 0, std::sqrt(0.5f), std::sqrt(0.5f)}};

  GltfAsset asset;
  const auto accessor = [&](size_t view, int componentType, const char* type, size_t elements, bool normalized) {
    return asset.add("accessors", {{"bufferView", view},
                                   {"componentType", componentType},
                                   {"count", elements},
                                   {"type", type},
                                   {"normalized", normalized}});
  };
  const auto attribute = [&](const std::string& elements, const std::string& filter, size_t stride, int type,
                             const char* shape) {
    const size_t view = addPackedView(asset, extension, encodeMeshoptVertices(elements, stride), "ATTRIBUTES", filter,
                                      elements.size() / stride, stride);
    return accessor(view, type, shape, elements.size() / stride, type != kFloat32);
  };
  const auto indices = [&](const std::string& packed, const std::string& mode) {
    const size_t view = addPackedView(asset, extension, packed, mode, "NONE", sheet.indices.size(), 4);
    return accessor(view, kUInt32, "SCALAR", sheet.indices.size(), false);
  };
  const size_t exact = attribute(bytesOf(sheet.positions), "NONE", 12, kFloat32, "VEC3");
  const size_t rounded = attribute(filterExponential(sheet.positions), "EXPONENTIAL", 12, kFloat32, "VEC3");
  const size_t normal = attribute(filterOctahedral(normals), "OCTAHEDRAL", 4, kInt8, "VEC3");
  const size_t turn = attribute(filterQuaternion(turns), "QUATERNION", 8, kInt16, "VEC4");
  const size_t triangles = indices(encodeMeshoptTriangles(sheet.indices, count), "TRIANGLES");
  const size_t sequence = indices(encodeMeshoptIndices(sheet.indices, count), "INDICES");

  asset.json["meshes"] = {
      {{"primitives", {{{"attributes", {{"POSITION", exact}, {"NORMAL", normal}}}, {"indices", triangles}}}}},
      {{"primitives", {{{"attributes", {{"POSITION", rounded}}}, {"indices", sequence}}}}}};
  asset.json["nodes"] = {{{"mesh", 0}}, {{"mesh", 1}}};
  asset.json["nodes"][1]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["ROTATION"] = turn;
  asset.json["scenes"] = {{{"nodes", {0, 1}}}};
  asset.json["extensionsUsed"] = {extension, "EXT_mesh_gpu_instancing"};
  asset.json["extensionsRequired"] = {extension};
  asset.json["buffers"] = {{{"byteLength", asset.data.size()}},
                           {{"byteLength", 1 << 20}, {"extensions", {{extension, {{"fallback", true}}}}}}};
  return asset;
}

/// A triangle with a texture of 2 x 2 pixels: red, green, blue, and white half transparent.
inline const std::string kFourPixels("\xff\0\0\xff\0\xff\0\xff\0\0\xff\xff\xff\xff\xff\x80", 16);
inline GltfAsset webpAsset() {
  GltfAsset asset = texturedTriangleAsset();
  const size_t image = asset.addImage(encodeWebp(2, 2, kFourPixels), "image/webp");
  asset.add("textures", {{"extensions", {{"EXT_texture_webp", {{"source", image}}}}}});
  asset.material()["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 0;
  asset.json["extensionsUsed"] = {"EXT_texture_webp"};
  asset.json["extensionsRequired"] = {"EXT_texture_webp"};
  return asset;
}

} // namespace isophote::test
