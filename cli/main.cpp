// The isophote command.
#include <exception>

#include "commands/commands.hpp"
#include "console.hpp"
#include "exit_codes.hpp"
#include "isophote/version.hpp"

namespace {

constexpr const char* kExamples = R"(Start with:
  isophote render scene.glb -o image.exr -o image.png
  isophote info scene.glb             what is in it and what it costs
  isophote COMMAND --help             all flags, with examples

Exit codes: 0 done, 1 internal error, 2 usage, 3 invalid asset, 4 unsupported feature, 5 limit exceeded, 6 no device,
7 output failed, 8 budget ended before the target error, 130 interrupted with the work saved.)";

} // namespace

int main(int argc, char** argv) {
  using namespace isophote::cli;
  CLI::App program(
      "Isophote: a path tracer for glTF 2.0 on Vulkan compute. Every image carries its own measured error.",
      "isophote");
  program.set_version_flag("--version", isophote::kVersion);
  program.require_subcommand(1);
  program.footer(kExamples);
  Action action;
  try {
    addRenderCommand(program, action);
    addInfoCommand(program, action);
    addDevicesCommand(program, action);
    addCompareCommand(program, action);
    addMergeCommand(program, action);
    addVerifyCommand(program, action);
    addTradeCommand(program, action);
    addEnvelopeCommand(program, action);
    addCalibrateCommand(program, action);
    addBenchCommand(program, action);
    addSettingsCommand(program, action);
    program.parse(argc, argv);
    return action();
  } catch (const CLI::Success& request) { // --help, --version
    return program.exit(request);
  } catch (const CLI::ParseError& error) {
    printError(error.what());
    return kUsage;
  } catch (const std::exception& error) {
    printError(error.what());
    return exitCodeOf(error);
  }
}
