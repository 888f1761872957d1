// Lets one header be read by C++ and by GLSL: vector types, addresses, and nothing else.
#ifndef ISOPHOTE_SHARED_GLSL_COMPAT_H
#define ISOPHOTE_SHARED_GLSL_COMPAT_H

#ifdef __cplusplus
#include <cstdint>
#include <glm/glm.hpp>
#define ISOPHOTE_SHARED_BEGIN namespace isophote::gpu {
#define ISOPHOTE_SHARED_END }
#define ISOPHOTE_CONST inline constexpr
namespace isophote::gpu {
using vec2 = glm::vec2;
using vec3 = glm::vec3;
using vec4 = glm::vec4;
using uint = uint32_t;
using uvec2 = glm::uvec2;
using uvec3 = glm::uvec3;
using ivec2 = glm::ivec2;
using Address = uint64_t; // of a device buffer; 0: absent
using Int64 = int64_t;
using Uint64 = uint64_t;
} // namespace isophote::gpu
#else
#define ISOPHOTE_SHARED_BEGIN
#define ISOPHOTE_SHARED_END
#define ISOPHOTE_CONST const
#define Address uint64_t
#define Int64 int64_t
#define Uint64 uint64_t
#endif

#endif
