// Ctrl-C, SIGTERM and SIGHUP: the first asks for an end, the second ends the process.
#pragma once

namespace isophote::cli {

/// From here on the first signal is only noted.
void catchInterrupts();
[[nodiscard]] bool interrupted();

} // namespace isophote::cli
