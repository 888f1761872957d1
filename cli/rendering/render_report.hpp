// What a render says about itself: the stats file and the attributes of the EXR header.
#pragma once

#include <map>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "input/scene_source.hpp"
#include "isophote/device.hpp"
#include "isophote/path_tracer.hpp"
#include "rendering/bias_ledger.hpp"
#include "rendering/stop_rule.hpp"
#include "setting_table.hpp"

namespace isophote::cli {

/// Wall-clock seconds of each phase.
struct PhaseSeconds {
  double load = 0;
  double bvh = 0;
  double upload = 0;
  double compile = 0;
  double render = 0; ///< with looks at the error and checkpoints; of all sessions of a render that was resumed
  double device = 0; ///< of this session's: waiting for the device
  double denoise = 0;
  double write = 0;
};

struct RenderReport {
  std::string scene;
  std::string sceneHash;
  DeviceInfo device;
  View view;
  PixelRect crop;
  Settings settings;
  nlohmann::ordered_json environment; ///< as asked for on the command line
  std::optional<std::string> variant; ///< of materials, likewise
  FeatureSet features;
  SceneStatistics sceneStatistics;
  RenderStatistics statistics;
  StopRule rule;
  std::optional<AdaptivePlan> adaptive;
  RenderResult result;
  SampleRange samples;          ///< that were started for at least one pixel
  uint32_t samplesPerPixel = 0; ///< that every pixel has at least
  uint64_t filmBytes = 0;
  PhaseSeconds seconds;
  BiasAccount bias;
};

/// Schema 1.
[[nodiscard]] nlohmann::ordered_json statsJson(const RenderReport& report);

/// isophote.version, .scene, .sceneHash, .settings, .device, .features, .seed, .sampleRange, .error, .bias, .status
[[nodiscard]] std::map<std::string, std::string> imageAttributes(const RenderReport& report);

/// All that the bits of a pixel's samples depend on, and the first of them: JSON of one object.
[[nodiscard]] std::string sampleIdentity(const RenderReport& report, uint32_t firstSample);

/// The value of the attribute isophote.error.
[[nodiscard]] std::string errorText(const ErrorEstimate& error);

/// The counters by name.
[[nodiscard]] nlohmann::ordered_json statusJson(const StatusCounters& status);

} // namespace isophote::cli
