#include "parse.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include "isophote/error.hpp"

namespace isophote::cli {
namespace {

std::vector<std::string> split(const std::string& text, char separator, size_t count, const char* expected) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == separator) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  if (parts.size() != count) throw UsageError(fmt::format("'{}' is not of the form {}", text, expected));
  return parts;
}

} // namespace

uint64_t parseUnsigned(const std::string& text, uint64_t smallest, uint64_t largest) {
  uint64_t value = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end || value < smallest || value > largest) {
    throw UsageError(fmt::format("'{}' is not a whole number from {} to {}", text, smallest, largest));
  }
  return value;
}

double parseNumber(const std::string& text, double smallest, double largest) {
  double value = 0;
  const char* begin = text.data();
  const char* const end = begin + text.size();
  if (text.size() > 1 && text[0] == '+') ++begin; // from_chars knows no plus sign
  const auto [stop, error] = std::from_chars(begin, end, value);
  if (error != std::errc() || stop != end || !std::isfinite(value)) {
    throw UsageError(fmt::format("'{}' is not a number", text));
  }
  if (value < smallest || value > largest) {
    throw UsageError(fmt::format("{} is not within {} to {}", text, smallest, largest));
  }
  return value;
}

double parseShare(const std::string& text) {
  constexpr double kLargest = 1e6;
  const bool percent = !text.empty() && text.back() == '%';
  const double number = parseNumber(percent ? text.substr(0, text.size() - 1) : text, 0, kLargest);
  if (number == 0) throw UsageError("an error of 0 cannot be reached");
  return percent ? number / 100 : number;
}

SampleRange parseSampleRange(const std::string& text) {
  constexpr uint64_t kLargest = std::numeric_limits<uint32_t>::max();
  const auto parts = split(text, ':', 2, "A:B");
  SampleRange range;
  range.first = static_cast<uint32_t>(parseUnsigned(parts[0], 0, kLargest - 1));
  range.last = static_cast<uint32_t>(parseUnsigned(parts[1], uint64_t(range.first) + 1, kLargest));
  return range;
}

PixelRect parseCrop(const std::string& text) {
  const auto parts = split(text, ',', 4, "X0,Y0,X1,Y1");
  const auto side = [&](size_t i) { return static_cast<uint32_t>(parseUnsigned(parts[i], 0, 65535)); };
  const PixelRect crop{side(0), side(1), side(2), side(3)};
  if (crop.x0 >= crop.x1 || crop.y0 >= crop.y1) throw UsageError(fmt::format("'{}' holds no pixels", text));
  return crop;
}

glm::vec3 parseColor(const std::string& text) {
  const auto parts = split(text, ',', 3, "R,G,B");
  glm::vec3 color;
  for (int c = 0; c < 3; ++c) color[c] = static_cast<float>(parseNumber(parts[static_cast<size_t>(c)], 0, 1e30));
  return color;
}

SkyOptions parseSky(const std::string& text) {
  const auto count = 1 + static_cast<size_t>(std::count(text.begin(), text.end(), ','));
  const auto parts = split(text, ',', std::min<size_t>(count, 3), "ELEVATION[,AZIMUTH[,TURBIDITY]]");
  SkyOptions sky;
  sky.elevationDegrees = parseNumber(parts[0], 0, 90);
  if (parts.size() > 1) sky.azimuthDegrees = parseNumber(parts[1], -360, 360);
  if (parts.size() > 2) sky.turbidity = parseNumber(parts[2], 2, 10);
  return sky;
}

CLI::Option* addValue(CLI::App& command, const std::string& names, const std::string& type,
                      const std::function<void(const std::string&)>& set, const std::string& description) {
  const std::string flag = names.substr(0, names.find(','));
  const auto setNamed = [set, flag](const std::string& text) {
    try {
      set(text);
    } catch (const UsageError& error) {
      throw UsageError(flag + ": " + error.what());
    }
  };
  return command.add_option_function<std::string>(names, setNamed, description)->type_name(type);
}

} // namespace isophote::cli
