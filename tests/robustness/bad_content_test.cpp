// Content that is too large, unknown or out of range: bad inputs 19 to 26 and 28.
#include <cmath>

#include <gtest/gtest.h>

#include <stb/stb_image_write.h>

#include "isophote/image.hpp"
#include "robustness/refusal.hpp"
#include "unit/gltf_png.hpp"

using namespace isophote;
using namespace isophote::test;

namespace {

GltfAsset withImage(const std::string& encoded, const std::string& mimeType = "image/png") {
  GltfAsset asset = texturedTriangleAsset();
  asset.material()["emissiveTexture"] = {{"index", 0}};
  asset.add("textures", {{"source", asset.addImage(encoded, mimeType)}});
  return asset;
}

std::string jpeg(int size) {
  std::string result;
  std::string noise;
  uint32_t state = 1;
  for (int i = 0; i < size * size * 3; ++i) {
    state = state * 1664525u + 1013904223u;
    noise += static_cast<char>(state >> 24);
  }
  const auto append = [](void* context, void* bytes, int count) {
    static_cast<std::string*>(context)->append(static_cast<const char*>(bytes), static_cast<size_t>(count));
  };
  stbi_write_jpg_to_func(append, &result, size, size, 3, noise.data(), 90);
  return result;
}

GltfAsset withMaterial(const Json& material) {
  GltfAsset asset = triangleAsset();
  asset.material() = material;
  return asset;
}

GltfAsset withCamera(const std::string& type, const Json& projection) {
  GltfAsset asset = triangleAsset();
  asset.json["nodes"][0]["camera"] = 0;
  asset.add("cameras", {{"type", type}, {type, projection}});
  return asset;
}

} // namespace

TEST(BadInput19, AnImageBombIsRefusedBeforeItIsAllocated) {
  // 100,000 x 100,000 pixels in 70 bytes.
  const std::string bomb = pngHeader(100'000, 100'000, 8, 6) + pngChunk("IDAT", storedZlib("x")) + pngChunk("IEND", "");
  expectRefused<LimitError>(withImage(bomb), {"/images/0: ", "100000 x 100000 pixels"});
  const std::string large = png({.width = 3, .height = 3, .rows = std::string(36, '\1')});
  expectRefused<LimitError>(withImage(large), {"3 x 3 pixels, the limit is 8"}, {.maxImagePixels = 8});
}

TEST(BadInput19, AnImageThatInflatesBeyondItsSizeIsRefused) {
  // A one-pixel PNG whose data expand to 64 MiB: deflate's fixed codes, one literal 0 and runs of 258 zeros.
  std::string deflated = "\x78\x01";
  uint32_t bits = 0;
  uint32_t count = 0;
  const auto put = [&](uint32_t value, uint32_t width) {
    bits |= value << count;
    count += width;
    for (; count >= 8; count -= 8, bits >>= 8) deflated += static_cast<char>(bits & 0xffu);
  };
  put(1, 1);    // last block
  put(1, 2);    // fixed Huffman codes (RFC 1951, 3.2.6)
  put(0x0c, 8); // literal 0: 00110000, most significant bit first
  for (int i = 0; i < (64 << 20) / 258; ++i) {
    put(0xa3, 8); // length 258: 11000101
    put(0, 5);    // distance 1
  }
  put(0, 7); // end of block
  put(0, 7);
  const std::string bomb = pngHeader(1, 1, 8, 6) + pngChunk("IDAT", deflated) + pngChunk("IEND", "");
  expectRefused<SceneError>(withImage(bomb), {"/images/0: ", "IMAGE_DATA_INVALID"});
}

TEST(BadInput19, EveryTruncationOfAnImageIsRefused) {
  const TemporaryFolder folder;
  std::string rows;
  for (int i = 0; i < 64; ++i) rows += static_cast<char>(i * 37);
  const std::string pngFile = png({.width = 4, .height = 4, .rows = rows});
  for (size_t size = 1; size < pngFile.size() - 12; ++size) { // all before the end marker
    (void)refusalOf<SceneError>(folder, withImage(pngFile.substr(0, size)).gltf());
  }
  const std::string jpegFile = jpeg(16);
  for (size_t size = 1; size + 2 < jpegFile.size(); size += 7) {
    (void)refusalOf<SceneError>(folder, withImage(jpegFile.substr(0, size), "image/jpeg").gltf());
  }
}

