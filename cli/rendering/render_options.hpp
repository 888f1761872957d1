// The flags of `isophote render`.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "input/scene_source.hpp"
#include "isophote/device.hpp"
#include "isophote/image.hpp"
#include "rendering/checkpoint_keeper.hpp"
#include "rendering/stop_rule.hpp"
#include "setting_table.hpp"

namespace isophote::cli {

struct RenderOptions {
  std::string scene;
  std::vector<std::string> outputs;
  std::string statsFile;
  std::optional<uint32_t> width;
  std::optional<uint32_t> height;
  CameraOptions camera;
  PixelRect crop;
  EnvironmentOptions environment;
  std::optional<std::string> variant;
  std::optional<uint32_t> samplesPerPixel;
  std::optional<SampleRange> sampleRange;
  std::optional<double> targetError;
  double confidence = 0.95;
  std::optional<double> seconds;
  bool adaptive = false; ///< more samples where the error is
  CheckpointOptions checkpoint;
  Settings settings;
  float exposureEv = 0;
  ToneMap toneMap = ToneMap::Neutral;
  Transfer transfer = Transfer::Srgb;
  std::string device;
  Backend backend = Backend::Compute;
  bool plan = false; ///< say what the render would take, and no more
  double pilotSeconds = 3;
  bool json = false; ///< of the plan
  bool unbiased = false;
  bool quiet = false;
  bool verbose = false;
  bool validation = false;

  /// 64 samples where nothing else says when to stop.
  [[nodiscard]] StopRule stopRule() const;
  [[nodiscard]] FilmOptions filmOptions(const View& view) const;
  [[nodiscard]] DeviceOptions deviceOptions() const;
};

void addRenderFlags(CLI::App& command, RenderOptions& options);

} // namespace isophote::cli
