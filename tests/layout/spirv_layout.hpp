// Reads struct layouts out of SPIR-V.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace isophote::test {

struct MemberLayout {
  std::string name;
  uint32_t offset = 0;
};

struct StructLayout {
  std::vector<MemberLayout> members; ///< in order
  uint32_t arrayStride = 0;          ///< of an unsized array of it; 0 where the module has none
};

/// Every struct with member offsets, by its GLSL name; several of one name where it is used in several ways, such as in
/// an array and inside another struct. The module must keep its names, as glslang does by default.
[[nodiscard]] std::multimap<std::string, StructLayout> readStructLayouts(std::span<const uint32_t> spirv);

} // namespace isophote::test
