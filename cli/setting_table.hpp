// Every estimator and execution setting by name: what --set, the flags, `isophote settings` and the headers share.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "isophote/denoise.hpp"
#include "isophote/settings.hpp"

namespace isophote::cli {

/// What is made of the finished image, as layers beside it.
struct LayerSettings {
  Denoiser denoiser = Denoiser::None;
};

/// How the scene is put on the device.
struct SceneSettings {
  BvhBuild bvhBuild = BvhBuild::FastTrace;
};

struct Settings {
  EstimatorSettings estimator;
  ExecutionSettings execution;
  LayerSettings layers;
  SceneSettings scene;
};

enum class SettingKind {
  Estimator, ///< changes the samples
  Execution, ///< changes how the work is done, not the image
  Layer      ///< adds a layer, and changes no other
};

struct SettingEntry {
  const char* key;
  const char* values; ///< what it takes
  const char*
      exact;        ///< the unbiased value; for other kinds than the estimator's the default, as none changes the image
  const char* fast; ///< a cheaper one; equal to `exact` where nothing is traded
  const char* description;
  SettingKind kind;
  std::function<void(Settings&, const std::string&)> set; ///< @throws UsageError
  std::function<std::string(const Settings&)> get;
  std::vector<std::string> trials; ///< values that `isophote trade` compares
};

[[nodiscard]] const std::vector<SettingEntry>& settingTable();

/// @throws UsageError naming the keys there are
void setSetting(Settings& settings, const std::string& key, const std::string& value);
/// `key=value`
void setSetting(Settings& settings, const std::string& assignment);

/// Those of one kind: {"sampler": "sobol", …}
[[nodiscard]] nlohmann::ordered_json settingsJson(const Settings& settings, SettingKind kind);

/// The ledger: each biased setting that is on, with its value and what it leaves out; {} for an unbiased image.
[[nodiscard]] nlohmann::ordered_json biasJson(const Settings& settings);

} // namespace isophote::cli
