#include "scene/jpeg_decode.hpp"

#include <memory>
#include <string>
#include <type_traits>

#include <fmt/format.h>
#include <turbojpeg.h>

namespace isophote {
namespace {

struct DestroyDecoder {
  void operator()(void* decoder) const { tjDestroy(decoder); }
};
using Decoder = std::unique_ptr<std::remove_pointer_t<tjhandle>, DestroyDecoder>;

Decoder makeDecoder() {
  Decoder decoder(tjInitDecompress());
  if (!decoder) throw std::bad_alloc();
  return decoder;
}

const unsigned char* data(std::span<const std::byte> bytes) {
  return reinterpret_cast<const unsigned char*>(bytes.data());
}

} // namespace

DecodeProblem readJpegHeader(std::span<const std::byte> bytes, uint64_t maxPixels, ImageData& image) {
  const Decoder decoder = makeDecoder();
  int width = 0, height = 0, subsampling = 0, colorspace = 0;
  if (tjDecompressHeader3(decoder.get(), data(bytes), bytes.size(), &width, &height, &subsampling, &colorspace) != 0) {
    return {.broken = fmt::format("its header cannot be read ({})", tjGetErrorStr2(decoder.get())), .tooLarge = {}};
  }
  if (colorspace == TJCS_CMYK || colorspace == TJCS_YCCK) return {.broken = "it has four inks", .tooLarge = {}};
  const uint64_t pixels = static_cast<uint64_t>(width) * static_cast<uint64_t>(height); // at most 2^16 a side
  if (pixels > maxPixels) return tooManyPixels(static_cast<uint64_t>(width), static_cast<uint64_t>(height), maxPixels);
  image.width = static_cast<uint32_t>(width);
  image.height = static_cast<uint32_t>(height);
  image.bitsPerChannel = 8;
  return {};
}

DecodeProblem decodeJpeg(std::span<const std::byte> bytes, ImageData& image) {
  constexpr size_t kChannels = 4;
  const Decoder decoder = makeDecoder();
  image.pixels.resize(kChannels * image.width * image.height);
  auto* pixels = reinterpret_cast<unsigned char*>(image.pixels.data());
  // A progressive file of a few bytes may announce so many scans that decoding takes hours.
  const int result = tjDecompress2(decoder.get(), data(bytes), bytes.size(), pixels, static_cast<int>(image.width), 0,
                                   static_cast<int>(image.height), TJPF_RGBA, TJFLAG_ACCURATEDCT | TJFLAG_LIMITSCANS);
  if (result == 0) return {};
  const std::string reason = tjGetErrorStr2(decoder.get());
  const bool complete = tjGetErrorCode(decoder.get()) == TJERR_WARNING && !reason.starts_with("Premature end");
  if (complete) return {};
  return {.broken = fmt::format("it cannot be decoded or is truncated ({})", reason), .tooLarge = {}};
}

} // namespace isophote
