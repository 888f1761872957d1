#include "scene/draco_decode.hpp"

#ifdef ISOPHOTE_HAS_DRACO

#include <draco/compression/decode.h>
#include <draco/compression/point_cloud/point_cloud_decoder.h>
#include <draco/core/varint_decoding.h>
#include <draco/metadata/metadata_decoder.h>

namespace isophote {
namespace {

draco::DecoderBuffer bufferOf(std::span<const std::byte> stream) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(stream.data()), stream.size());
  return buffer;
}

template <class Number>
std::vector<std::byte> convert(const draco::PointAttribute& attribute, uint32_t pointCount, uint32_t components) {
  std::vector<std::byte> result(size_t{pointCount} * components * sizeof(Number));
  auto* out = reinterpret_cast<Number*>(result.data());
  for (uint32_t point = 0; point < pointCount; ++point) {
    const draco::AttributeValueIndex value = attribute.mapped_index(draco::PointIndex(point));
    if (value.value() >= attribute.size()) return {};
    if (!attribute.ConvertValue<Number>(value, static_cast<int8_t>(components), out + size_t{point} * components)) {
      return {};
    }
  }
  return result;
}

} // namespace

bool dracoAvailable() { return true; }

bool dracoReadSize(std::span<const std::byte> stream, DracoSize& size, std::string& problem) {
  draco::DecoderBuffer buffer = bufferOf(stream);
  draco::DracoHeader header;
  const draco::Status status = draco::PointCloudDecoder::DecodeHeader(&buffer, &header);
  if (!status.ok()) {
    problem = status.error_msg_string();
    return false;
  }
  constexpr uint8_t kMajor = 2;
  constexpr uint8_t kMinor = 2;
  if (header.version_major != kMajor || header.version_minor != kMinor ||
      header.encoder_type != draco::TRIANGULAR_MESH) {
    problem = "a triangle mesh of bitstream version 2.2 was expected";
    return false;
  }
  buffer.set_bitstream_version(DRACO_BITSTREAM_VERSION(kMajor, kMinor));
  draco::GeometryMetadata metadata;
  bool isRead =
      (header.flags & METADATA_FLAG_MASK) == 0 || draco::MetadataDecoder().DecodeGeometryMetadata(&buffer, &metadata);
  if (header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING) {
    uint8_t traversal = 0;
    isRead = isRead && buffer.Decode(&traversal) && draco::DecodeVarint(&size.vertices, &buffer) &&
             draco::DecodeVarint(&size.faces, &buffer);
  } else {
    isRead = isRead && draco::DecodeVarint(&size.faces, &buffer) && draco::DecodeVarint(&size.vertices, &buffer);
  }
  if (!isRead) problem = "its header is truncated";
  return isRead;
}

struct DracoMesh::Impl {
  std::unique_ptr<draco::Mesh> mesh;
};

DracoMesh::DracoMesh() : impl_(std::make_unique<Impl>()) {}
DracoMesh::~DracoMesh() = default;

bool DracoMesh::decode(std::span<const std::byte> stream, std::string& problem) {
  draco::DecoderBuffer buffer = bufferOf(stream);
  draco::Decoder decoder;
  draco::StatusOr<std::unique_ptr<draco::Mesh>> decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok()) {
    problem = decoded.status().error_msg_string();
    return false;
  }
  impl_->mesh = std::move(decoded).value();
  return impl_->mesh != nullptr;
}

uint32_t DracoMesh::pointCount() const { return impl_->mesh->num_points(); }
uint32_t DracoMesh::faceCount() const { return impl_->mesh->num_faces(); }

std::vector<uint32_t> DracoMesh::indices() const {
  std::vector<uint32_t> result;
  result.reserve(size_t{faceCount()} * 3);
  for (uint32_t i = 0; i < faceCount(); ++i) {
    const draco::Mesh::Face& face = impl_->mesh->face(draco::FaceIndex(i));
    for (size_t corner = 0; corner < 3; ++corner) result.push_back(face[corner].value());
  }
  return result;
}

bool DracoMesh::hasAttribute(uint32_t uniqueId) const {
  return impl_->mesh->GetAttributeByUniqueId(uniqueId) != nullptr;
}

std::vector<std::byte> DracoMesh::attribute(uint32_t uniqueId, uint32_t components, DracoNumber number) const {
  const draco::PointAttribute& attribute = *impl_->mesh->GetAttributeByUniqueId(uniqueId);
  if (static_cast<uint32_t>(attribute.num_components()) != components) return {};
  switch (number) {
  case DracoNumber::Int8:
    return convert<int8_t>(attribute, pointCount(), components);
  case DracoNumber::UInt8:
    return convert<uint8_t>(attribute, pointCount(), components);
  case DracoNumber::Int16:
    return convert<int16_t>(attribute, pointCount(), components);
  case DracoNumber::UInt16:
    return convert<uint16_t>(attribute, pointCount(), components);
  case DracoNumber::UInt32:
    return convert<uint32_t>(attribute, pointCount(), components);
  case DracoNumber::Float:
    break;
  }
  return convert<float>(attribute, pointCount(), components);
}

} // namespace isophote

#else // every function but the first is never called

#include "isophote/error.hpp"

namespace isophote {

struct DracoMesh::Impl {};
DracoMesh::DracoMesh() = default;
DracoMesh::~DracoMesh() = default;

bool dracoAvailable() { return false; }
bool dracoReadSize(std::span<const std::byte>, DracoSize&, std::string&) { throw Error("this build has no Draco"); }
bool DracoMesh::decode(std::span<const std::byte>, std::string&) { throw Error("this build has no Draco"); }
uint32_t DracoMesh::pointCount() const { return 0; }
uint32_t DracoMesh::faceCount() const { return 0; }
std::vector<uint32_t> DracoMesh::indices() const { return {}; }
bool DracoMesh::hasAttribute(uint32_t) const { return false; }
std::vector<std::byte> DracoMesh::attribute(uint32_t, uint32_t, DracoNumber) const { return {}; }

} // namespace isophote

#endif
