#include "scene/stb_decode.hpp"

#include <algorithm>
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
constexpr size_t kScratchBytes = 16u << 20; ///< headers, palettes and rounding up

/// Feeds stb_image and notices when it asks for bytes beyond the end, which it would take for zeros. In HDR's rows
/// zeros are runs without length, of which it would read for ever: there the bytes beyond the end are 255, a run too
/// long.
struct Source {
  std::span<const std::byte> bytes;
  bool endsInRuns = false;
  size_t position = 0;
  bool readPastEnd = false;

  static int read(void* user, char* data, int size) {
    Source& source = *static_cast<Source*>(user);
    const size_t count = std::min(static_cast<size_t>(size), source.bytes.size() - source.position);
    if (count == 0 && size > 0) {
      source.readPastEnd = true;
      if (!source.endsInRuns) return 0;
      std::memset(data, 0xff, static_cast<size_t>(size));
      return size;
    }
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

struct Size {
  int width = 0;
  int height = 0;
};

/// The ceiling that decoding so many pixels has to stay under.
size_t allocationLimitFor(uint64_t pixels) {
  constexpr size_t kMaxBytesPerPixel = 16; // four floats; four 16-bit channels inflated into a buffer doubled in size
  return kScratchBytes + static_cast<size_t>(pixels) * kMaxBytesPerPixel;
}

/// stb_image refuses sizes whose bytes do not fit an int with this reason.
bool isTooLargeForStb() { return std::string_view(stbi_failure_reason()) == "too large"; }

DecodeProblem readSize(std::span<const std::byte> bytes, uint64_t maxPixels, Size& size) {
  allocationLimit = kScratchBytes;
  Source source{bytes};
  int channels = 0;
  if (!stbi_info_from_callbacks(&kCallbacks, &source, &size.width, &size.height, &channels) || size.width <= 0 ||
      size.height <= 0) {
    return {.broken = fmt::format("its header cannot be read ({})", stbi_failure_reason()), .tooLarge = {}};
  }
  if (source.readPastEnd) return {.broken = "it is truncated", .tooLarge = {}};
  const auto width = static_cast<uint64_t>(size.width);
  const auto height = static_cast<uint64_t>(size.height);
  if (width * height > maxPixels) return tooManyPixels(width, height, maxPixels);
  return {};
}

/// stb_image calls a PNG above 2^30 bytes no image at all, so its header is read here (W3C PNG, section 11.2.1).
DecodeProblem checkPngSize(std::span<const std::byte> bytes, uint64_t maxPixels) {
  constexpr size_t kWidthOffset = 16;
  constexpr size_t kHeightOffset = 20;
  if (bytes.size() < kHeightOffset + 4) return {};
  const auto bigEndian = [&](size_t offset) {
    uint64_t value = 0;
    for (size_t i = 0; i < 4; ++i) value = value << 8 | std::to_integer<uint64_t>(bytes[offset + i]);
    return value;
  };
  const uint64_t width = bigEndian(kWidthOffset);
  const uint64_t height = bigEndian(kHeightOffset);
  if (width * height <= maxPixels) return {}; // below 2^64: both have 32 bits
  return tooManyPixels(width, height, maxPixels);
}

DecodeProblem pixelProblem(const Source& source, const void* pixels, const Size& size) {
  if (!pixels && isTooLargeForStb()) {
    return {.broken = {},
            .tooLarge = fmt::format("{} x {} pixels are more than can be decoded", size.width, size.height)};
  }
  if (!pixels) return {.broken = fmt::format("it cannot be decoded ({})", stbi_failure_reason()), .tooLarge = {}};
  return {.broken = source.readPastEnd ? "it is truncated" : "", .tooLarge = {}};
}

bool startsWith(std::span<const std::byte> bytes, std::string_view magic) {
  return bytes.size() >= magic.size() && std::memcmp(bytes.data(), magic.data(), magic.size()) == 0;
}

} // namespace

bool isRadianceHdr(std::span<const std::byte> bytes) {
  return startsWith(bytes, "#?RADIANCE\n") || startsWith(bytes, "#?RGBE\n");
}

DecodeProblem readPngHeader(std::span<const std::byte> bytes, uint64_t maxPixels, ImageData& image) {
  if (DecodeProblem problem = checkPngSize(bytes, maxPixels); problem.any()) return problem;
  Size size;
  if (DecodeProblem problem = readSize(bytes, maxPixels, size); problem.any()) return problem;
  Source source{bytes};
  image.width = static_cast<uint32_t>(size.width);
  image.height = static_cast<uint32_t>(size.height);
  image.bitsPerChannel = stbi_is_16_bit_from_callbacks(&kCallbacks, &source) ? 16 : 8;
  return {};
}

DecodeProblem decodePng(std::span<const std::byte> bytes, ImageData& image) {
  const size_t pixelCount = size_t{image.width} * image.height;
  allocationLimit = allocationLimitFor(pixelCount);
  Source source{bytes};
  Size size;
  int channels = 0;
  const Pixels<void> pixels(image.bitsPerChannel == 16
                                ? static_cast<void*>(stbi_load_16_from_callbacks(&kCallbacks, &source, &size.width,
                                                                                 &size.height, &channels, kChannels))
                                : static_cast<void*>(stbi_load_from_callbacks(&kCallbacks, &source, &size.width,
                                                                              &size.height, &channels, kChannels)));
  if (DecodeProblem problem = pixelProblem(source, pixels.get(), size); problem.any()) return problem;
  const auto* begin = static_cast<const std::byte*>(pixels.get());
  image.pixels.assign(begin, begin + pixelCount * kChannels * image.bitsPerChannel / 8);
  return {};
}

DecodeProblem decodeHdr(std::span<const std::byte> bytes, uint64_t maxPixels, HdrImage& image) {
  if (!isRadianceHdr(bytes)) return {.broken = "it is not a Radiance HDR file", .tooLarge = {}};
  Size size;
  if (DecodeProblem problem = readSize(bytes, maxPixels, size); problem.any()) return problem;
  image.width = static_cast<uint32_t>(size.width);
  image.height = static_cast<uint32_t>(size.height);
  const size_t count = size_t{image.width} * image.height;
  allocationLimit = allocationLimitFor(count);
  Source source{bytes, true};
  int channels = 0;
  const Pixels<float> pixels(stbi_loadf_from_callbacks(&kCallbacks, &source, &size.width, &size.height, &channels, 3));
  if (DecodeProblem problem = pixelProblem(source, pixels.get(), size); problem.any()) return problem;
  const float* values = pixels.get();
  image.pixels.resize(count);
  for (size_t i = 0; i < count; ++i) image.pixels[i] = {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
  return {};
}

} // namespace isophote
