// loadEnvironment: Radiance HDR and OpenEXR to an Environment without bad pixels.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "isophote/error.hpp"
#include "isophote/gltf.hpp"
#include "isophote/image.hpp"
#include "scene/file_bytes.hpp"
#include "scene/stb_decode.hpp"
#include "scene/warning_log.hpp"

namespace isophote {
namespace {

constexpr uint64_t kMaxPixels = LoadOptions{}.maxImagePixels;
constexpr uint64_t kMaxFileBytes = kMaxPixels * 16; // four floats a pixel, stored plainly

bool isOpenExr(std::span<const std::byte> bytes) {
  constexpr std::array<unsigned char, 4> kMagic{0x76, 0x2f, 0x31, 0x01};
  return bytes.size() >= kMagic.size() && std::memcmp(bytes.data(), kMagic.data(), kMagic.size()) == 0;
}

Environment fromHdr(const std::string& file, std::span<const std::byte> bytes) {
  HdrImage image;
  const DecodeProblem problem = decodeHdr(bytes, kMaxPixels, image);
  if (!problem.tooLarge.empty()) throw LimitError(fmt::format("{}: {}", file, problem.tooLarge));
  if (!problem.broken.empty()) throw SceneError(file, "", "a Radiance HDR image, " + problem.broken);
  return {.width = image.width, .height = image.height, .pixels = std::move(image.pixels)};
}

/// R, G and B, or Y for all three.
Environment fromExr(const std::filesystem::path& file) {
  const Image image = readExr(file);
  const Channel* gray = image.find("Y");
  std::array<const Channel*, 3> channels{image.find("R"), image.find("G"), image.find("B")};
  for (const Channel*& channel : channels) {
    if (!channel) channel = gray;
    if (!channel) throw SceneError(file.string(), "", "an OpenEXR image with the channels R, G, B or Y");
  }
  const uint64_t count = uint64_t{image.width} * image.height;
  if (count > kMaxPixels) {
    throw LimitError(
        fmt::format("{}: {} x {} pixels, the limit is {}", file.string(), image.width, image.height, kMaxPixels));
  }
  Environment environment{.width = image.width, .height = image.height};
  environment.pixels.resize(count);
  for (size_t i = 0; i < count; ++i) {
    environment.pixels[i] = {channels[0]->values[i], channels[1]->values[i], channels[2]->values[i]};
  }
  return environment;
}

/// NaN and negative values become 0, infinite ones the largest finite value of the map.
void repair(Environment& environment, WarningLog& log) {
  float largest = 0;
  for (const glm::vec3& pixel : environment.pixels) {
    for (int c = 0; c < 3; ++c) {
      if (std::isfinite(pixel[c])) largest = std::max(largest, pixel[c]);
    }
  }
  uint64_t nanCount = 0;
  uint64_t negativeCount = 0;
  uint64_t infiniteCount = 0;
  for (glm::vec3& pixel : environment.pixels) {
    bool hasNan = false;
    bool hasNegative = false;
    bool hasInfinite = false;
    for (int c = 0; c < 3; ++c) {
      float& value = pixel[c];
      if (std::isnan(value)) {
        hasNan = true;
        value = 0;
      } else if (value < 0) {
        hasNegative = true;
        value = 0;
      } else if (std::isinf(value)) {
        hasInfinite = true;
        value = largest;
      }
    }
    nanCount += hasNan;
    negativeCount += hasNegative;
    infiniteCount += hasInfinite;
  }
  log.add(fmt::format("{} pixels with NaN are set to 0", nanCount), "", nanCount > 0);
  log.add(fmt::format("{} pixels with negative values are set to 0", negativeCount), "", negativeCount > 0);
  log.add(fmt::format("{} pixels with infinite values are set to the largest finite one, {}", infiniteCount, largest),
          "", infiniteCount > 0);
}

} // namespace

Environment loadEnvironment(const std::filesystem::path& file, std::vector<std::string>& warnings) {
  const Bytes bytes = readFileBytes(file, kMaxFileBytes, file.string(), "");
  Environment environment;
  if (isRadianceHdr(bytes)) {
    environment = fromHdr(file.string(), bytes);
  } else if (isOpenExr(bytes)) {
    environment = fromExr(file);
  } else {
    throw SceneError(file.string(), "", "a Radiance HDR or OpenEXR image");
  }
  WarningLog log;
  repair(environment, log);
  if (environment.width != 2 * environment.height && environment.pixels.size() > 1) {
    log.add(fmt::format("an equirectangular map is twice as wide as high, this one is {} x {}", environment.width,
                        environment.height));
  }
  for (const std::string& line : log.lines()) warnings.push_back(fmt::format("{}: {}", file.string(), line));
  return environment;
}

} // namespace isophote
