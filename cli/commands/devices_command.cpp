#include <algorithm>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "commands/commands.hpp"
#include "exit_codes.hpp"
#include "isophote/device.hpp"

namespace isophote::cli {
namespace {

void printText(const std::vector<DeviceInfo>& devices) {
  if (devices.empty()) fmt::print("no Vulkan device; a software driver such as Mesa's lavapipe would do\n");
  for (const DeviceInfo& device : devices) {
    fmt::print("{}: {} ({})\n", device.index, device.name, device.kind);
    if (!device.driver.empty()) {
      fmt::print("   driver {}, {:.1f} GiB, subgroups of {}{}\n", device.driver,
                 static_cast<double>(device.memoryBytes) / (1ull << 30), device.subgroupSize,
                 device.rayQuery ? ", ray query" : "");
    }
    if (!device.rejection.empty()) fmt::print("   cannot be used, it lacks: {}\n", device.rejection);
  }
}

void printJson(const std::vector<DeviceInfo>& devices) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const DeviceInfo& device : devices) {
    list.push_back({{"index", device.index},
                    {"name", device.name},
                    {"kind", device.kind},
                    {"driver", device.driver},
                    {"memory_bytes", device.memoryBytes},
                    {"subgroup_size", device.subgroupSize},
                    {"ray_query", device.rayQuery},
                    {"usable", device.rejection.empty()},
                    {"rejection", device.rejection}});
  }
  fmt::print("{}\n", nlohmann::ordered_json{{"schema", 1}, {"devices", list}}.dump(2));
}

int runDevices(bool json) {
  const VulkanInstance instance;
  const std::vector<DeviceInfo> devices = instance.devices();
  json ? printJson(devices) : printText(devices);
  const bool usable =
      std::any_of(devices.begin(), devices.end(), [](const DeviceInfo& device) { return device.rejection.empty(); });
  return usable ? kDone : kNoDevice;
}

} // namespace

void addDevicesCommand(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("devices", "List the Vulkan devices, and why one cannot be used");
  const auto json = std::make_shared<bool>(false);
  command->add_flag("--json", *json, "Machine-readable");
  command->footer("Examples:\n  isophote devices\n  isophote render scene.glb -o a.exr --device 1\n"
                  "  isophote render scene.glb -o a.exr --device cpu\n\nExit code 6 when no device can be used.");
  command->callback([json, &action] { action = [json] { return runDevices(*json); }; });
}

} // namespace isophote::cli
