#include "scene/stb_decode.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string_view>

#include <fmt/format.h>

namespace {

/// stb_image limits each axis only, and a few bytes of zlib data inflate to gigabytes. So its allocations go through
/// a ceiling that follows from the announced size; beyond it stb reports that it is out of memory.
thread_local size_t allocationLimit = 0;

void* limitedMalloc(size_t bytes) { return bytes <= allocationLimit ? std::malloc(bytes) : nullptr; }
void* limitedRealloc(void* block, size_t bytes) {
  return bytes <= allocationLimit ? std::realloc(block, bytes) : nullptr;
}

} // namespace

#define STBI_MALLOC(bytes) limitedMalloc(bytes)
#define STBI_REALLOC(block, bytes) limitedRealloc(block, bytes)
#define STBI_FREE(block) std::free(block)
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_ONLY_HDR
#define STBI_NO_STDIO
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb_image.h>
#pragma GCC diagnostic pop

namespace isophote {
namespace {

static_assert(std::endian::native == std::endian::little, "16-bit channels are kept as stb_image returns them");

constexpr int kChannels = 4;
constexpr size_t kScratchBytes = 16u << 20; ///< headers, palettes, Huffman tables and rounding up to whole blocks

/// Feeds stb_image and notices when it asks for bytes beyond the end, which it would take for zeros.
struct Source {
  std::span<const std::byte> bytes;
  size_t position = 0;
  bool readPastEnd = false;

  static int read(void* user, char* data, int size) {
    Source& source = *static_cast<Source*>(user);
    const size_t count = std::min(static_cast<size_t>(size), source.bytes.size() - source.position);
    if (count == 0 && size > 0) source.readPastEnd = true;
    std::memcpy(data, source.bytes.data() + source.position, count);
    source.position += count;
    return static_cast<int>(count);
  }

  static void skip(void* user, int count) {
    Source& source = *static_cast<Source*>(user);
    if (count > 0 && static_cast<size_t>(count) > source.bytes.size() - source.position) source.readPastEnd = true;
    const auto target = static_cast<int64_t>(source.position) + count;
    source.position = static_cast<size_t>(std::clamp<int64_t>(target, 0, static_cast<int64_t>(source.bytes.size())));
  }

  static int atEnd(void* user) {
    const Source& source = *static_cast<Source*>(user);
    return source.position >= source.bytes.size() ? 1 : 0;
  }
};

constexpr stbi_io_callbacks kCallbacks{&Source::read, &Source::skip, &Source::atEnd};

struct FreePixels {
  void operator()(void* pixels) const { stbi_image_free(pixels); }
};
template <class T> using Pixels = std::unique_ptr<T, FreePixels>;

struct Header {
  int width = 0;
  int height = 0;
  DecodeProblem problem;
};

/// Reads the size and sets the ceiling for what decoding may allocate.
Header readHeader(std::span<const std::byte> bytes, uint64_t maxPixels) {
  allocationLimit = kScratchBytes;
  Header header;
  Source source{bytes};
  int channels = 0;
  if (!stbi_info_from_callbacks(&kCallbacks, &source, &header.width, &header.height, &channels) || header.width <= 0 ||
      header.height <= 0) {
    header.problem.broken = fmt::format("its header cannot be read ({})", stbi_failure_reason());
    return header;
  }
  const uint64_t pixels = static_cast<uint64_t>(header.width) * static_cast<uint64_t>(header.height);
  if (pixels > maxPixels) {
    header.problem.tooLarge =
        fmt::format("{} x {} pixels, the limit is {} pixels", header.width, header.height, maxPixels);
    return header;
  }
  constexpr size_t kMaxBytesPerPixel = 16; // four floats; four 16-bit channels inflated into a buffer doubled in size
  allocationLimit = kScratchBytes + static_cast<size_t>(pixels) * kMaxBytesPerPixel;
  return header;
}

std::string brokenReason(const Source& source, const void* pixels) {
  if (!pixels) return fmt::format("it cannot be decoded ({})", stbi_failure_reason());
  return source.readPastEnd ? "it is truncated" : "";
}

bool startsWith(std::span<const std::byte> bytes, std::string_view magic) {
  return bytes.size() >= magic.size() && std::memcmp(bytes.data(), magic.data(), magic.size()) == 0;
}

} // namespace

std::optional<ImageFormat> imageFormat(std::span<const std::byte> bytes) {
  if (startsWith(bytes, "\x89PNG\r\n\x1a\n")) return ImageFormat::Png;
  if (startsWith(bytes, "\xff\xd8\xff")) return ImageFormat::Jpeg;
  return std::nullopt;
}

bool isRadianceHdr(std::span<const std::byte> bytes) {
  return startsWith(bytes, "#?RADIANCE\n") || startsWith(bytes, "#?RGBE\n");
}

DecodeProblem decodeImage(std::span<const std::byte> bytes, uint64_t maxPixels, ImageData& image) {
  if (!imageFormat(bytes)) return {.broken = "it is neither PNG nor JPEG", .tooLarge = {}};
  Header header = readHeader(bytes, maxPixels);
  if (header.problem.any()) return header.problem;
  Source depthSource{bytes};
  const bool is16Bit = stbi_is_16_bit_from_callbacks(&kCallbacks, &depthSource) != 0;
  Source source{bytes};
  int channels = 0;
  const Pixels<void> pixels(
      is16Bit ? static_cast<void*>(stbi_load_16_from_callbacks(&kCallbacks, &source, &header.width, &header.height,
                                                               &channels, kChannels))
              : static_cast<void*>(stbi_load_from_callbacks(&kCallbacks, &source, &header.width, &header.height,
                                                            &channels, kChannels)));
  DecodeProblem problem{.broken = brokenReason(source, pixels.get()), .tooLarge = {}};
  if (problem.any()) return problem;
  image.width = static_cast<uint32_t>(header.width);
  image.height = static_cast<uint32_t>(header.height);
  image.bitsPerChannel = is16Bit ? 16 : 8;
  const size_t size = size_t{image.width} * image.height * kChannels * image.bitsPerChannel / 8;
  const auto* begin = static_cast<const std::byte*>(pixels.get());
  image.pixels.assign(begin, begin + size);
  return {};
}

DecodeProblem decodeHdr(std::span<const std::byte> bytes, uint64_t maxPixels, HdrImage& image) {
  if (!isRadianceHdr(bytes)) return {.broken = "it is not a Radiance HDR file", .tooLarge = {}};
  Header header = readHeader(bytes, maxPixels);
  if (header.problem.any()) return header.problem;
  Source source{bytes};
  int channels = 0;
  const Pixels<float> pixels(
      stbi_loadf_from_callbacks(&kCallbacks, &source, &header.width, &header.height, &channels, 3));
  DecodeProblem problem{.broken = brokenReason(source, pixels.get()), .tooLarge = {}};
  if (problem.any()) return problem;
  image.width = static_cast<uint32_t>(header.width);
  image.height = static_cast<uint32_t>(header.height);
  const size_t count = size_t{image.width} * image.height;
  image.pixels.resize(count);
  for (size_t i = 0; i < count; ++i) image.pixels[i] = {pixels.get()[3 * i], pixels.get()[3 * i + 1], pixels.get()[3 * i + 2]};
  return {};
}

} // namespace isophote
