// The commands. Each adds its flags to the program and stores in `action` what to do when it is the one given.
#pragma once

#include <functional>

#include <CLI/CLI.hpp>

namespace isophote::cli {

using Action = std::function<int()>; ///< returns the exit code

void addRenderCommand(CLI::App& program, Action& action);
void addInfoCommand(CLI::App& program, Action& action);
void addDevicesCommand(CLI::App& program, Action& action);
void addCompareCommand(CLI::App& program, Action& action);
void addBenchCommand(CLI::App& program, Action& action);
void addCalibrateCommand(CLI::App& program, Action& action);
void addEnvelopeCommand(CLI::App& program, Action& action);
void addMergeCommand(CLI::App& program, Action& action);
void addSettingsCommand(CLI::App& program, Action& action);
void addTradeCommand(CLI::App& program, Action& action);
void addVerifyCommand(CLI::App& program, Action& action);

} // namespace isophote::cli
