// Files that are not what they claim: bad inputs 1 to 7 (files, GLB, JSON, versions, URIs).
#include <filesystem>

#include <gtest/gtest.h>

#include "robustness/refusal.hpp"
#include "unit/gltf_png.hpp"

using namespace isophote;
using namespace isophote::test;
namespace fs = std::filesystem;

namespace {

std::string messageOf(const fs::path& file) {
  try {
    (void)loadGltf(file);
  } catch (const SceneError& error) {
    return error.what();
  }
  return "accepted";
}

/// A GLB with its header or chunk fields overwritten: 4 little-endian bytes at each offset.
std::string patchedGlb(const std::vector<std::pair<size_t, uint64_t>>& fields) {
  std::string glb = triangleAsset().glb();
  for (const auto& [offset, value] : fields) glb.replace(offset, 4, littleEndian32(value));
  return glb;
}

constexpr size_t kVersion = 4;
constexpr size_t kLength = 8;
constexpr size_t kJsonLength = 12;

GltfAsset withBufferUri(const std::string& uri) {
  GltfAsset asset = triangleAsset();
  asset.json["buffers"] = {{{"byteLength", asset.data.size()}, {"uri", uri}}};
  return asset;
}

} // namespace

TEST(BadInput01, MissingFilesFoldersAndEmptyFilesAreRefusedByName) {
  const TemporaryFolder folder;
  EXPECT_NE(messageOf(folder.path() / "none.gltf").find("none.gltf: no such file"), std::string::npos);
  EXPECT_NE(messageOf(folder.path()).find("not a regular file"), std::string::npos);
  EXPECT_NE(messageOf(folder.write("empty.gltf", "")).find("empty.gltf: "), std::string::npos);
  EXPECT_NE(messageOf("/dev/null").find("not a regular file"), std::string::npos);
}

TEST(BadInput01, UnreadableFilesAreRefused) {
  const TemporaryFolder folder;
  const fs::path file = folder.write("locked.gltf", triangleAsset().gltf());
  fs::permissions(file, fs::perms::none);
  if (access(file.c_str(), R_OK) == 0) GTEST_SKIP() << "this user may read everything";
  EXPECT_NE(messageOf(file).find("cannot be opened"), std::string::npos);
}

TEST(BadInput02, GlbHeadersThatDoNotFitTheFileAreRefused) {
  const std::string glb = triangleAsset().glb();
  EXPECT_EQ(load(glb).instances.size(), 1u) << "unpatched, it loads";
  expectRefused<SceneError>("glTX" + glb.substr(4), {"JSON"});
  expectRefused<SceneError>(patchedGlb({{kVersion, 1}}), {"GLB_INVALID_VERSION"});
  expectRefused<SceneError>(patchedGlb({{kLength, glb.size() + 1}}), {"GLB_LENGTH_MISMATCH"});
  expectRefused<SceneError>(patchedGlb({{kLength, 0xffffffff}}), {"GLB_LENGTH_MISMATCH"});
  expectRefused<SceneError>(patchedGlb({{kLength, 4}}), {"GLB_LENGTH_MISMATCH"});
  expectRefused<SceneError>("glTF" + littleEndian32(2), {"GLB_UNEXPECTED_END_OF_HEADER"});
}

TEST(BadInput02, GlbChunksThatDoNotFitTheFileAreRefused) {
  expectRefused<SceneError>(patchedGlb({{kJsonLength, 0xffffffff}}), {"GLB_CHUNK_TOO_BIG"});
  expectRefused<SceneError>(patchedGlb({{kJsonLength, triangleAsset().glb().size() - 19}}), {"GLB_CHUNK_TOO_BIG"});
  expectRefused<SceneError>(patchedGlb({{16, 0x004e4942}}), {"GLB_UNEXPECTED_FIRST_CHUNK"});
  expectRefused<SceneError>("glTF" + littleEndian32(2) + littleEndian32(20) + littleEndian32(0) + "JSON",
                            {"GLB_EMPTY_CHUNK"});
  expectRefused<SceneError>("glTF" + littleEndian32(2) + littleEndian32(12), {"GLB_EMPTY_CHUNK"});
  expectRefused<SceneError>("glTF" + littleEndian32(2) + littleEndian32(16) + littleEndian32(0),
                            {"GLB_UNEXPECTED_END_OF_CHUNK_HEADER"});
}

