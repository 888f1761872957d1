// A study as one HTML file that needs nothing beside it.
#pragma once

#include <string>

#include "trade/study_files.hpp"

namespace isophote::cli {

[[nodiscard]] std::string studyPage(const Study& study, const StudyContext& context);

} // namespace isophote::cli
