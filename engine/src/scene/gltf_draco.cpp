// Source: KHR_draco_mesh_compression, "Overview" and "Conformance".
#include "scene/gltf_draco.hpp"

#include <fmt/format.h>

#include "isophote/error.hpp"
#include "scene/draco_decode.hpp"

namespace isophote::gltf {
namespace {

constexpr uint64_t kTriangles = 4;
constexpr uint64_t kTriangleStrip = 5;

/// What libdraco holds for a triangle while it decodes: two tables of three corners, twice with seams, and the output.
constexpr uint64_t kWorkingBytesPerFace = 64;

DracoNumber numberOf(ComponentType type) {
  switch (type) {
  case ComponentType::Int8:
    return DracoNumber::Int8;
  case ComponentType::UInt8:
    return DracoNumber::UInt8;
  case ComponentType::Int16:
    return DracoNumber::Int16;
  case ComponentType::UInt16:
    return DracoNumber::UInt16;
  case ComponentType::UInt32:
    return DracoNumber::UInt32;
  case ComponentType::Float:
    break;
  }
  return DracoNumber::Float;
}

class DracoReader {
public:
  DracoReader(Document& document, Accessors& accessors, const Json& primitive, std::string pointer)
      : document_(document), accessors_(accessors), primitive_(primitive), pointer_(std::move(pointer)) {}

  std::vector<uint32_t> read(const Json& draco, std::span<const std::byte> stream) {
    checkSize(stream);
    std::string problem;
    if (!mesh_.decode(stream, problem)) fail("a whole Draco stream, " + problem);
    checkFaceCount(mesh_.faceCount());
    for (const auto& [name, id] : draco.at("attributes").items()) readAttribute(name, id.get<uint32_t>());
    return mesh_.indices();
  }

private:
  [[noreturn]] void fail(const std::string& expected) const { document_.fail(pointer_, expected); }

  /// Before the decoder allocates what the stream announces.
  void checkSize(std::span<const std::byte> stream) {
    DracoSize size;
    std::string problem;
    if (!dracoReadSize(stream, size, problem)) fail("a Draco stream, " + problem);
    checkFaceCount(size.faces);
    const uint64_t count = accessors_.layout(*indexOf(primitive_.at("attributes"), "POSITION")).count;
    if (size.vertices > count) {
      fail(fmt::format("at most the {} vertices of POSITION, found {}", count, size.vertices));
    }
    document_.claim(size.faces * kWorkingBytesPerFace, pointer_); // 32 bits and 6
  }

  void checkFaceCount(uint64_t faces) const {
    const std::optional<uint32_t> indices = indexOf(primitive_, "indices");
    if (!indices || integerOr(primitive_, "mode", kTriangles) == kTriangleStrip) return; // a strip has other indices
    const uint64_t count = accessors_.layout(*indices).count;
    if (count != faces * 3) fail(fmt::format("the {} indices of its accessor, found {} triangles", count, faces));
  }

  void readAttribute(const std::string& name, uint32_t id) {
    const std::string at = fmt::format("{}/attributes/{}", pointer_, name);
    const std::optional<uint32_t> accessor = indexOf(primitive_.at("attributes"), name.c_str());
    if (!accessor) document_.fail(at, "an attribute that the primitive has as well");
    if (!mesh_.hasAttribute(id)) document_.fail(at, fmt::format("the id of an attribute in the stream, found {}", id));
    const AccessorLayout& layout = accessors_.layout(*accessor);
    if (layout.count != mesh_.pointCount()) {
      document_.fail(at, fmt::format("the {} elements of {}, found {}", layout.count, accessorPointer(*accessor),
                                     mesh_.pointCount()));
    }
    document_.claim(layout.count * layout.elementBytes, at); // the count has 32 bits
    Bytes data = mesh_.attribute(id, layout.componentCount, numberOf(layout.componentType));
    if (data.empty()) document_.fail(at, fmt::format("numbers of the type of {}", accessorPointer(*accessor)));
    accessors_.replaceData(*accessor, std::move(data));
  }

  Document& document_;
  Accessors& accessors_;
  const Json& primitive_;
  std::string pointer_; ///< of the extension
  DracoMesh mesh_;
};

} // namespace

std::optional<std::vector<uint32_t>> decodeDraco(Document& document, const Buffers& buffers, Accessors& accessors,
                                                 const Json& primitive, const std::string& pointer) {
  const Json* draco = extension(primitive, "KHR_draco_mesh_compression");
  if (!draco) return std::nullopt;
  const std::string at = pointer + "/extensions/KHR_draco_mesh_compression";
  if (!dracoAvailable()) {
    const AccessorLayout& positions = accessors.layout(*indexOf(primitive.at("attributes"), "POSITION"));
    if (!positions.data.empty()) return std::nullopt;
    throw UnsupportedError(document.file, at, "uncompressed data beside it, this build has no Draco");
  }
  const uint64_t mode = integerOr(primitive, "mode", kTriangles);
  if (mode != kTriangles && mode != kTriangleStrip) document.fail(pointer + "/mode", "4 or 5 where Draco is used");
  return DracoReader(document, accessors, primitive, at).read(*draco, buffers.view(*indexOf(*draco, "bufferView")));
}

} // namespace isophote::gltf
