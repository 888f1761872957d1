// A study as JSON and CSV.
#pragma once

#include <cstdint>
#include <string>

#include <nlohmann/json.hpp>

#include "trade/study.hpp"

namespace isophote::cli {

/// What the measurements were made of and on.
struct StudyContext {
  std::string scene;
  std::string sceneFlags; ///< of `isophote render`: environment, camera, variant; with a leading space, or empty
  std::string device;
  std::string driver;
  uint32_t width = 0;
  uint32_t height = 0;
  double budgetSeconds = 0;
};

/// Schema 1.
[[nodiscard]] nlohmann::ordered_json studyJson(const Study& study, const StudyContext& context);
/// A line for each configuration.
[[nodiscard]] std::string studyCsv(const Study& study);
/// The command that renders as recommended.
[[nodiscard]] std::string commandLine(const Study& study, const Recommendation& recommendation,
                                      const StudyContext& context);
/// `text` as one word of a shell.
[[nodiscard]] std::string shellWord(const std::string& text);

/// RMS from a mean square that may have been estimated below zero.
[[nodiscard]] double rootOf(double square);
[[nodiscard]] const char* stateName(const Measurement& measurement);

} // namespace isophote::cli