TEST(BadInput02, EveryTruncationOfAGlbIsRefused) {
  const TemporaryFolder folder;
  const std::string glb = triangleAsset().glb();
  for (size_t size = 0; size < glb.size(); ++size) (void)refusalOf<SceneError>(folder, glb.substr(0, size));
}

TEST(BadInput03, BrokenJsonIsRefused) {
  for (const std::string text : {"{", "[]", "{\"asset\":}", "{\"asset\" {}}", "nonsense", "{\"a\":1}x", "\xff\xfe"}) {
    expectRefused<SceneError>(text, {});
  }
  expectRefused<SceneError>("{\"asset\":{\"version\":\"2.0\",\"x\":1e999}}", {"valid JSON"});
  expectRefused<SceneError>("{\"asset\":{\"version\":\"2.0\",\"x\":NaN}}", {"valid JSON"});
}

TEST(BadInput03, DeepNestingIsRefusedWithoutRecursion) {
  expectRefused<SceneError>("{\"a\":" + std::string(1'000'000, '['), {"nested at most 128 deep"});
  std::string objects;
  for (int i = 0; i < 200'000; ++i) objects += "{\"a\":";
  expectRefused<SceneError>(objects, {"nested at most 128 deep"});
}

TEST(BadInput03, RepeatedKeysAreRefused) {
  expectRefused<SceneError>("{\"asset\":{\"version\":\"2.0\",\"version\":\"1.0\"}}", {"\"version\" stands twice"});
}

TEST(BadInput03, LongArraysTakeLinearTime) {
  // nlohmann's parser with a callback needs minutes for this.
  std::string text = "{\"asset\":{\"version\":\"2.0\"},\"x\":[{}";
  for (int i = 0; i < 500'000; ++i) text += ",{}";
  EXPECT_TRUE(load(text + "]}").instances.empty());
}

TEST(BadInput04, VersionsOtherThanTwoAreRefused) {
  GltfAsset asset = triangleAsset();
  asset.json["asset"] = Json::object();
  expectRefused<SceneError>(asset, {"/asset/version: "});
  asset.json.erase("asset");
  expectRefused<SceneError>(asset, {"/asset: "});
  for (const std::string version : {"3.0", "1.0", "2", "2.x", "", "2.0.1", "-2.0"}) {
    asset.json["asset"] = {{"version", version}};
    expectRefused<SceneError>(asset, {"/asset/version: "});
  }
  asset.json["asset"] = {{"version", 2.0}};
  expectRefused<SceneError>(asset, {"/asset/version: "});
  asset.json["asset"] = {{"version", "2.1"}};
  EXPECT_EQ(load(asset).instances.size(), 1u) << "minor versions are compatible";
  asset.json["asset"] = {{"version", "2.1"}, {"minVersion", "2.1"}};
  expectRefused<UnsupportedError>(asset, {"/asset/minVersion: "});
}

TEST(BadInput04, RequiredExtensionsThatAreNotModeledAreAllListed) {
  GltfAsset asset = triangleAsset();
  asset.json["extensionsRequired"] = {"KHR_materials_ior", "ACME_one", "EXT_two"};
  expectRefused<UnsupportedError>(asset, {"/extensionsRequired: ", "ACME_one, EXT_two"});
  asset.json["extensionsRequired"] = "ACME_one";
  expectRefused<SceneError>(asset, {"/extensionsRequired: "});
  asset.json["extensionsRequired"] = {1};
  expectRefused<SceneError>(asset, {"/extensionsRequired/0: "});
}

TEST(BadInput04, OptionalExtensionsThatAreNotModeledAreAWarningEach) {
  GltfAsset asset = triangleAsset();
  asset.json["extensionsUsed"] = {"KHR_materials_ior", "ACME_one", "EXT_two", "ACME_one"};
  const Scene scene = load(asset);
  EXPECT_EQ(scene.extensionsIgnored, (std::vector<std::string>{"ACME_one", "EXT_two"}));
  EXPECT_EQ(scene.extensionsUsed.size(), 4u);
  EXPECT_EQ(scene.warnings.size(), 2u);
}

TEST(BadInput05, MissingBuffersAndImagesAreRefused) {
  expectRefused<SceneError>(withBufferUri("none.bin"), {"/buffers/0/uri: ", "no such file"});
  GltfAsset asset = texturedTriangleAsset();
  asset.material()["emissiveTexture"] = {{"index", 0}};
  asset.add("textures", {{"source", 0}});
  asset.add("images", {{"uri", "none.png"}});
  expectRefused<SceneError>(asset, {"/images/0/uri: ", "no such file"});
  asset.json["images"][0] = Json::object();
  expectRefused<SceneError>(asset, {"/images/0: ", "a uri or a bufferView"});
  GltfAsset withoutUri = triangleAsset();
  withoutUri.json["buffers"] = {{{"byteLength", 36}}};
  expectRefused<SceneError>(withoutUri, {"/buffers/0: "});
}

TEST(BadInput05, TheCurrentFolderIsNeverSearched) {
  const TemporaryFolder current;
  const GltfAsset asset = withBufferUri("data.bin");
  current.write("data.bin", asset.data);
  const fs::path before = fs::current_path();
  fs::current_path(current.path());
  expectRefused<SceneError>(asset, {"no such file"});
  fs::current_path(before);
}

TEST(BadInput06, UrisThatLeaveTheFolderAreRefused) {
  const GltfAsset asset = triangleAsset();
  const TemporaryFolder outer;
  const fs::path secret = outer.write("secret.bin", asset.data);
  outer.write("inner/data.bin", asset.data);
  const auto loadFrom = [&](const std::string& uri, bool allowExternal) {
    return loadGltf(outer.write("inner/asset.gltf", withBufferUri(uri).gltf()), {.allowExternal = allowExternal});
  };
  EXPECT_EQ(loadFrom("data.bin", false).instances.size(), 1u);
  EXPECT_EQ(loadFrom("./data.bin", false).instances.size(), 1u);
  fs::create_symlink(secret, outer.path() / "inner/link.bin");
  fs::create_directory_symlink(outer.path(), outer.path() / "inner/up");
  for (const std::string& uri :
       {std::string("../secret.bin"), std::string("%2e%2e%2fsecret.bin"), std::string("x/../../secret.bin"),
        secret.string(), "file://" + secret.string(), std::string("link.bin"), std::string("up/secret.bin")}) {
    EXPECT_THROW((void)loadFrom(uri, false), SceneError) << uri;
    if (uri.find("x/") == std::string::npos) {
      EXPECT_EQ(loadFrom(uri, true).instances.size(), 1u) << uri << " with allowExternal";
    }
  }
}

TEST(BadInput06, OtherSchemesAreRefusedAlways) {
  for (const std::string uri : {"http://example.com/a.bin", "https:a.bin", "ftp://a", "C:\\a.bin", "c:/a.bin",
                                "javascript:a", "HTTP://example.com/a.bin"}) {
    expectRefused<SceneError>(withBufferUri(uri), {"/buffers/0/uri: "});
    expectRefused<SceneError>(withBufferUri(uri), {"/buffers/0/uri: "}, {.allowExternal = true});
  }
}

TEST(BadInput06, NulAndEmptyNamesAreRefused) {
  expectRefused<SceneError>(withBufferUri("a%00b"), {"/buffers/0/uri: "});
  expectRefused<SceneError>(withBufferUri(std::string("a\0b", 3)), {"/buffers/0/uri: "});
  expectRefused<SceneError>(withBufferUri(""), {"/buffers/0/uri: "});
}

TEST(BadInput06, BrokenDataUrisAreRefused) {
  for (const std::string uri : {"data:", "data:text/plain,abc", "data:;base64,AA*A", "data:;base64,A",
                                "data:application/octet-stream;base64"}) {
    expectRefused<SceneError>(withBufferUri(uri), {"/buffers/0/uri: "});
  }
}

TEST(BadInput07, ShellCharactersAreLiteral) {
  const TemporaryFolder folder;
  for (const std::string name : {"$(touch hit).bin", "`touch hit`.bin", "~", "$HOME.bin", "*.bin", "a b;c&d|e.bin"}) {
    const GltfAsset asset = withBufferUri(name);
    EXPECT_THROW((void)loadGltf(folder.write("asset.gltf", asset.gltf())), SceneError) << name;
    folder.write(name, asset.data);
    EXPECT_EQ(loadGltf(folder.path() / "asset.gltf").instances.size(), 1u) << name;
  }
  EXPECT_FALSE(fs::exists("hit"));
  EXPECT_FALSE(fs::exists(folder.path() / "hit"));
}
