#include "io/exr_attributes.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>

namespace isophote::io {
namespace {

static_assert(std::endian::native == std::endian::little); // as the format is

/// Types whose values have one size, in bytes.
/// Source: "OpenEXR File Layout", section "Predefined Attribute Types".
struct FixedType {
  std::string_view name;
  uint64_t bytes;
};
constexpr std::array kFixedTypes{FixedType{"box2i", 16},      FixedType{"box2f", 16},   FixedType{"chromaticities", 32},
                                 FixedType{"compression", 1}, FixedType{"double", 8},   FixedType{"envmap", 1},
                                 FixedType{"float", 4},       FixedType{"int", 4},      FixedType{"keycode", 28},
                                 FixedType{"lineOrder", 1},   FixedType{"m33f", 36},    FixedType{"m33d", 72},
                                 FixedType{"m44f", 64},       FixedType{"m44d", 128},   FixedType{"rational", 8},
                                 FixedType{"tiledesc", 9},    FixedType{"timecode", 8}, FixedType{"v2i", 8},
                                 FixedType{"v2f", 8},         FixedType{"v2d", 16},     FixedType{"v3i", 12},
                                 FixedType{"v3f", 12},        FixedType{"v3d", 24},     FixedType{"deepImageState", 1}};

class AttributeWalk {
public:
  explicit AttributeWalk(const std::filesystem::path& file)
      : stream_(file, std::ios::binary), fileBytes_(std::filesystem::file_size(file)) {
    constexpr std::streamoff kAttributesBegin = 8; // behind magic and version
    stream_.seekg(kAttributesBegin);
  }

  /// Returns whether the header had any attribute.
  bool header() {
    bool any = false;
    for (std::string name = text(); !name.empty(); name = text()) {
      any = true;
      const std::string type = text();
      const uint64_t size = number();
      if (size > fileBytes_ - position()) throw std::runtime_error("an attribute that is longer than the file");
      const uint64_t end = position() + size;
      if (!isValue(type, size, end)) throw std::runtime_error("attribute " + name + " has not the size of its value");
      stream_.seekg(static_cast<std::streamoff>(end));
    }
    return any;
  }

private:
  /// Whether a value of that type takes all bytes up to `end`. Of unknown types OpenEXR reads what the size says.
  bool isValue(const std::string& type, uint64_t size, uint64_t end) {
    for (const FixedType& fixed : kFixedTypes) {
      if (type == fixed.name) return size == fixed.bytes;
    }
    if (type == "floatvector") return size % sizeof(float) == 0;
    if (type == "preview") return isPreview(size);
    if (type == "chlist") return isChannelList(end);
    if (type == "stringvector") return isStringVector(end);
    return true;
  }

  bool isPreview(uint64_t size) {
    constexpr uint64_t kHead = 8, kPixel = 4;
    if (size < kHead) return false;
    const uint64_t width = number();
    const uint64_t height = number();
    return size == kHead + kPixel * width * height; // both below 2^31
  }

  bool isChannelList(uint64_t end) {
    constexpr uint64_t kChannel = 16; // behind its name
    while (position() < end) {
      if (text().empty()) return position() == end;
      skip(kChannel);
    }
    return false;
  }

  bool isStringVector(uint64_t end) {
    while (position() < end) skip(number());
    return position() == end;
  }

  [[nodiscard]] uint64_t position() { return static_cast<uint64_t>(static_cast<std::streamoff>(stream_.tellg())); }

  void skip(uint64_t bytes) {
    if (bytes > fileBytes_ - position()) throw std::runtime_error("the file ends early");
    stream_.seekg(static_cast<std::streamoff>(bytes), std::ios::cur);
  }

  uint64_t number() {
    std::array<char, sizeof(int32_t)> bytes{};
    if (!stream_.read(bytes.data(), bytes.size())) throw std::runtime_error("the file ends early");
    const auto value = std::bit_cast<int32_t>(bytes);
    if (value < 0) throw std::runtime_error("an attribute that is longer than the file");
    return static_cast<uint64_t>(value);
  }

  /// Ended by a zero.
  std::string text() {
    constexpr size_t kLongest = 255;
    std::string text;
    for (char c = 0; text.size() <= kLongest; text += c) {
      if (!stream_.get(c)) throw std::runtime_error("the file ends early");
      if (c == 0) return text;
    }
    throw std::runtime_error("an attribute whose name has no end");
  }

  std::ifstream stream_;
  uint64_t fileBytes_;
};

} // namespace

void checkExrAttributes(const std::filesystem::path& file, bool parts) {
  AttributeWalk walk(file);
  while (walk.header() && parts) {
  }
}

} // namespace isophote::io
