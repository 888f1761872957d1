// Text of flags to values. All throw UsageError saying what was expected.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include <CLI/CLI.hpp>
#include <glm/glm.hpp>

#include "isophote/settings.hpp"
#include "isophote/sky.hpp"

namespace isophote::cli {

/// Decimal digits only: no sign, no octal, no overflow.
[[nodiscard]] uint64_t parseUnsigned(const std::string& text, uint64_t smallest, uint64_t largest);
/// A finite number within [smallest, largest].
[[nodiscard]] double parseNumber(const std::string& text, double smallest, double largest);
/// `2%` or `0.02`; positive.
[[nodiscard]] double parseShare(const std::string& text);
/// `A:B` with A < B.
[[nodiscard]] SampleRange parseSampleRange(const std::string& text);
/// `X0,Y0,X1,Y1`.
[[nodiscard]] PixelRect parseCrop(const std::string& text);
/// `R,G,B`, each finite and not negative.
[[nodiscard]] glm::vec3 parseColor(const std::string& text);

/// `ELEVATION[,AZIMUTH[,TURBIDITY]]`, degrees.
[[nodiscard]] SkyOptions parseSky(const std::string& text);

/// Adds a flag with one value. What `set` throws is reported with the flag's name.
CLI::Option* addValue(CLI::App& command, const std::string& names, const std::string& type,
                      const std::function<void(const std::string&)>& set, const std::string& description);

} // namespace isophote::cli
