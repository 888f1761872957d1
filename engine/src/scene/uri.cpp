#include "scene/uri.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <system_error>

#include <fmt/format.h>

#include "isophote/error.hpp"

namespace isophote::gltf {
namespace fs = std::filesystem;
namespace {

constexpr size_t kMaxShownUri = 80;

std::string shown(const std::string& uri) {
  return uri.size() <= kMaxShownUri ? uri : uri.substr(0, kMaxShownUri) + "...";
}

std::optional<uint32_t> hexDigit(char c) {
  if (c >= '0' && c <= '9') return static_cast<uint32_t>(c - '0');
  if (c >= 'a' && c <= 'f') return static_cast<uint32_t>(c - 'a' + 10);
  if (c >= 'A' && c <= 'F') return static_cast<uint32_t>(c - 'A' + 10);
  return std::nullopt;
}

/// The scheme of RFC 3986, section 3.1, in lower case without the colon; a drive letter counts as one.
std::optional<std::string> scheme(std::string_view uri) {
  const size_t colon = uri.find(':');
  if (colon == std::string_view::npos || colon == 0 || !std::isalpha(static_cast<unsigned char>(uri[0]))) return {};
  std::string result;
  for (const char c : uri.substr(0, colon)) {
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '+' && c != '-' && c != '.') return {};
    result += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return result;
}

LoadedUri loadDataUri(const Document& document, const std::string& uri, const std::string& pointer, uint64_t maxBytes) {
  const size_t comma = uri.find(',');
  if (comma == std::string::npos) document.fail(pointer, "a data URI with a comma before its data");
  const std::string_view header = std::string_view(uri).substr(5, comma - 5);
  const std::string_view data = std::string_view(uri).substr(comma + 1);
  LoadedUri result;
  result.mediaType = std::string(header.substr(0, header.find(';')));
  if (!header.ends_with(";base64")) document.fail(pointer, "a data URI in base64");
  if (data.size() / 4 * 3 > maxBytes) {
    throw LimitError(fmt::format("{}: {}: a data URI of {} characters, the limit is {} bytes", document.file, pointer,
                                 data.size(), maxBytes));
  }
  std::optional<Bytes> bytes = decodeBase64(data);
  if (!bytes) document.fail(pointer, "valid base64 in the data URI");
  result.bytes = std::move(*bytes);
  return result;
}

void refuseUnsafe(const Document& document, const fs::path& relative, const std::string& uri,
                  const std::string& pointer) {
  if (relative.is_absolute()) {
    document.fail(pointer, fmt::format("a path relative to the asset, found \"{}\"", shown(uri)));
  }
  if (std::any_of(relative.begin(), relative.end(), [](const fs::path& part) { return part == ".."; })) {
    document.fail(pointer, fmt::format("a path inside the asset's folder, found \"{}\"", shown(uri)));
  }
}

/// Symbolic links are followed first, so that what counts is the file in the end.
void refuseOutside(const Document& document, const fs::path& path, const std::string& uri, const std::string& pointer) {
  std::error_code code;
  const fs::path folder = fs::canonical(document.folder, code);
  const fs::path target = fs::weakly_canonical(path, code);
  const auto [folderEnd, unused] = std::mismatch(folder.begin(), folder.end(), target.begin(), target.end());
  if (code || folderEnd != folder.end()) {
    document.fail(pointer, fmt::format("a file inside the asset's folder, \"{}\" leads out of it", shown(uri)));
  }
}

} // namespace

std::string percentDecode(std::string_view text) {
  std::string result;
  for (size_t i = 0; i < text.size(); ++i) {
    const bool isEscape = text[i] == '%' && i + 2 < text.size();
    const auto high = isEscape ? hexDigit(text[i + 1]) : std::nullopt;
    const auto low = isEscape ? hexDigit(text[i + 2]) : std::nullopt;
    if (high && low) {
      result += static_cast<char>(*high << 4 | *low);
      i += 2;
    } else {
      result += text[i];
    }
  }
  return result;
}

std::optional<Bytes> decodeBase64(std::string_view text) {
  constexpr std::string_view kAlphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::array<int8_t, 256> values{};
  values.fill(-1);
  for (size_t i = 0; i < kAlphabet.size(); ++i)
    values[static_cast<unsigned char>(kAlphabet[i])] = static_cast<int8_t>(i);

  for (int padding = 0; padding < 2 && text.ends_with('='); ++padding) text.remove_suffix(1);
  if (text.size() % 4 == 1) return std::nullopt;
  Bytes bytes;
  bytes.reserve(text.size() / 4 * 3 + 2);
  uint32_t bits = 0;
  uint32_t bitCount = 0;
  for (const char c : text) {
    const int8_t value = values[static_cast<unsigned char>(c)];
    if (value < 0) return std::nullopt;
    bits = (bits << 6 | static_cast<uint32_t>(value)) & 0xffffu;
    bitCount += 6;
    if (bitCount >= 8) {
      bitCount -= 8;
      bytes.push_back(static_cast<std::byte>(bits >> bitCount & 0xffu));
    }
  }
  return bytes;
}

LoadedUri loadUri(const Document& document, const std::string& uri, const std::string& pointer, uint64_t maxBytes,
                  std::optional<uint64_t> wantedBytes) {
  std::string reference = uri;
  if (const std::optional<std::string> found = scheme(uri)) {
    if (*found == "data") return loadDataUri(document, uri, pointer, maxBytes);
    if (*found != "file" || !document.options.allowExternal) {
      document.fail(pointer, fmt::format("a data URI or a relative path, found \"{}\"", shown(uri)));
    }
    reference.erase(0, uri.find(':') + 1);
    if (reference.starts_with("//")) reference.erase(0, 2); // an empty authority: this machine
  }
  const std::string name = percentDecode(reference);
  if (name.empty() || name.find('\0') != std::string::npos) document.fail(pointer, "a file name without NUL");
  const fs::path relative(name);
  const fs::path path = document.folder / relative; // of an absolute one, that alone
  if (!document.options.allowExternal) {
    refuseUnsafe(document, relative, uri, pointer);
    refuseOutside(document, path, uri, pointer);
  }
  return {readFileBytes(path, maxBytes, document.file, pointer, wantedBytes), {}};
}

} // namespace isophote::gltf
