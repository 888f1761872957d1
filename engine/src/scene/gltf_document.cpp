#include "scene/gltf_document.hpp"

#include <algorithm>
#include <charconv>
#include <optional>

#include <fmt/format.h>

#include "isophote/error.hpp"
#include "scene/checked_math.hpp"
#include "scene/glb.hpp"
#include "scene/gltf_extensions.hpp"
#include "scene/gltf_schema.hpp"

namespace isophote::gltf {
namespace {

struct Version {
  uint32_t major = 0;
  uint32_t minor = 0;
};

/// `MAJOR.MINOR`, digits only.
std::optional<Version> parseVersion(const std::string& text) {
  const size_t dot = text.find('.');
  if (dot == std::string::npos) return std::nullopt;
  Version version;
  const char* begin = text.data();
  const char* end = begin + text.size();
  const auto major = std::from_chars(begin, begin + dot, version.major);
  const auto minor = std::from_chars(begin + dot + 1, end, version.minor);
  if (major.ec != std::errc{} || major.ptr != begin + dot || minor.ec != std::errc{} || minor.ptr != end) {
    return std::nullopt;
  }
  return version;
}

Version readVersion(const Document& document, const Json& asset, const char* name) {
  const Json* text = member(asset, name);
  const std::optional<Version> version =
      text && text->is_string() ? parseVersion(text->get<std::string>()) : std::nullopt;
  if (!version) document.fail(fmt::format("/asset/{}", name), "a string such as \"2.0\"");
  return *version;
}

void checkVersion(const Document& document) {
  const Json* asset = member(document.root, "asset");
  if (!asset || !asset->is_object()) document.fail("/asset", "an object with the glTF version");
  const Version version = readVersion(document, *asset, "version");
  if (version.major != 2) {
    document.fail("/asset/version", fmt::format("glTF 2.x, found {}.{}", version.major, version.minor));
  }
  if (!asset->contains("minVersion")) return;
  const Version least = readVersion(document, *asset, "minVersion");
  if (least.major != 2 || least.minor > 0) {
    throw UnsupportedError(document.file, "/asset/minVersion",
                           fmt::format("glTF 2.0, the asset requires {}.{}", least.major, least.minor));
  }
}

} // namespace

void Document::fail(const std::string& pointer, const std::string& expected) const {
  throw SceneError(file, pointer, expected);
}

void Document::claim(uint64_t bytes, const std::string& pointer) {
  const std::optional<uint64_t> sum = checkedAdd(decodedBytes, bytes);
  if (!sum || *sum > options.maxBufferBytes) {
    throw LimitError(fmt::format("{}: {}: {} more bytes of decoded data are needed, {} of {} are left", file, pointer,
                                 bytes, options.maxBufferBytes - decodedBytes, options.maxBufferBytes));
  }
  decodedBytes = *sum;
}

Document openDocument(const std::filesystem::path& file, const LoadOptions& options) {
  Document document;
  document.file = file.string();
  document.folder = file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
  document.options = options;
  const uint64_t maxFileBytes = kMaxJsonBytes + std::min(options.maxBufferBytes, UINT64_MAX - kMaxJsonBytes);
  document.fileBytes = readFileBytes(file, maxFileBytes, document.file, "");
  if (document.fileBytes.empty()) document.fail("", "a glTF asset, the file is empty");
  if (isGlb(document.fileBytes)) {
    const GlbChunks chunks = splitGlb(document.file, document.fileBytes, document.warnings);
    document.root = parseJson(document.file, chunks.json);
    document.binaryChunk = chunks.binary;
  } else {
    document.root = parseJson(document.file, document.fileBytes);
    document.fileBytes = Bytes(); // the tree holds all of it
  }
  checkVersion(document);
  checkExtensions(document);
  checkSchema(document.file, document.root);
  return document;
}

} // namespace isophote::gltf
