// Typed reads of buffer views: strided, normalized, sparse.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "scene/gltf_buffers.hpp"
#include "scene/gltf_document.hpp"

namespace isophote::gltf {

enum class ComponentType : uint32_t {
  Int8 = 5120,
  UInt8 = 5121,
  Int16 = 5122,
  UInt16 = 5123,
  UInt32 = 5125,
  Float = 5126
};

/// Where the elements of an accessor lie, checked against its buffer view.
struct AccessorLayout {
  ComponentType componentType = ComponentType::Float;
  bool normalized = false;
  uint32_t componentCount = 0;        ///< 1 to 16
  std::array<uint32_t, 16> offsets{}; ///< of each component in an element; matrix columns start at multiples of 4
  uint64_t count = 0;
  uint64_t stride = 0;
  std::span<const std::byte> data;         ///< from the first element; empty: zeros
  bool hasStride = false;                  ///< the buffer view says so
  std::vector<uint32_t> sparseIndices;     ///< increasing, below `count`
  std::span<const std::byte> sparseValues; ///< tightly packed
  uint64_t elementBytes = 0;
};

class Accessors {
public:
  /// Checks every accessor of the document.
  /// @throws SceneError where one reaches out of its buffer view, is misaligned or has bad sparse indices
  Accessors(Document& document, const Buffers& buffers);

  [[nodiscard]] const AccessorLayout& layout(uint32_t accessor) const { return layouts_[accessor]; }

  /// Puts decoded elements, tightly packed, in place of what the buffer view holds, until the next call for `accessor`.
  void replaceData(uint32_t accessor, Bytes data);

  /// Elements as float vectors; normalized integers as KHR_mesh_quantization and glTF section 3.6.2.2 say.
  ///
  /// `Vector` is float or a glm float vector or matrix with as many components as the accessor, which the caller has
  /// made sure of.
  /// @throws LimitError
  template <class Vector> [[nodiscard]] std::vector<Vector> readFloats(uint32_t accessor) const {
    claim(accessor, sizeof(Vector));
    std::vector<Vector> result(layouts_[accessor].count, Vector(0));
    fillFloats(accessor, reinterpret_cast<float*>(result.data()));
    return result;
  }

  /// Unsigned integer components in element order.
  /// @throws LimitError
  [[nodiscard]] std::vector<uint32_t> readUnsigned(uint32_t accessor) const;

private:
  void claim(uint32_t accessor, uint64_t elementBytes) const;
  void fillFloats(uint32_t accessor, float* out) const;

  Document& document_;
  std::vector<AccessorLayout> layouts_;
  std::map<uint32_t, Bytes> replaced_;
};

/// `/accessors/N`
[[nodiscard]] std::string accessorPointer(uint32_t accessor);

} // namespace isophote::gltf
