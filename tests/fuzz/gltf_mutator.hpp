// Damage to a glTF file that keeps it a glTF file: the JSON stays JSON, the lengths of a GLB stay right.
#pragma once

#include <random>
#include <string>

namespace isophote::fuzz {

/// One to four changes of values, members, references, names or data.
/// @param bytes  a .glb or .gltf; anything else comes back as it is
[[nodiscard]] std::string mutateGltf(const std::string& bytes, std::mt19937& random);

} // namespace isophote::fuzz
