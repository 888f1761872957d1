#include "layout/spirv_layout.hpp"

namespace isophote::test {
namespace {

// SPIR-V 1.6, section 3: opcodes and decorations.
constexpr size_t kHeaderWords = 5;
constexpr uint32_t kOpName = 5;
constexpr uint32_t kOpMemberName = 6;
constexpr uint32_t kOpTypeRuntimeArray = 29;
constexpr uint32_t kOpDecorate = 71;
constexpr uint32_t kOpMemberDecorate = 72;
constexpr uint32_t kDecorationArrayStride = 6;
constexpr uint32_t kDecorationOffset = 35;

struct Module {
  std::map<uint32_t, std::string> names;
  std::map<uint32_t, std::map<uint32_t, std::string>> memberNames;
  std::map<uint32_t, std::map<uint32_t, uint32_t>> offsets;
  std::map<uint32_t, uint32_t> strides;  // of array types
  std::map<uint32_t, uint32_t> elements; // of unsized array types
};

Module parse(std::span<const uint32_t> spirv) {
  Module module;
  for (size_t at = kHeaderWords; at < spirv.size(); at += spirv[at] >> 16) {
    const uint32_t* words = &spirv[at];
    switch (words[0] & 0xffffu) {
    case kOpName:
      module.names[words[1]] = reinterpret_cast<const char*>(words + 2);
      break;
    case kOpMemberName:
      module.memberNames[words[1]][words[2]] = reinterpret_cast<const char*>(words + 3);
      break;
    case kOpTypeRuntimeArray:
      module.elements[words[1]] = words[2];
      break;
    case kOpDecorate:
      if (words[2] == kDecorationArrayStride) module.strides[words[1]] = words[3];
      break;
    case kOpMemberDecorate:
      if (words[3] == kDecorationOffset) module.offsets[words[1]][words[2]] = words[4];
      break;
    default:
      break;
    }
  }
  return module;
}

} // namespace

std::multimap<std::string, StructLayout> readStructLayouts(std::span<const uint32_t> spirv) {
  const Module module = parse(spirv);
  std::multimap<std::string, StructLayout> layouts;
  // The same struct may have a second type id without offsets, used for local variables: those are not listed here.
  for (const auto& [type, offsets] : module.offsets) {
    StructLayout layout;
    for (const auto& [member, offset] : offsets) {
      layout.members.push_back({module.memberNames.at(type).at(member), offset});
    }
    for (const auto& [array, element] : module.elements) {
      if (element == type) layout.arrayStride = module.strides.at(array);
    }
    layouts.emplace(module.names.at(type), std::move(layout));
  }
  return layouts;
}

} // namespace isophote::test
