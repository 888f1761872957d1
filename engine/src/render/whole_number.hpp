// Whole numbers in JSON that strangers may have written.
#pragma once

#include <limits>
#include <stdexcept>
#include <string>

#include <nlohmann/json.hpp>

namespace isophote {

/// A number of JSON that T holds. nlohmann's own conversion takes fractions and numbers of any size: undefined.
/// @throws nlohmann::json::exception for what is no whole number >= 0; std::out_of_range for one that T cannot hold
template <class T, class Json> [[nodiscard]] T wholeNumber(const Json& json) {
  const auto& value = json.template get_ref<const typename Json::number_unsigned_t&>();
  if (value > std::numeric_limits<T>::max()) throw std::out_of_range(std::to_string(value) + " is too large a number");
  return static_cast<T>(value);
}

} // namespace isophote
