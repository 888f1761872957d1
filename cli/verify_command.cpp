#include "commands.hpp"
namespace isophote::cli {
void addVerifyCommand(CLI::App&, Action&) {}
} // namespace isophote::cli
