// Source: Khronos glTF 2.0.1 specification, section 3.6.2 "Accessors".
#include "scene/gltf_accessors.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "isophote/error.hpp"
#include "scene/checked_math.hpp"

namespace isophote::gltf {
namespace {

struct TypeShape {
  const char* name;
  uint32_t columns;
  uint32_t rows;
};

constexpr std::array<TypeShape, 7> kTypes{
    {{"SCALAR", 1, 1}, {"VEC2", 1, 2}, {"VEC3", 1, 3}, {"VEC4", 1, 4}, {"MAT2", 2, 2}, {"MAT3", 3, 3}, {"MAT4", 4, 4}}};

uint32_t componentBytes(ComponentType type) {
  switch (type) {
  case ComponentType::Int8:
  case ComponentType::UInt8:
    return 1;
  case ComponentType::Int16:
  case ComponentType::UInt16:
    return 2;
  case ComponentType::UInt32:
  case ComponentType::Float:
    break;
  }
  return 4;
}

template <class T> T load(const std::byte* from) {
  T value;
  std::memcpy(&value, from, sizeof(T));
  return value;
}

/// Divides by the largest value; the one more negative value of a signed type is clamped.
template <class T> float normalizedOr(const std::byte* from, bool normalized) {
  const T value = load<T>(from);
  if (!normalized) return static_cast<float>(value);
  return std::max(static_cast<float>(value) / static_cast<float>(std::numeric_limits<T>::max()), -1.0f);
}

float loadFloat(const std::byte* from, ComponentType type, bool normalized) {
  switch (type) {
  case ComponentType::Int8:
    return normalizedOr<int8_t>(from, normalized);
  case ComponentType::UInt8:
    return normalizedOr<uint8_t>(from, normalized);
  case ComponentType::Int16:
    return normalizedOr<int16_t>(from, normalized);
  case ComponentType::UInt16:
    return normalizedOr<uint16_t>(from, normalized);
  case ComponentType::UInt32:
    return static_cast<float>(load<uint32_t>(from));
  case ComponentType::Float:
    break;
  }
  return load<float>(from);
}

uint32_t loadUnsigned(const std::byte* from, ComponentType type) {
  if (type == ComponentType::UInt8) return load<uint8_t>(from);
  if (type == ComponentType::UInt16) return load<uint16_t>(from);
  return load<uint32_t>(from);
}

/// Fills type, component offsets and the size of one element.
void readType(const Document& document, const Json& accessor, const std::string& pointer, AccessorLayout& layout) {
  const std::string type = accessor.at("type").get<std::string>();
  const auto shape = std::find_if(kTypes.begin(), kTypes.end(), [&](const TypeShape& s) { return type == s.name; });
  if (shape == kTypes.end()) document.fail(pointer + "/type", "SCALAR, VEC2 to VEC4 or MAT2 to MAT4, found " + type);
  layout.componentType = static_cast<ComponentType>(accessor.at("componentType").get<uint32_t>());
  layout.normalized = boolOr(accessor, "normalized", false);
  layout.componentCount = shape->columns * shape->rows;
  layout.count = accessor.at("count").get<uint64_t>();
  const uint32_t size = componentBytes(layout.componentType);
  uint32_t columnBytes = shape->rows * size;
  if (shape->columns > 1) columnBytes = (columnBytes + 3) / 4 * 4;
  for (uint32_t i = 0; i < layout.componentCount; ++i) {
    layout.offsets[i] = i / shape->rows * columnBytes + i % shape->rows * size;
  }
  layout.elementBytes = uint64_t{shape->columns} * columnBytes;
}

/// `count` elements of `stride` bytes from `offset` on, checked against a view of `viewBytes`.
bool elementsFit(uint64_t offset, uint64_t stride, uint64_t count, uint64_t elementBytes, uint64_t viewBytes) {
  const std::optional<uint64_t> last = checkedMultiply(stride, count - 1);
  const std::optional<uint64_t> length = last ? checkedAdd(*last, elementBytes) : std::nullopt;
  return length && rangeFits(offset, *length, viewBytes);
}

class LayoutReader {
public:
  LayoutReader(Document& document, const Buffers& buffers)
      : document_(document), buffers_(buffers), views_(arrayOrEmpty(document.root, "bufferViews")) {}

  AccessorLayout read(const Json& accessor, const std::string& pointer) {
    AccessorLayout layout;
    readType(document_, accessor, pointer, layout);
    layout.stride = layout.elementBytes;
    if (accessor.contains("bufferView")) readDense(accessor, pointer, layout);
    if (accessor.contains("sparse")) readSparse(accessor.at("sparse"), pointer + "/sparse", layout);
    return layout;
  }

private:
  void readDense(const Json& accessor, const std::string& pointer, AccessorLayout& layout) {
    const uint32_t view = *indexOf(accessor, "bufferView");
    const uint64_t offset = integerOr(accessor, "byteOffset", 0);
    layout.hasStride = views_[view].contains("byteStride");
    layout.stride = integerOr(views_[view], "byteStride", layout.elementBytes);
    const uint32_t size = componentBytes(layout.componentType);
    if (layout.stride < layout.elementBytes || layout.stride % size != 0) {
      document_.fail(
          fmt::format("/bufferViews/{}/byteStride", view),
          fmt::format("a multiple of {} of at least {} for accessor {}, found {} (ACCESSOR_TOTAL_OFFSET_ALIGNMENT)",
                      size, layout.elementBytes, pointer, layout.stride));
    }
    checkAlignment(view, offset, size, pointer + "/byteOffset");
    const std::span<const std::byte> bytes = buffers_.view(view);
    if (!elementsFit(offset, layout.stride, layout.count, layout.elementBytes, bytes.size())) {
      document_.fail(pointer, fmt::format("elements inside the {} bytes of buffer view {}, found {} of {} bytes from "
                                          "offset {} (ACCESSOR_TOO_LONG)",
                                          bytes.size(), view, layout.count, layout.elementBytes, offset));
    }
    layout.data = bytes.subspan(offset);
  }

