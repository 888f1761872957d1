// Buffer views packed by meshoptimizer. The only place that knows that library.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace isophote {

enum class MeshoptMode : uint32_t { Attributes, Triangles, Indices };
enum class MeshoptFilter : uint32_t { None, Octahedral, Quaternion, Exponential };

/// Whether this build has meshoptimizer; without it meshoptDecode returns false.
[[nodiscard]] bool meshoptAvailable();

/// Whether the stream is in a version that the decoder knows: version 0 of vertices, 0 and 1 of indices.
[[nodiscard]] bool meshoptKnowsVersion(std::span<const std::byte> stream, MeshoptMode mode);

/// Decodes `count` elements of `stride` bytes into `out`, which is that large.
///
/// Source: EXT_meshopt_compression, appendices A and B.
/// @param stride  Attributes: a multiple of 4 up to 256, and what the filter asks for; else 2 or 4
/// @param count   Triangles: a multiple of 3
/// @return        false where the stream is broken
[[nodiscard]] bool meshoptDecode(std::span<const std::byte> stream, MeshoptMode mode, MeshoptFilter filter,
                                 uint64_t count, uint32_t stride, std::span<std::byte> out);

} // namespace isophote
