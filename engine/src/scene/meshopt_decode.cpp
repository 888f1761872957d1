#include "scene/meshopt_decode.hpp"

#ifdef ISOPHOTE_HAS_MESHOPT

#include <meshoptimizer.h>

namespace isophote {
namespace {

void unfilter(MeshoptFilter filter, std::span<std::byte> data, uint64_t count, uint32_t stride) {
  switch (filter) {
  case MeshoptFilter::None:
    return;
  case MeshoptFilter::Octahedral:
    return meshopt_decodeFilterOct(data.data(), count, stride);
  case MeshoptFilter::Quaternion:
    return meshopt_decodeFilterQuat(data.data(), count, stride);
  case MeshoptFilter::Exponential:
    return meshopt_decodeFilterExp(data.data(), count, stride);
  }
}

} // namespace

bool meshoptAvailable() { return true; }

bool meshoptKnowsVersion(std::span<const std::byte> stream, MeshoptMode mode) {
  if (stream.empty()) return true; // broken, which is for the decoder to say
  const auto header = std::to_integer<uint32_t>(stream[0]);
  constexpr uint32_t kVertexHeader = 0xa0; // + version, in the low four bits
  return mode != MeshoptMode::Attributes || (header & 0xf0u) != kVertexHeader || header == kVertexHeader;
}

bool meshoptDecode(std::span<const std::byte> stream, MeshoptMode mode, MeshoptFilter filter, uint64_t count,
                   uint32_t stride, std::span<std::byte> out) {
  const auto* bytes = reinterpret_cast<const unsigned char*>(stream.data());
  int code = 0;
  switch (mode) {
  case MeshoptMode::Attributes:
    code = meshopt_decodeVertexBuffer(out.data(), count, stride, bytes, stream.size());
    break;
  case MeshoptMode::Triangles:
    code = meshopt_decodeIndexBuffer(out.data(), count, stride, bytes, stream.size());
    break;
  case MeshoptMode::Indices:
    code = meshopt_decodeIndexSequence(out.data(), count, stride, bytes, stream.size());
    break;
  }
  if (code != 0) return false;
  unfilter(filter, out, count, stride);
  return true;
}

} // namespace isophote

#else

namespace isophote {

bool meshoptAvailable() { return false; }
bool meshoptKnowsVersion(std::span<const std::byte>, MeshoptMode) { return false; }
bool meshoptDecode(std::span<const std::byte>, MeshoptMode, MeshoptFilter, uint64_t, uint32_t, std::span<std::byte>) {
  return false;
}

} // namespace isophote

#endif
