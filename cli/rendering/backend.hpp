// --backend: who finds what rays meet.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "isophote/settings.hpp"

namespace isophote::cli {

/// "compute" or "ray-query".
[[nodiscard]] const char* backendName(Backend backend);
/// @throws UsageError
[[nodiscard]] Backend backendFromName(const std::string& name);

void addBackendFlag(CLI::App& command, Backend& backend);

} // namespace isophote::cli
