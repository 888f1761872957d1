#include "rendering/receipt.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "isophote/error.hpp"
#include "parse.hpp"
#include "rendering/backend.hpp"

namespace isophote::cli {
namespace {

using Json = nlohmann::json;

/// nlohmann's own conversion takes fractions and numbers of any size: undefined.
uint32_t wholeNumber(const Json& json) {
  const auto& value = json.get_ref<const Json::number_unsigned_t&>();
  if (value > std::numeric_limits<uint32_t>::max())
    throw UsageError(fmt::format("isophote.settings: {} is too large a number", value));
  return static_cast<uint32_t>(value);
}

/// What requestJson of render_report.cpp puts beside the settings.
void readRequest(const Json& request, Receipt& receipt) {
  for (const auto& [key, value] : request.items()) {
    if (value.is_string() && key != "camera" && key != "variant" && key != "backend")
      setSetting(receipt.settings, key, value.get<std::string>());
  }
  const Json& image = request.at("image");
  receipt.width = wholeNumber(image.at("width"));
  receipt.height = wholeNumber(image.at("height"));
  const Json& crop = image.at("crop");
  receipt.crop = {wholeNumber(crop.at(0)), wholeNumber(crop.at(1)), wholeNumber(crop.at(2)), wholeNumber(crop.at(3))};
  if (request.contains("camera_index")) receipt.camera.index = wholeNumber(request.at("camera_index"));
  receipt.camera.panorama = request.contains("panorama");
  if (request.contains("lens")) {
    const Json& lens = request.at("lens");
    receipt.camera.lensRadius = lens.at("radius");
    receipt.camera.focusDistance = lens.at("focus_distance");
    receipt.camera.apertureBlades = wholeNumber(lens.at("aperture_blades"));
  }
  if (request.contains("backend")) receipt.backend = backendFromName(request.at("backend").get<std::string>());
  if (request.contains("variant")) receipt.variant = request.at("variant").get<std::string>();
}

EnvironmentOptions readEnvironment(const Json& json) {
  EnvironmentOptions options;
  options.file = json.value("file", std::string());
  if (json.contains("color")) {
    const Json& color = json.at("color");
    options.color = glm::vec3(color.at(0).get<float>(), color.at(1).get<float>(), color.at(2).get<float>());
  }
  if (json.contains("intensity")) options.intensity = json.at("intensity");
  if (json.contains("rotation_degrees")) options.rotationDegrees = json.at("rotation_degrees");
  if (json.contains("sky")) {
    const Json& sky = json.at("sky");
    options.sky = SkyOptions{.elevationDegrees = sky.at("elevation_degrees"),
                             .azimuthDegrees = sky.at("azimuth_degrees"),
                             .turbidity = sky.at("turbidity")};
  }
  return options;
}

void checkSize(const Receipt& receipt, const Image& image) {
  const PixelRect& crop = receipt.crop;
  if (crop.x0 < crop.x1 && crop.y0 < crop.y1 && crop.x1 <= receipt.width && crop.y1 <= receipt.height &&
      crop.x1 - crop.x0 == image.width && crop.y1 - crop.y0 == image.height)
    return;
  throw UsageError("the image has another size than its receipt");
}

} // namespace

const std::string& attribute(const std::string& file, const Image& image, const std::string& name) {
  const auto found = image.attributes.find(name);
  if (found == image.attributes.end()) throw UsageError(file + ": no " + name + ": not an image of Isophote");
  return found->second;
}

std::vector<SampleRange> sampleRanges(const std::string& text) {
  std::vector<SampleRange> ranges;
  for (size_t start = 0; start <= text.size();) {
    const size_t end = std::min(text.find(',', start), text.size());
    ranges.push_back(parseSampleRange(text.substr(start, end - start)));
    start = end + 1;
  }
  return ranges;
}

Receipt readReceipt(const std::string& file, const Image& image) {
  Receipt receipt{.version = attribute(file, image, "isophote.version"),
                  .device = attribute(file, image, "isophote.device"),
                  .scene = attribute(file, image, "isophote.scene"),
                  .sceneHash = attribute(file, image, "isophote.sceneHash")};
  const std::string& settings = attribute(file, image, "isophote.settings");
  const std::string& samples = attribute(file, image, "isophote.sampleRange");
  try {
    receipt.samples = sampleRanges(samples);
    const Json request = Json::parse(settings);
    if (request.value("adaptive", false))
      throw UsageError("its samples were shared out by --adaptive, which cannot be repeated tile by tile");
    readRequest(request, receipt);
    receipt.environment = readEnvironment(request.at("environment"));
    checkSize(receipt, image);
  } catch (const Json::exception& error) {
    throw UsageError(fmt::format("{}: isophote.settings: {}", file, error.what()));
  } catch (const UsageError& error) {
    throw UsageError(file + ": " + error.what());
  }
  return receipt;
}

} // namespace isophote::cli
