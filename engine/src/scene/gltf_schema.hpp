// The shape of a glTF 2.0 tree: types, array lengths, ranges and every index.
#pragma once

#include <string>

#include "scene/gltf_json.hpp"

namespace isophote::gltf {

/// Checks every property that the loader reads, so that code after it may take types and indices for granted.
///
/// Ranges are those whose violation leaves no sensible reading; values that can be clamped are left to the converters.
/// @throws SceneError with the pointer of the first offender
void checkSchema(const std::string& file, const Json& root);

/// No array is longer, so indices fit in 31 bits.
inline constexpr size_t kMaxArrayItems = 0x7fffffff;

} // namespace isophote::gltf
