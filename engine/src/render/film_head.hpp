// What gives a film's integers their meaning, as JSON.
#pragma once

#include <nlohmann/json.hpp>

#include "isophote/film.hpp"

namespace isophote {

/// All of `sums` but its bytes. Doubles are given by their bits.
[[nodiscard]] nlohmann::ordered_json filmHead(const FilmSums& sums);

/// The same read. @throws nlohmann::json::exception, std::out_of_range
[[nodiscard]] FilmSums filmFromHead(const nlohmann::ordered_json& head);

} // namespace isophote
