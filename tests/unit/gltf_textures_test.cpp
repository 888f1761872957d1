// Images of every kind that glTF allows, samplers, and what is decoded at all.
#include <gtest/gtest.h>

#include <stb/stb_image_write.h>

#include "isophote/error.hpp"
#include "unit/gltf_asset.hpp"
#include "unit/gltf_png.hpp"

using namespace isophote;
using namespace isophote::test;

namespace {

GltfAsset assetWithImage(const std::string& encoded, const std::string& mimeType = "image/png") {
  GltfAsset asset = texturedTriangleAsset();
  asset.material()["emissiveTexture"] = {{"index", 0}};
  asset.add("textures", {{"source", asset.addImage(encoded, mimeType)}});
  return asset;
}

ImageData decoded(const std::string& encoded) { return load(assetWithImage(encoded)).images.at(0); }

std::vector<int> values8(const ImageData& image) {
  std::vector<int> result;
  for (const std::byte b : image.pixels) result.push_back(std::to_integer<int>(b));
  return result;
}

std::vector<int> values16(const ImageData& image) {
  std::vector<int> result;
  for (size_t i = 0; i + 1 < image.pixels.size(); i += 2) {
    result.push_back(std::to_integer<int>(image.pixels[i]) | std::to_integer<int>(image.pixels[i + 1]) << 8);
  }
  return result;
}

} // namespace

TEST(GltfTextures, RgbaPngIsDecodedRowByRowFromTheTop) {
  const ImageData image = decoded(png({.width = 1, .height = 2, .rows = "\x01\x02\x03\x04\x05\x06\x07\x08"}));
  EXPECT_EQ(image.width, 1u);
  EXPECT_EQ(image.height, 2u);
  EXPECT_EQ(image.bitsPerChannel, 8u);
  EXPECT_EQ(values8(image), (std::vector<int>{1, 2, 3, 4, 5, 6, 7, 8}));
}

TEST(GltfTextures, GrayAndRgbPngAreFilledUp) {
  EXPECT_EQ(values8(decoded(png({.colorType = 0, .rows = "\x07"}))), (std::vector<int>{7, 7, 7, 255}));
  EXPECT_EQ(values8(decoded(png({.colorType = 4, .rows = "\x07\x09"}))), (std::vector<int>{7, 7, 7, 9}));
  EXPECT_EQ(values8(decoded(png({.colorType = 2, .rows = "\x01\x02\x03"}))), (std::vector<int>{1, 2, 3, 255}));
}

TEST(GltfTextures, PalettesAreExpanded) {
  const ImageData image = decoded(
      png({.width = 2, .bitDepth = 8, .colorType = 3, .rows = {'\1', '\0'}, .palette = "\x0a\x0b\x0c\x0d\x0e\x0f"}));
  EXPECT_EQ(values8(image), (std::vector<int>{13, 14, 15, 255, 10, 11, 12, 255}));
}

TEST(GltfTextures, SixteenBitPngKeepsItsBits) {
  const ImageData rgba = decoded(png({.bitDepth = 16, .rows = "\x12\x34\x56\x78\x9a\xbc\xde\xf0"}));
  EXPECT_EQ(rgba.bitsPerChannel, 16u);
  EXPECT_EQ(values16(rgba), (std::vector<int>{0x1234, 0x5678, 0x9abc, 0xdef0}));
  const ImageData gray = decoded(png({.bitDepth = 16, .colorType = 0, .rows = "\x12\x34"}));
  EXPECT_EQ(values16(gray), (std::vector<int>{0x1234, 0x1234, 0x1234, 0xffff}));
}

TEST(GltfTextures, JpegIsDecoded) {
  std::string jpeg;
  const std::string gray(16 * 16 * 3, '\x80');
  const auto append = [](void* context, void* bytes, int size) {
    static_cast<std::string*>(context)->append(static_cast<const char*>(bytes), static_cast<size_t>(size));
  };
  ASSERT_NE(stbi_write_jpg_to_func(append, &jpeg, 16, 16, 3, gray.data(), 95), 0);
  const Scene scene = load(assetWithImage(jpeg, "image/jpeg"));
  const ImageData& image = scene.images.at(0);
  EXPECT_EQ(image.width, 16u);
  EXPECT_NEAR(std::to_integer<int>(image.pixels.at(0)), 128, 2);
  EXPECT_EQ(std::to_integer<int>(image.pixels.at(3)), 255);
}

