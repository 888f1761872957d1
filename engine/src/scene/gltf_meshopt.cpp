// Source: EXT_meshopt_compression and KHR_meshopt_compression, "Specifying compressed views".
#include "scene/gltf_meshopt.hpp"

#include <array>
#include <optional>

#include <fmt/format.h>

#include "scene/checked_math.hpp"
#include "scene/meshopt_decode.hpp"

namespace isophote::gltf {
namespace {

constexpr std::array<const char*, 2> kExtensions{"KHR_meshopt_compression", "EXT_meshopt_compression"};

std::optional<MeshoptMode> modeNamed(const std::string& name) {
  if (name == "ATTRIBUTES") return MeshoptMode::Attributes;
  if (name == "TRIANGLES") return MeshoptMode::Triangles;
  if (name == "INDICES") return MeshoptMode::Indices;
  return std::nullopt;
}

std::optional<MeshoptFilter> filterNamed(const std::string& name) {
  if (name == "NONE") return MeshoptFilter::None;
  if (name == "OCTAHEDRAL") return MeshoptFilter::Octahedral;
  if (name == "QUATERNION") return MeshoptFilter::Quaternion;
  if (name == "EXPONENTIAL") return MeshoptFilter::Exponential;
  return std::nullopt;
}

bool strideSuits(MeshoptMode mode, MeshoptFilter filter, uint64_t stride) {
  constexpr uint64_t kMaxVertexBytes = 256;
  if (mode != MeshoptMode::Attributes) return stride == 2 || stride == 4;
  if (stride == 0 || stride % 4 != 0 || stride > kMaxVertexBytes) return false;
  if (filter == MeshoptFilter::Octahedral) return stride == 4 || stride == 8;
  return filter != MeshoptFilter::Quaternion || stride == 8;
}

} // namespace

MeshoptExtension meshoptExtension(const Json& view, const std::string& viewPointer) {
  for (const char* name : kExtensions) {
    if (const Json* json = extension(view, name)) {
      return {.json = json, .pointer = fmt::format("{}/extensions/{}", viewPointer, name)};
    }
  }
  return {};
}

bool isEmptyMeshoptFallback(const Json& buffer) {
  if (buffer.contains("uri")) return false;
  for (const char* name : kExtensions) {
    const Json* meshopt = extension(buffer, name);
    if (meshopt && boolOr(*meshopt, "fallback", false)) return true;
  }
  return false;
}

bool offersMeshopt(const Json& json, std::span<const std::byte> packed) {
  const std::optional<MeshoptMode> mode = modeNamed(stringOr(json, "mode", ""));
  const bool knowsVersion = !mode || meshoptKnowsVersion(packed, *mode); // no mode at all is for unpackMeshopt to say
  return meshoptAvailable() && knowsVersion && stringOr(json, "filter", "NONE") != "COLOR";
}

Bytes unpackMeshopt(Document& document, const Json& view, const MeshoptExtension& meshopt,
                    std::span<const std::byte> packed) {
  const Json& json = *meshopt.json;
  const std::optional<MeshoptMode> mode = modeNamed(stringOr(json, "mode", ""));
  if (!mode) document.fail(meshopt.pointer + "/mode", "ATTRIBUTES, TRIANGLES or INDICES");
  const std::optional<MeshoptFilter> filter = filterNamed(stringOr(json, "filter", "NONE"));
  if (!filter || (*filter != MeshoptFilter::None && *mode != MeshoptMode::Attributes)) {
    document.fail(meshopt.pointer + "/filter", "NONE, or with ATTRIBUTES one of OCTAHEDRAL, QUATERNION, EXPONENTIAL");
  }
  const uint64_t stride = integerOr(json, "byteStride", 0);
  if (!strideSuits(*mode, *filter, stride) || integerOr(view, "byteStride", stride) != stride) {
    document.fail(meshopt.pointer + "/byteStride",
                  "2 or 4 for indices; for attributes the view's byteStride, a multiple of 4 that suits the filter");
  }
  const uint64_t count = integerOr(json, "count", 0);
  if (*mode == MeshoptMode::Triangles && count % 3 != 0) {
    document.fail(meshopt.pointer + "/count", "a multiple of 3, three indices a triangle");
  }
  const std::optional<uint64_t> bytes = checkedMultiply(count, stride);
  if (!bytes || *bytes != integerOr(view, "byteLength", 0)) {
    document.fail(meshopt.pointer + "/count", "as many elements as the view's byteLength holds");
  }
  document.claim(*bytes, meshopt.pointer);
  Bytes result(*bytes);
  if (!meshoptDecode(packed, *mode, *filter, count, static_cast<uint32_t>(stride), result)) {
    document.fail(meshopt.pointer, "a whole meshopt stream of that mode, count and byteStride");
  }
  return result;
}

} // namespace isophote::gltf
