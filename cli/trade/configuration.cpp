#include "trade/configuration.hpp"

#include <algorithm>
#include <sstream>

#include "isophote/error.hpp"

namespace isophote::cli {
namespace {

const SettingEntry& findEntry(const std::string& key) {
  for (const SettingEntry& entry : settingTable()) {
    if (key == entry.key) return entry;
  }
  Settings unused;
  setSetting(unused, key, ""); // says which there are
  throw UsageError("no setting '" + key + "'");
}

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, ',');) parts.push_back(part);
  return parts;
}

/// As the setting itself writes the value.
std::string canonical(const SettingEntry& entry, const std::string& value) {
  Settings settings;
  setSetting(settings, std::string(entry.key) + "=" + value);
  return entry.get(settings);
}

void addChanges(const SettingEntry& entry, const std::vector<std::string>& values, std::vector<Configuration>& list) {
  for (const std::string& value : values) {
    const Configuration configuration{{{entry.key, canonical(entry, value)}}};
    if (configuration.changes.front().value == entry.get(Settings{})) continue;
    if (std::find(list.begin(), list.end(), configuration) == list.end()) list.push_back(configuration);
  }
}

size_t tableIndex(const std::string& key) { return static_cast<size_t>(&findEntry(key) - settingTable().data()); }

} // namespace

std::string Configuration::name() const {
  std::string text;
  for (const Change& change : changes) text += (text.empty() ? "" : " ") + change.key + "=" + change.value;
  return text.empty() ? "exact" : text;
}

Settings Configuration::settings() const {
  Settings settings;
  for (const Change& change : changes) setSetting(settings, change.key, change.value);
  return settings;
}

bool Configuration::declaredUnbiased() const { return biasJson(settings()).empty(); }

bool Configuration::executionOnly() const {
  return std::all_of(changes.begin(), changes.end(),
                     [](const Change& change) { return findEntry(change.key).kind == SettingKind::Execution; });
}

bool Configuration::denoised() const { return settings().layers.denoiser != Denoiser::None; }

Configuration Configuration::combinedWith(const Configuration& other) const {
  Configuration both = *this;
  for (const Change& change : other.changes) {
    const auto same = std::find_if(both.changes.begin(), both.changes.end(),
                                   [&](const Change& own) { return own.key == change.key; });
    if (same == both.changes.end()) {
      both.changes.push_back(change);
    } else if (same->value != change.value) {
      return {};
    }
  }
  if (both.changes.size() == std::max(changes.size(), other.changes.size())) return {};
  std::sort(both.changes.begin(), both.changes.end(),
            [](const Change& a, const Change& b) { return tableIndex(a.key) < tableIndex(b.key); });
  return both;
}

std::vector<Configuration> singleChanges(const std::vector<std::string>& asked) {
  std::vector<Configuration> list;
  if (asked.empty()) {
    for (const SettingEntry& entry : settingTable()) {
      if (entry.kind != SettingKind::Execution) addChanges(entry, entry.trials, list);
    }
  }
  for (const std::string& text : asked) {
    const size_t equals = text.find('=');
    const SettingEntry& entry = findEntry(text.substr(0, equals));
    addChanges(entry, equals == std::string::npos ? entry.trials : split(text.substr(equals + 1)), list);
  }
  return list;
}

} // namespace isophote::cli
