#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "commands/commands.hpp"
#include "exit_codes.hpp"
#include "setting_table.hpp"

namespace isophote::cli {
namespace {

void printText() {
  for (const SettingEntry& entry : settingTable()) {
    fmt::print("{:<17} {}\n{:<17} values: {}; exact: {}; fast: {}{}\n", entry.key, entry.description, "", entry.values,
               entry.exact, entry.fast, entry.kind == SettingKind::Estimator ? "" : "; never changes the image");
  }
}

void printJson() {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const SettingEntry& entry : settingTable()) {
    list.push_back({{"key", entry.key},
                    {"values", entry.values},
                    {"default", entry.get(Settings{})},
                    {"exact", entry.exact},
                    {"fast", entry.fast},
                    {"changes_image", entry.kind == SettingKind::Estimator},
                    {"description", entry.description}});
  }
  fmt::print("{}\n", nlohmann::ordered_json{{"schema", 1}, {"settings", list}}.dump(2));
}

} // namespace

void addSettingsCommand(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("settings", "List what `render --set key=value` takes");
  const auto json = std::make_shared<bool>(false);
  command->add_flag("--json", *json, "Machine-readable");
  command->footer("Examples:\n  isophote settings\n  isophote render scene.glb -o a.exr --set light-sampling=lights "
                  "--set max-depth=8");
  command->callback([json, &action] {
    action = [json] {
      *json ? printJson() : printText();
      return int{kDone};
    };
  });
}

} // namespace isophote::cli
