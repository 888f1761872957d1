#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <stb_image_write.h>

#include "isophote/error.hpp"
#include "isophote/image.hpp"

namespace isophote {
namespace {

uint8_t toByte(float value) { return static_cast<uint8_t>(std::lround(std::clamp(value, 0.0f, 1.0f) * 255.0f)); }

float finiteOrZero(float value) { return std::isfinite(value) ? value : 0.0f; }

const std::vector<float>& plane(const Image& image, const char* name) {
  const Channel* channel = image.find(name);
  if (channel == nullptr) throw UsageError(std::string("no channel ") + name + " for a PNG");
  return channel->values;
}

} // namespace

std::string encodePng(const Image& image, float exposureEv, ToneMap operation, Transfer transfer) {
  const std::vector<float>& r = plane(image, "R");
  const std::vector<float>& g = plane(image, "G");
  const std::vector<float>& b = plane(image, "B");
  const Channel* alpha = image.find("A");
  const size_t components = alpha != nullptr ? 4 : 3;

  // stb counts in int. Its output buffer grows from 2 by doubling plus one, to 3 * 2^29 - 1 at most, and fixed Huffman
  // codes turn 8 bits into at most 9.
  constexpr uint64_t kMaxRawBytes = (3ull << 29) / 9 * 8;
  const uint64_t raw = (uint64_t(image.width) * components + 1) * image.height;
  if (raw > kMaxRawBytes) throw OutputError("too many pixels for a PNG; write .exr");

  const float exposure = std::exp2(exposureEv);
  const size_t pixels = size_t(image.width) * image.height;
  std::vector<uint8_t> bytes(pixels * components);
  for (size_t i = 0; i < pixels; ++i) {
    glm::vec3 color(r[i], g[i], b[i]);
    if (alpha != nullptr) {
      // EXR colour is associated (multiplied by alpha), PNG colour is not.
      const float coverage = std::clamp(finiteOrZero(alpha->values[i]), 0.0f, 1.0f);
      if (coverage > 0) color /= coverage;
      bytes[i * components + 3] = toByte(coverage);
    }
    const glm::vec3 display = toneMap(color * exposure, operation, transfer);
    for (int c = 0; c < 3; ++c) bytes[i * components + static_cast<size_t>(c)] = toByte(display[c]);
  }

  std::string encoded;
  const auto append = [](void* context, void* data, int size) {
    static_cast<std::string*>(context)->append(static_cast<const char*>(data), static_cast<size_t>(size));
  };
  const int width = static_cast<int>(image.width);
  const int stride = static_cast<int>(image.width * components);
  if (stbi_write_png_to_func(append, &encoded, width, static_cast<int>(image.height), static_cast<int>(components),
                             bytes.data(), stride) == 0) {
    throw OutputError("cannot encode as PNG");
  }
  return encoded;
}

void writePng(const std::filesystem::path& file, const Image& image, float exposureEv, ToneMap operation,
              Transfer transfer) {
  std::string encoded;
  try {
    encoded = encodePng(image, exposureEv, operation, transfer);
  } catch (const OutputError& error) {
    throw OutputError(file.string() + ": " + error.what());
  }
  writeFileAtomically(file, encoded);
}

} // namespace isophote