TEST(GltfTextures, ImagesComeFromFilesAndDataUris) {
  const TemporaryFolder folder;
  folder.write("images/a b.png", pngPixel(1, 0, 0, 255));
  GltfAsset asset = assetWithImage(pngPixel(9, 0, 0, 255));
  asset.json["images"][0] = {{"uri", "images/a%20b.png"}, {"name", "file"}};
  const Scene fromFile = loadGltf(folder.write("asset.gltf", asset.gltf()));
  EXPECT_EQ(values8(fromFile.images.at(0))[0], 1);
  EXPECT_EQ(fromFile.images.at(0).name, "file");
  asset.json["images"][0] = {{"uri", "data:image/png;base64," + base64(pngPixel(2, 0, 0, 255))}};
  EXPECT_EQ(values8(load(asset).images.at(0))[0], 2);
}

TEST(GltfTextures, SamplersAreRead) {
  GltfAsset asset = assetWithImage(pngPixel(1, 0, 0, 255));
  asset.material()["normalTexture"] = {{"index", 1}};
  asset.material()["occlusionTexture"] = {{"index", 0}};
  asset.add("textures", {{"source", 0}, {"sampler", 0}});
  asset.json["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}, {"minFilter", 9987}}};
  const Scene scene = load(asset);
  EXPECT_EQ(scene.images.size(), 1u) << "two textures share the image";
  const Texture& sampled = scene.textures.at(static_cast<size_t>(scene.materials.at(0).normalTexture.texture));
  EXPECT_EQ(sampled.wrapS, Wrap::ClampToEdge);
  EXPECT_EQ(sampled.wrapT, Wrap::MirroredRepeat);
  EXPECT_EQ(sampled.filter, Filter::Nearest);
  const Texture& plain = scene.textures.at(static_cast<size_t>(scene.materials.at(0).emissiveTexture.texture));
  EXPECT_EQ(plain.wrapS, Wrap::Repeat);
  EXPECT_EQ(plain.wrapT, Wrap::Repeat);
  EXPECT_EQ(plain.filter, Filter::Linear);
}

TEST(GltfTextures, WhatNoMaterialNeedsIsNotDecoded) {
  GltfAsset asset = assetWithImage(pngPixel(1, 0, 0, 255));
  asset.add("images", {{"uri", "missing.png"}});
  asset.add("textures", {{"source", 1}});
  asset.material()["occlusionTexture"] = {{"index", 1}}; // a path tracer computes occlusion itself
  asset.add("materials", {{"emissiveTexture", {{"index", 1}}}});
  EXPECT_EQ(load(asset).images.size(), 1u);
}

TEST(GltfTextures, OptionalBasisuFallsBackToTheSource) {
  const std::string name = "KHR_texture_basisu";
  GltfAsset asset = assetWithImage(pngPixel(1, 0, 0, 255));
  asset.json["extensionsUsed"] = {name};
  asset.add("images", {{"uri", "missing.ktx2"}});
  asset.json["textures"][0]["extensions"][name] = {{"source", 1}};
  const Scene withFallback = load(asset);
  EXPECT_TRUE(withFallback.materials.at(0).emissiveTexture.present());
  EXPECT_EQ(withFallback.extensionsIgnored, std::vector<std::string>{name});
  asset.json["textures"][0].erase("source");
  const Scene without = load(asset);
  EXPECT_FALSE(without.materials.at(0).emissiveTexture.present());
  EXPECT_TRUE(warns(without, "/textures/0: a texture without an image that this build decodes is left out"));
  asset.json["extensionsRequired"] = {name};
  EXPECT_THROW((void)load(asset), UnsupportedError);
}
