// Every estimator and execution setting by name: what --set, the flags, `isophote settings` and the headers share.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "isophote/settings.hpp"

namespace isophote::cli {

struct Settings {
  EstimatorSettings estimator;
  ExecutionSettings execution;
};

struct SettingEntry {
  const char* key;
  const char* values; ///< what it takes
  const char* exact;  ///< the unbiased value; for execution settings the default, as none changes the image
  const char* fast;   ///< a cheaper one; equal to `exact` where nothing is traded
  const char* description;
  bool execution;                                         ///< never changes the image
  std::function<void(Settings&, const std::string&)> set; ///< @throws UsageError
  std::function<std::string(const Settings&)> get;
  std::vector<std::string> trials; ///< values that `isophote trade` compares
};

[[nodiscard]] const std::vector<SettingEntry>& settingTable();

/// @throws UsageError naming the keys there are
void setSetting(Settings& settings, const std::string& key, const std::string& value);
/// `key=value`
void setSetting(Settings& settings, const std::string& assignment);

/// {"sampler": "sobol", …}
[[nodiscard]] nlohmann::ordered_json settingsJson(const Settings& settings, bool execution);

/// The ledger: each biased setting that is on, with its value and what it leaves out; {} for an unbiased image.
[[nodiscard]] nlohmann::ordered_json biasJson(const Settings& settings);

} // namespace isophote::cli
