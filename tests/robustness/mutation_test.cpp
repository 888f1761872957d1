// Small assets with deterministic damage: each one loads or throws an isophote::Error, and nothing else happens.
// Built with ISOPHOTE_SANITIZE this also shows that no damage makes the loader read or write out of bounds.
#include <random>

#include <gtest/gtest.h>

#include <glm/gtc/constants.hpp>

#include "robustness/refusal.hpp"
#include "scene/draco_decode.hpp"
#include "scene/meshopt_decode.hpp"
#include "scene/webp_decode.hpp"
#include "unit/gltf_compressed.hpp"
#include "unit/gltf_png.hpp"

using namespace isophote;
using namespace isophote::test;

namespace {

/// Uses most features at once: strip, sparse, skin, morph, tangents, textures, lights, cameras, instancing.
GltfAsset richAsset() {
  GltfAsset asset = texturedTriangleAsset();
  const std::vector<float> square = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
  asset.attribute("POSITION") = asset.addFloats(square, "VEC3");
  asset.attribute("NORMAL") = asset.addFloats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  asset.attribute("TEXCOORD_0") = asset.addFloats({0, 0, 1, 0, 0, 1, 1, 1}, "VEC2");
  asset.attribute("COLOR_0") = asset.addAccessor<uint8_t>(std::vector<uint8_t>(16, 128), kUInt8, "VEC4", true);
  asset.attribute("JOINTS_0") = asset.addAccessor<uint8_t>(std::vector<uint8_t>(16, 0), kUInt8, "VEC4");
  asset.attribute("WEIGHTS_0") = asset.addFloats({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
  asset.primitive()["indices"] = asset.addIndices({0, 1, 2, 3});
  asset.primitive()["mode"] = 5;
  const float displaced[3] = {0, 0, 1};
  asset.primitive()["targets"] = {
      {{"POSITION",
        asset.add(
            "accessors",
            {{"componentType", kFloat32},
             {"count", 4},
             {"type", "VEC3"},
             {"sparse",
              {{"count", 1},
               {"indices", {{"bufferView", asset.addView(std::string(1, '\3'))}, {"componentType", kUInt8}}},
               {"values",
                {{"bufferView", asset.addView({reinterpret_cast<const char*>(displaced), sizeof(displaced)})}}}}}})}}};
  asset.json["meshes"][0]["weights"] = {0.5};
  asset.add("textures", {{"source", asset.addImage(png({.width = 2, .height = 2, .rows = std::string(16, '\x40')}))}});
  asset.material() = {{"normalTexture", {{"index", 0}}},
                      {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}};
  asset.json["nodes"] = {{{"mesh", 0}, {"skin", 0}},
                         {{"translation", {0, 1, 0}}, {"children", {2}}},
                         {{"mesh", 0}, {"rotation", {0, 0, 0, 1}}, {"camera", 0}},
                         {{"mesh", 0}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}};
  asset.json["nodes"][3]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] =
      asset.addFloats({0, 0, 0, 5, 0, 0}, "VEC3");
  asset.json["scenes"] = {{{"nodes", {0, 1, 3}}}};
  asset.json["skins"] = {{{"joints", {1, 2}}}};
  asset.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}}};
  asset.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "spot"}, {"spot", Json::object()}}};
  return asset;
}

/// Either outcome is fine; anything but an isophote::Error escapes and fails the test. Returns whether it loaded.
bool survives(const TemporaryFolder& folder, const std::string& bytes) {
  const LoadOptions small{.maxImagePixels = 1 << 16, .maxBufferBytes = 1 << 24, .maxNodes = 1000};
  try {
    const Scene scene = loadGltf(folder.write("asset.gltf", bytes), small);
    (void)framingCamera(scene, 1);
    return true;
  } catch (const Error&) {
    return false;
  }
}

std::string flipBytes(std::string bytes, std::mt19937& random) {
  const uint32_t count = 1 + random() % 4;
  for (uint32_t i = 0; i < count; ++i) bytes[random() % bytes.size()] ^= static_cast<char>(1u << random() % 8);
  return bytes;
}

std::string cut(std::string bytes, std::mt19937& random) {
  const size_t from = random() % bytes.size();
  return bytes.erase(from, 1 + random() % 64);
}