  void checkAlignment(uint32_t view, uint64_t offset, uint32_t size, const std::string& pointer) const {
    const uint64_t viewOffset = integerOr(views_[view], "byteOffset", 0);
    if (offset % size != 0 || viewOffset % size != 0) {
      document_.fail(pointer, fmt::format("data aligned to {} bytes (ACCESSOR_OFFSET_ALIGNMENT)", size));
    }
  }

  void readSparse(const Json& sparse, const std::string& pointer, AccessorLayout& layout) {
    const uint64_t count = sparse.at("count").get<uint64_t>();
    if (count > layout.count) {
      document_.fail(pointer + "/count", fmt::format("at most the accessor's count {}, found {}", layout.count, count));
    }
    const Json& indices = sparse.at("indices");
    const auto type = static_cast<ComponentType>(indices.at("componentType").get<uint32_t>());
    const uint32_t size = componentBytes(type);
    const auto indexBytes = sparseRange(indices, size, size, count, pointer + "/indices");
    layout.sparseValues = sparseRange(sparse.at("values"), componentBytes(layout.componentType), layout.elementBytes,
                                      count, pointer + "/values");
    document_.claim(count * sizeof(uint32_t), pointer); // count is at most indexBytes.size(): no overflow
    layout.sparseIndices.reserve(count);
    for (uint64_t i = 0; i < count; ++i) {
      const uint32_t index = loadUnsigned(indexBytes.data() + i * size, type);
      if (index >= layout.count || (i > 0 && index <= layout.sparseIndices.back())) {
        document_.fail(pointer + "/indices",
                       fmt::format("increasing indices below {}, found {} at place {} (ACCESSOR_SPARSE_INDEX_OOB)",
                                   layout.count, index, i));
      }
      layout.sparseIndices.push_back(index);
    }
  }

  std::span<const std::byte> sparseRange(const Json& part, uint32_t componentSize, uint64_t elementBytes,
                                         uint64_t count, const std::string& pointer) const {
    const uint32_t view = *indexOf(part, "bufferView");
    const uint64_t offset = integerOr(part, "byteOffset", 0);
    checkAlignment(view, offset, componentSize, pointer + "/byteOffset");
    const std::span<const std::byte> bytes = buffers_.view(view);
    if (!elementsFit(offset, elementBytes, count, elementBytes, bytes.size())) {
      document_.fail(pointer, fmt::format("{} elements of {} bytes inside buffer view {} (ACCESSOR_TOO_LONG)", count,
                                          elementBytes, view));
    }
    return bytes.subspan(offset);
  }

  Document& document_;
  const Buffers& buffers_;
  const Json& views_;
};

/// Calls store(element, bytes) for every element, the sparse ones after the dense ones.
template <class Store> void forEachElement(const AccessorLayout& layout, const Store& store) {
  if (!layout.data.empty()) {
    for (uint64_t i = 0; i < layout.count; ++i) store(i, layout.data.data() + i * layout.stride);
  }
  for (size_t i = 0; i < layout.sparseIndices.size(); ++i) {
    store(layout.sparseIndices[i], layout.sparseValues.data() + i * layout.elementBytes);
  }
}

} // namespace

std::string accessorPointer(uint32_t accessor) { return fmt::format("/accessors/{}", accessor); }

Accessors::Accessors(Document& document, const Buffers& buffers) : document_(document) {
  LayoutReader reader(document, buffers);
  const Json& accessors = arrayOrEmpty(document.root, "accessors");
  layouts_.reserve(accessors.size());
  for (size_t i = 0; i < accessors.size(); ++i) {
    layouts_.push_back(reader.read(accessors[i], accessorPointer(static_cast<uint32_t>(i))));
  }
}

void Accessors::replaceData(uint32_t accessor, Bytes data) {
  Bytes& owned = replaced_[accessor];
  owned = std::move(data);
  AccessorLayout& layout = layouts_[accessor];
  layout.data = owned;
  layout.stride = layout.elementBytes;
  layout.hasStride = false;
}

void Accessors::claim(uint32_t accessor, uint64_t elementBytes) const {
  const std::optional<uint64_t> bytes = checkedMultiply(layouts_[accessor].count, elementBytes);
  document_.claim(bytes.value_or(UINT64_MAX), accessorPointer(accessor));
}

void Accessors::fillFloats(uint32_t accessor, float* out) const {
  const AccessorLayout& layout = layouts_[accessor];
  const uint32_t components = layout.componentCount;
  forEachElement(layout, [&](uint64_t element, const std::byte* bytes) {
    for (uint32_t c = 0; c < components; ++c) {
      out[element * components + c] = loadFloat(bytes + layout.offsets[c], layout.componentType, layout.normalized);
    }
  });
}

std::vector<uint32_t> Accessors::readUnsigned(uint32_t accessor) const {
  const AccessorLayout& layout = layouts_[accessor];
  claim(accessor, uint64_t{layout.componentCount} * sizeof(uint32_t));
  std::vector<uint32_t> result(layout.count * layout.componentCount);
  forEachElement(layout, [&](uint64_t element, const std::byte* bytes) {
    for (uint32_t c = 0; c < layout.componentCount; ++c) {
      result[element * layout.componentCount + c] = loadUnsigned(bytes + layout.offsets[c], layout.componentType);
    }
  });
  return result;
}

} // namespace isophote::gltf