TEST(BadInput19, OtherFormatsAndWrongMediaTypesAreRefused) {
  expectRefused<SceneError>(withImage("GIF89a\1\0\1\0\0\0\0;"), {"/images/0: ", "IMAGE_UNRECOGNIZED_FORMAT"});
  expectRefused<SceneError>(withImage("x"), {"/images/0: ", "IMAGE_UNRECOGNIZED_FORMAT"});
  expectRefused<SceneError>(withImage(jpeg(8)), {"/images/0: ", "IMAGE_MIME_TYPE_INVALID"});
  expectRefused<SceneError>(withImage(pngPixel(0, 0, 0, 0), "image/jpeg"), {"/images/0: ", "IMAGE_MIME_TYPE_INVALID"});
}

TEST(BadInput19, SixteenBitGrayAndPaletteImagesAreDecoded) {
  EXPECT_EQ(load(withImage(png({.bitDepth = 16, .colorType = 0, .rows = "\x12\x34"}))).images.at(0).bitsPerChannel,
            16u);
  EXPECT_EQ(load(withImage(png({.colorType = 0, .rows = "\x12"}))).images.at(0).pixels.size(), 4u);
  EXPECT_EQ(
      load(withImage(png({.colorType = 3, .rows = {'\0'}, .palette = "\x01\x02\x03"}))).images.at(0).pixels.size(), 4u);
}

