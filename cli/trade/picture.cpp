#include "trade/picture.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>

#include "trade/plot.hpp"

namespace isophote::cli {
namespace {

std::string base64(const std::string& bytes) {
  constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    const size_t count = std::min<size_t>(3, bytes.size() - i);
    uint32_t word = 0;
    for (size_t j = 0; j < 3; ++j) word = word << 8 | (j < count ? static_cast<uint8_t>(bytes[i + j]) : 0u);
    for (size_t j = 0; j < 4; ++j) text += j <= count ? kDigits[word >> (18 - 6 * j) & 63] : '=';
  }
  return text;
}

std::string tag(const std::string& png, const std::string& description) {
  return fmt::format("<img alt=\"{0}\" title=\"{0}\" src=\"data:image/png;base64,{1}\">", escaped(description),
                     base64(png));
}

} // namespace

std::string pictureTag(const Image& image, float exposureEv, const std::string& description) {
  Image opaque{.width = image.width, .height = image.height};
  for (const char* name : {"R", "G", "B"}) opaque.channels.push_back(*image.find(name));
  return tag(encodePng(opaque, exposureEv, ToneMap::Neutral), description);
}

std::string differenceTag(const Image& difference, float full, const std::string& description) {
  Image colors = difference;
  for (size_t i = 0; i < colors.channels[0].values.size(); ++i) {
    float mean = 0;
    for (const Channel& channel : difference.channels) mean += channel.values[i] / 3;
    const float share = std::clamp(mean / full, -1.0f, 1.0f);
    const glm::vec3 strongest = share > 0 ? glm::vec3(0.75f, 0.1f, 0.1f) : glm::vec3(0.1f, 0.25f, 0.75f);
    const glm::vec3 color = glm::mix(glm::vec3(1), strongest, std::abs(share));
    for (int c = 0; c < 3; ++c) colors.channels[static_cast<size_t>(c)].values[i] = color[c];
  }
  return tag(encodePng(colors, 0, ToneMap::Linear), description); // these are display values
}

float middleExposure(const Image& image) {
  double luminance = 0;
  const std::vector<float>&r = image.find("R")->values, &g = image.find("G")->values, &b = image.find("B")->values;
  for (size_t i = 0; i < r.size(); ++i)
    luminance += 0.2126 * double(r[i]) + 0.7152 * double(g[i]) + 0.0722 * double(b[i]);
  luminance /= static_cast<double>(std::max<size_t>(r.size(), 1));
  return luminance > 0 ? static_cast<float>(std::log2(0.25 / luminance)) : 0.0f;
}

} // namespace isophote::cli
