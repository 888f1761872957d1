#include "console.hpp"

#include <cstdio>

#include <fmt/format.h>

namespace isophote::cli {
namespace {

std::string oneLine(const std::string& text) {
  std::string line;
  bool lineBreak = false;
  for (const char c : text) {
    if (c == '\n' || c == '\r') {
      lineBreak = true;
    } else if (!lineBreak) {
      line += c;
    } else if (c != ' ') {
      line += std::string("; ") + c;
      lineBreak = false;
    }
  }
  return line;
}

} // namespace

void printError(const std::string& text) { fmt::print(stderr, "isophote: {}\n", oneLine(text)); }

void printWarning(const std::string& text) { fmt::print(stderr, "isophote: warning: {}\n", oneLine(text)); }

} // namespace isophote::cli
