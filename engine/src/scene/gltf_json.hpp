// JSON text to a tree, refusing what is dangerous or ambiguous, and short accessors for trees that passed checkSchema.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include <nlohmann/json.hpp>

namespace isophote::gltf {

using Json = nlohmann::json;

inline constexpr uint64_t kMaxJsonBytes = 512ull << 20; ///< a tree takes about ten times its text
inline constexpr uint32_t kMaxJsonDepth = 128;          ///< glTF itself nests to about 10

/// Parses UTF-8 JSON text whose root is an object.
/// @throws SceneError on a syntax error, nesting deeper than kMaxJsonDepth, a key given twice, a number beyond double
/// @throws LimitError on more than kMaxJsonBytes
[[nodiscard]] Json parseJson(const std::string& file, std::span<const std::byte> text);

/// The member `name` of an object, or null where absent.
[[nodiscard]] const Json* member(const Json& object, const char* name);
/// The object extensions.`name`, or null where absent.
[[nodiscard]] const Json* extension(const Json& object, const char* name);
/// The array `name` of an object; an empty array where absent.
[[nodiscard]] const Json& arrayOrEmpty(const Json& object, const char* name);

/// extras.`name` where it is a number. Extras belong to whoever wrote them, so anything else counts as absent.
[[nodiscard]] std::optional<double> extraNumber(const Json& object, const char* name);

[[nodiscard]] double numberOr(const Json& object, const char* name, double fallback);
[[nodiscard]] uint64_t integerOr(const Json& object, const char* name, uint64_t fallback);
[[nodiscard]] bool boolOr(const Json& object, const char* name, bool fallback);
[[nodiscard]] std::string stringOr(const Json& object, const char* name, const std::string& fallback);
[[nodiscard]] std::optional<uint32_t> indexOf(const Json& object, const char* name);

} // namespace isophote::gltf