TEST(BadInput20, MoreThanTheBudgetIsRefusedWithBothNumbers) {
  expectRefused<LimitError>(triangleAsset(), {"/buffers: more than 35 bytes"}, {.maxBufferBytes = 35});
  // One small buffer, decoded a thousand times: 36 bytes each.
  GltfAsset asset = triangleAsset();
  asset.json["meshes"][0]["primitives"] = std::vector<Json>(1000, asset.primitive());
  EXPECT_EQ(load(asset, {.maxBufferBytes = 100'000}).meshes.at(0).primitives.size(), 1000u);
  expectRefused<LimitError>(asset, {"/accessors/0: 36 more bytes", "28 of 10000 are left"}, {.maxBufferBytes = 10'000});
  // 2 bytes a pixel in the file, 8 decoded.
  const std::string gray16 =
      png({.width = 64, .height = 64, .bitDepth = 16, .colorType = 0, .rows = std::string(8192, '\1')});
  expectRefused<LimitError>(withImage(gray16), {"/images/0: 32768 more bytes"}, {.maxBufferBytes = 17'000});
}

TEST(BadInput21, RequiredBasisuIsUnsupported) {
  GltfAsset asset = triangleAsset();
  asset.json["extensionsUsed"] = {"KHR_texture_basisu"};
  EXPECT_TRUE(warns(load(asset), "KHR_texture_basisu is ignored, its fallback is used"));
  asset.json["extensionsRequired"] = {"KHR_texture_basisu"};
  expectRefused<UnsupportedError>(asset, {"/extensionsRequired: ", "KHR_texture_basisu"});
}

TEST(BadInput22, FactorsOutOfRangeAreClamped) {
  const Scene scene = load(withMaterial(
      {{"pbrMetallicRoughness",
        {{"roughnessFactor", -0.5}, {"metallicFactor", 1.5}, {"baseColorFactor", {2, 0, 0, 1}}}},
       {"extensions",
        {{"KHR_materials_ior", {{"ior", 0.99}}}, {"KHR_materials_emissive_strength", {{"emissiveStrength", 1e30}}}}}}));
  const Material& m = scene.materials.at(0);
  EXPECT_EQ(m.roughness, 0);
  EXPECT_EQ(m.metallic, 1);
  EXPECT_EQ(m.baseColor, glm::vec4(1, 0, 0, 1));
  EXPECT_EQ(m.ior, 1);
  EXPECT_EQ(scene.warnings.size(), 5u);
}

TEST(BadInput22, FactorsThatAreNotNumbersAreRefused) {
  std::string text = withMaterial({{"pbrMetallicRoughness", {{"roughnessFactor", 123456}}}}).gltf();
  text.replace(text.find("123456"), 6, "NaN");
  expectRefused<SceneError>(text, {"valid JSON"});
  for (const Json& bad : {Json(nullptr), Json("1"), Json(1e39), Json(-1e300), Json::array()}) {
    expectRefused<SceneError>(withMaterial({{"pbrMetallicRoughness", {{"roughnessFactor", bad}}}}),
                              {"/materials/0/pbrMetallicRoughness/roughnessFactor: "});
  }
  expectRefused<SceneError>(withMaterial({{"emissiveFactor", {1, 1}}}), {"/materials/0/emissiveFactor: "});
  expectRefused<SceneError>(withMaterial({{"extensions", {{"KHR_materials_ior", {{"ior", "big"}}}}}}),
                            {"/materials/0/extensions/KHR_materials_ior/ior: "});
}

TEST(BadInput23, AnimatedAssetsLoadInTheirStaticPose) {
  GltfAsset asset = triangleAsset();
  asset.json["animations"] = {{{"channels", "whatever"}}};
  const Scene scene = load(asset);
  EXPECT_EQ(scene.instances.size(), 1u);
  EXPECT_TRUE(warns(scene, "static pose"));
}

TEST(BadInput23, BrokenSkinsAreRefused) {
  GltfAsset asset = triangleAsset();
  asset.json["nodes"][0]["skin"] = 0;
  asset.json["skins"] = {{{"joints", Json::array()}}};
  expectRefused<SceneError>(asset, {"/skins/0/joints: "});
  asset.json["skins"] = {{{"joints", {0}}, {"inverseBindMatrices", 0}}};
  expectRefused<SceneError>(asset, {"/skins/0/inverseBindMatrices: "});
  asset.json["skins"] = {{{"joints", {0}}}};
  asset.attribute("JOINTS_0") = asset.addAccessor<uint8_t>(std::vector<uint8_t>(12, 7), kUInt8, "VEC4");
  expectRefused<SceneError>(asset, {"/meshes/0/primitives/0/attributes: ", "WEIGHTS_0"});
  asset.attribute("WEIGHTS_0") = asset.addFloats(std::vector<float>(12, 0.25f), "VEC4");
  expectRefused<SceneError>(asset, {"/meshes/0/primitives/0: ", "ACCESSOR_JOINTS_INDEX_OOB"});
}

TEST(BadInput24, PointsAndLinesAreSkippedWithOneWarning) {
  GltfAsset asset = triangleAsset();
  for (int mode = 0; mode < 4; ++mode) {
    Json primitive = asset.primitive();
    primitive["mode"] = mode;
    asset.json["meshes"][0]["primitives"].push_back(primitive);
  }
  const Scene scene = load(asset);
  EXPECT_EQ(scene.meshes.at(0).primitives.size(), 1u);
  EXPECT_EQ(scene.warnings.size(), 1u);
  asset.primitive()["mode"] = 7;
  expectRefused<SceneError>(asset, {"/meshes/0/primitives/0/mode: "});
}

TEST(BadInput25, AnEmptySceneLoadsAndHasACamera) {
  for (const std::string text : {R"({"asset":{"version":"2.0"}})", R"({"asset":{"version":"2.0"},"scenes":[{}]})"}) {
    const Scene scene = load(text);
    EXPECT_TRUE(scene.instances.empty());
    EXPECT_TRUE(scene.lights.empty());
    EXPECT_TRUE(scene.cameras.empty());
    EXPECT_TRUE(worldBounds(scene).empty());
    EXPECT_TRUE(std::isfinite(framingCamera(scene, 1.5).worldFromCamera[3].x));
  }
}

TEST(BadInput25, ALightWithoutPowerIsKept) {
  GltfAsset asset = triangleAsset();
  asset.json["nodes"][0]["extensions"]["KHR_lights_punctual"] = {{"light", 0}};
  asset.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", 0}}};
  EXPECT_EQ(load(asset).lights.at(0).intensity, glm::vec3(0));
  asset.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "sun"}}};
  expectRefused<SceneError>(asset, {"/extensions/KHR_lights_punctual/lights/0/type: "});
}

TEST(BadInput26, CamerasThatCannotProjectAreRefused) {
  const Json valid = {{"yfov", 1}, {"znear", 0.1}, {"zfar", 10}, {"aspectRatio", 1}};
  EXPECT_EQ(load(withCamera("perspective", valid)).cameras.size(), 1u);
  for (const auto& [name, value] : std::vector<std::pair<std::string, Json>>{{"yfov", 0},
                                                                             {"yfov", -1},
                                                                             {"yfov", 3.14159265358979324},
                                                                             {"yfov", 1e300},
                                                                             {"yfov", nullptr},
                                                                             {"aspectRatio", 0},
                                                                             {"aspectRatio", -1},
                                                                             {"znear", 0},
                                                                             {"znear", -1},
                                                                             {"zfar", 0.1},
                                                                             {"zfar", 0.05}}) {
    Json broken = valid;
    broken[name] = value;
    expectRefused<SceneError>(withCamera("perspective", broken), {"/cameras/0/perspective/" + name + ": "});
  }
  Json missing = valid;
  missing.erase("yfov");
  expectRefused<SceneError>(withCamera("perspective", missing), {"/cameras/0/perspective: ", "yfov"});
  const Json orthographic = {{"xmag", 1}, {"ymag", 1}, {"znear", 0}, {"zfar", 10}};
  for (const auto& [name, value] :
       std::vector<std::pair<std::string, Json>>{{"xmag", 0}, {"ymag", 0}, {"zfar", 0}, {"znear", -1}, {"zfar", "x"}}) {
    Json broken = orthographic;
    broken[name] = value;
    expectRefused<SceneError>(withCamera("orthographic", broken), {"/cameras/0/orthographic/" + name + ": "});
  }
  expectRefused<SceneError>(withCamera("fisheye", valid), {"/cameras/0/type: "});
}

TEST(BadInput28, BadEnvironmentsAreRefusedOrRepaired) {
  const TemporaryFolder folder;
  std::vector<std::string> warnings;
  const auto loadBytes = [&](const std::string& bytes) {
    return loadEnvironment(folder.write("sky.hdr", bytes), warnings);
  };
  const std::string header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";
  EXPECT_EQ(loadBytes(header + "-Y 1 +X 2\n" + std::string(8, '\0')).pixels, std::vector<glm::vec3>(2, glm::vec3(0)))
      << "all black is fine";
  EXPECT_TRUE(warnings.empty());
  EXPECT_THROW((void)loadBytes(header + "-Y 1 +X 2\n" + std::string(7, '\1')), SceneError) << "truncated";
  EXPECT_THROW((void)loadBytes(header + "-Y 16000 +X 32000\n"), LimitError);
  EXPECT_THROW((void)loadBytes(header + "-Y 0 +X 2\n"), SceneError);
  EXPECT_THROW((void)loadBytes(header), SceneError);
  EXPECT_THROW((void)loadBytes("nothing"), SceneError);
  EXPECT_THROW((void)loadBytes(""), SceneError);
  EXPECT_THROW((void)loadEnvironment(folder.path() / "none.hdr", warnings), SceneError);
  EXPECT_THROW((void)loadEnvironment(folder.path(), warnings), SceneError);
  EXPECT_THROW((void)loadBytes("\x76\x2f\x31\x01 not an image"), SceneError);
}

TEST(BadInput28, NanNegativeAndInfinitePixelsAreCounted) {
  const TemporaryFolder folder;
  Image image;
  image.width = 2;
  image.height = 1;
  image.channels = {{"R", {NAN, 1}}, {"G", {-1, 1}}, {"B", {INFINITY, 9}}};
  writeExr(folder.path() / "sky.exr", image);
  std::vector<std::string> warnings;
  EXPECT_EQ(loadEnvironment(folder.path() / "sky.exr", warnings).pixels[0], glm::vec3(0, 0, 9));
  EXPECT_EQ(warnings.size(), 3u);
}
