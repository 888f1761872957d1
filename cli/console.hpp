// Lines to stderr.
#pragma once

#include <string>

namespace isophote::cli {

/// `isophote: TEXT`, line breaks replaced: an error is one line.
void printError(const std::string& text);
void printWarning(const std::string& text);

} // namespace isophote::cli