/// Replaces a number of the JSON by another one that loaders tend to trip over.
std::string swapNumber(std::string bytes, std::mt19937& random) {
  static const std::vector<std::string> kNumbers = {
      "0",    "1",     "2",          "3",          "7",    "-1",    "255",
      "256",  "65535", "2147483647", "4294967295", "1e9",  "0.5",   "18446744073709551615",
      "5120", "5121",  "5123",       "5125",       "5126", "1e300", "4294967296"};
  std::vector<std::pair<size_t, size_t>> numbers;
  for (size_t i = 0; i + 1 < bytes.size(); ++i) {
    const bool starts =
        (bytes[i] == ':' || bytes[i] == ',' || bytes[i] == '[') && (std::isdigit(bytes[i + 1]) || bytes[i + 1] == '-');
    if (!starts) continue;
    const size_t end = bytes.find_first_not_of("-+.eE0123456789", i + 1);
    if (end != std::string::npos) numbers.emplace_back(i + 1, end - i - 1);
  }
  const auto [offset, length] = numbers[random() % numbers.size()];
  return bytes.replace(offset, length, kNumbers[random() % kNumbers.size()]);
}

/// @param leastLoaded  damage that always matters would not test much
template <class Mutate>
void runMutations(const std::string& original, uint32_t seed, int count, int leastLoaded, const Mutate& mutate) {
  const TemporaryFolder folder;
  std::mt19937 random(seed);
  int loaded = 0;
  for (int i = 0; i < count; ++i) {
    SCOPED_TRACE(testing::Message() << "seed " << seed << ", case " << i);
    loaded += survives(folder, mutate(original, random));
  }
  EXPECT_GE(loaded, leastLoaded);
  EXPECT_LT(loaded, count) << "no damage at all";
}

/// The JSON with the buffer as a GLB chunk, so that swaps hit JSON only.
auto swapsIn(const GltfAsset& original) {
  return [original](const std::string& text, std::mt19937& random) {
    GltfAsset asset = original;
    asset.json = Json::parse(swapNumber(text, random));
    return asset.glb();
  };
}

/// Damages the data alone, so that every case reaches the decoders.
auto flipsInDataOf(const GltfAsset& original) {
  return [original](const std::string&, std::mt19937& random) {
    GltfAsset asset = original;
    asset.data = flipBytes(asset.data, random);
    return asset.glb();
  };
}

void runCompressedMutations(const GltfAsset& asset, uint32_t seed, int count) {
  ASSERT_NO_THROW((void)load(asset.glb()));
  runMutations("", seed, count, 0, flipsInDataOf(asset));
  runMutations(asset.json.dump(), seed + 1, count, count / 20, swapsIn(asset));
}

} // namespace

TEST(Mutation, TheUndamagedAssetLoadsWithAllItsParts) {
  const Scene scene = load(richAsset());
  EXPECT_EQ(scene.instances.size(), 4u);
  EXPECT_EQ(scene.cameras.size(), 1u);
  EXPECT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(scene.images.size(), 1u);
}

TEST(Mutation, FlippedBytesOfAGlbAreSurvived) { runMutations(richAsset().glb(), 1, 500, 25, flipBytes); }

TEST(Mutation, FlippedBytesOfAGltfAreSurvived) { runMutations(richAsset().gltf(), 2, 300, 15, flipBytes); }

// A piece missing from a GLB always contradicts its lengths; most end as such, some hit the JSON first.
TEST(Mutation, MissingPiecesAreSurvived) {
  runMutations(richAsset().glb(), 3, 150, 0, cut);
  runMutations(richAsset().gltf(), 5, 150, 0, cut);
}

TEST(Mutation, SwappedNumbersAreSurvived) { runMutations(richAsset().json.dump(), 4, 900, 45, swapsIn(richAsset())); }

// Larger meshes have longer streams, in which damage lands in every part of the decoder.
TEST(Mutation, DamagedDracoIsSurvived) {
  if (!dracoAvailable()) GTEST_SKIP() << "this build has no Draco";
  runCompressedMutations(dracoAsset(DracoMethod::Sequential), 6, 300);
  runCompressedMutations(dracoAsset(DracoMethod::Edgebreaker), 8, 300);
  runCompressedMutations(dracoAsset(DracoMethod::Edgebreaker, 20), 10, 300);
}

TEST(Mutation, DamagedMeshoptIsSurvived) {
  if (!meshoptAvailable()) GTEST_SKIP() << "this build has no meshoptimizer";
  runCompressedMutations(meshoptAsset(), 12, 500);
  runCompressedMutations(meshoptAsset("KHR_meshopt_compression", 20), 14, 300);
}

TEST(Mutation, DamagedWebpIsSurvived) {
  if (!webpAvailable()) GTEST_SKIP() << "this build has no WebP";
  runCompressedMutations(webpAsset(), 16, 500);
}
