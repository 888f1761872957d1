#include "support/compress.hpp"

#include <cstring>
#include <stdexcept>

#ifdef ISOPHOTE_HAS_DRACO
#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>
#endif
#ifdef ISOPHOTE_HAS_MESHOPT
#include <meshoptimizer.h>
#endif
#ifdef ISOPHOTE_HAS_WEBP
#include <webp/encode.h>
#endif

namespace isophote::test {
namespace {

[[noreturn]] [[maybe_unused]] void missing(const char* library) {
  throw std::logic_error(std::string("this build has no ") + library);
}

#ifdef ISOPHOTE_HAS_MESHOPT
std::string bytesOf(const std::vector<unsigned char>& buffer) { return {buffer.begin(), buffer.end()}; }
#endif

#ifdef ISOPHOTE_HAS_DRACO
template <class Vector>
void addAttribute(draco::Mesh& mesh, draco::GeometryAttribute::Type type, uint32_t id,
                  const std::vector<Vector>& values) {
  draco::GeometryAttribute attribute;
  attribute.Init(type, nullptr, Vector::length(), draco::DT_FLOAT32, false, sizeof(Vector), 0);
  const int index = mesh.AddAttribute(attribute, true, static_cast<uint32_t>(values.size()));
  for (uint32_t i = 0; i < values.size(); ++i) {
    mesh.attribute(index)->SetAttributeValue(draco::AttributeValueIndex(i), &values[i]);
  }
  mesh.attribute(index)->set_unique_id(id);
}
#endif

} // namespace

DracoStream encodeDraco([[maybe_unused]] const CompressibleMesh& mesh, [[maybe_unused]] DracoMethod method) {
#ifdef ISOPHOTE_HAS_DRACO
  draco::Mesh draco;
  draco.set_num_points(static_cast<uint32_t>(mesh.positions.size()));
  addAttribute(draco, draco::GeometryAttribute::POSITION, kDracoPosition, mesh.positions);
  addAttribute(draco, draco::GeometryAttribute::NORMAL, kDracoNormal, mesh.normals);
  addAttribute(draco, draco::GeometryAttribute::TEX_COORD, kDracoUv, mesh.uvs);
  for (size_t i = 0; i + 3 <= mesh.indices.size(); i += 3) {
    draco.AddFace({draco::PointIndex(mesh.indices[i]), draco::PointIndex(mesh.indices[i + 1]),
                   draco::PointIndex(mesh.indices[i + 2])});
  }
  draco::Encoder encoder;
  encoder.SetEncodingMethod(method == DracoMethod::Sequential ? draco::MESH_SEQUENTIAL_ENCODING
                                                              : draco::MESH_EDGEBREAKER_ENCODING);
  encoder.SetTrackEncodedProperties(true);
  encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, 14);
  encoder.SetAttributeQuantization(draco::GeometryAttribute::NORMAL, 10);
  encoder.SetAttributeQuantization(draco::GeometryAttribute::TEX_COORD, 12);
  draco::EncoderBuffer buffer;
  if (!encoder.EncodeMeshToBuffer(draco, &buffer).ok()) throw std::logic_error("not encoded");
  return {{buffer.data(), buffer.size()}, encoder.num_encoded_points(), encoder.num_encoded_faces()};
#else
  missing("libdraco");
#endif
}

std::string encodeMeshoptVertices([[maybe_unused]] const std::string& elements, [[maybe_unused]] size_t stride) {
#ifdef ISOPHOTE_HAS_MESHOPT
  const size_t count = elements.size() / stride;
  std::vector<unsigned char> buffer(meshopt_encodeVertexBufferBound(count, stride));
  buffer.resize(meshopt_encodeVertexBuffer(buffer.data(), buffer.size(), elements.data(), count, stride));
  return bytesOf(buffer);
#else
  missing("meshoptimizer");
#endif
}

std::string encodeMeshoptTriangles([[maybe_unused]] const std::vector<uint32_t>& indices,
                                   [[maybe_unused]] size_t vertexCount) {
#ifdef ISOPHOTE_HAS_MESHOPT
  std::vector<unsigned char> buffer(meshopt_encodeIndexBufferBound(indices.size(), vertexCount));
  buffer.resize(meshopt_encodeIndexBuffer(buffer.data(), buffer.size(), indices.data(), indices.size()));
  return bytesOf(buffer);
#else
  missing("meshoptimizer");
#endif
}

std::string encodeMeshoptIndices([[maybe_unused]] const std::vector<uint32_t>& indices,
                                 [[maybe_unused]] size_t vertexCount) {
#ifdef ISOPHOTE_HAS_MESHOPT
  std::vector<unsigned char> buffer(meshopt_encodeIndexSequenceBound(indices.size(), vertexCount));
  buffer.resize(meshopt_encodeIndexSequence(buffer.data(), buffer.size(), indices.data(), indices.size()));
  return bytesOf(buffer);
#else
  missing("meshoptimizer");
#endif
}

std::string filterOctahedral([[maybe_unused]] const std::vector<glm::vec4>& unitVectors) {
#ifdef ISOPHOTE_HAS_MESHOPT
  std::string result(unitVectors.size() * 4, '\0');
  meshopt_encodeFilterOct(result.data(), unitVectors.size(), 4, 8, &unitVectors[0].x);
  return result;
#else
  missing("meshoptimizer");
#endif
}

std::string filterQuaternion([[maybe_unused]] const std::vector<glm::vec4>& quaternions) {
#ifdef ISOPHOTE_HAS_MESHOPT
  std::string result(quaternions.size() * 8, '\0');
  meshopt_encodeFilterQuat(result.data(), quaternions.size(), 8, 16, &quaternions[0].x);
  return result;
#else
  missing("meshoptimizer");
#endif
}

std::string filterExponential([[maybe_unused]] const std::vector<glm::vec3>& vectors) {
#ifdef ISOPHOTE_HAS_MESHOPT
  std::string result(vectors.size() * sizeof(glm::vec3), '\0');
  meshopt_encodeFilterExp(result.data(), vectors.size(), sizeof(glm::vec3), 15, &vectors[0].x);
  return result;
#else
  missing("meshoptimizer");
#endif
}

std::string encodeWebp([[maybe_unused]] uint32_t width, [[maybe_unused]] uint32_t height,
                       [[maybe_unused]] const std::string& rgba) {
#ifdef ISOPHOTE_HAS_WEBP
  uint8_t* encoded = nullptr;
  const size_t size = WebPEncodeLosslessRGBA(reinterpret_cast<const uint8_t*>(rgba.data()), static_cast<int>(width),
                                             static_cast<int>(height), static_cast<int>(width * 4), &encoded);
  std::string result(reinterpret_cast<const char*>(encoded), size);
  WebPFree(encoded);
  return result;
#else
  missing("libwebp");
#endif
}

} // namespace isophote::test
