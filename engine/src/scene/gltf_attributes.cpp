// Source: Khronos glTF 2.0.1 specification, section 3.7.2 "Meshes", and KHR_mesh_quantization.
#include "scene/gltf_attributes.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

namespace isophote::gltf {
namespace {

constexpr uint32_t kAnySmallInteger = kSignedNormalized | kUnsignedNormalized | kSignedInteger | kUnsignedInteger;

/// 0 for 32-bit integers, which no attribute may use.
uint32_t numberKind(const AccessorLayout& layout) {
  switch (layout.componentType) {
  case ComponentType::Float:
    return kFloat;
  case ComponentType::Int8:
  case ComponentType::Int16:
    return layout.normalized ? kSignedNormalized : kSignedInteger;
  case ComponentType::UInt8:
  case ComponentType::UInt16:
    return layout.normalized ? kUnsignedNormalized : kUnsignedInteger;
  case ComponentType::UInt32:
    break;
  }
  return 0;
}

bool isFinite(glm::vec2 v) { return std::isfinite(v.x) && std::isfinite(v.y); }
bool isFinite(glm::vec3 v) { return isFinite(glm::vec2(v)) && std::isfinite(v.z); }
bool isFinite(glm::vec4 v) { return isFinite(glm::vec3(v)) && std::isfinite(v.w); }

class AttributeReader {
public:
  AttributeReader(Document& document, const Accessors& accessors, const Json& attributes, std::string pointer)
      : document_(document), accessors_(accessors), attributes_(attributes), pointer_(std::move(pointer)) {}

  Attributes read() {
    count_ = accessors_.layout(*indexOf(attributes_, "POSITION")).count;
    Primitive& vertices = result_.vertices;
    vertices.positions = readAs<glm::vec3>("POSITION", 3, kFloat | kAnySmallInteger);
    requireFinite(vertices.positions);
    vertices.normals = readAs<glm::vec3>("NORMAL", 3, kFloat | kSignedNormalized);
    vertices.tangents = readAs<glm::vec4>("TANGENT", 4, kFloat | kSignedNormalized);
    readUvs();
    readColors();
    readJoints();
    return std::move(result_);
  }

private:
  std::string at(const std::string& name) const { return fmt::format("{}/{}", pointer_, name); }

  /// Empty where the attribute is absent.
  template <class Vector>
  std::vector<Vector> readAs(const std::string& name, uint32_t components, uint32_t kinds) const {
    const std::optional<uint32_t> accessor = checkedAccessor(name, components, kinds);
    return accessor ? accessors_.readFloats<Vector>(*accessor) : std::vector<Vector>{};
  }

  std::optional<uint32_t> checkedAccessor(const std::string& name, uint32_t components, uint32_t kinds) const {
    const std::optional<uint32_t> accessor = indexOf(attributes_, name.c_str());
    if (!accessor) return std::nullopt;
    requireFormat(document_, accessors_, *accessor, components, kinds, at(name));
    const uint64_t count = accessors_.layout(*accessor).count;
    if (count != count_) {
      document_.fail(at(name), fmt::format("as many elements as POSITION has, {}, found {} "
                                           "(MESH_PRIMITIVE_UNEQUAL_ACCESSOR_COUNT)",
                                           count_, count));
    }
    return accessor;
  }

  void requireFinite(const std::vector<glm::vec3>& positions) const {
    const auto bad = std::find_if(positions.begin(), positions.end(), [](glm::vec3 p) { return !isFinite(p); });
    if (bad == positions.end()) return;
    document_.fail(
        accessorPointer(*indexOf(attributes_, "POSITION")),
        fmt::format("finite positions, element {} is not (ACCESSOR_INVALID_FLOAT)", bad - positions.begin()));
  }

  void readUvs() {
    for (uint32_t set = 0; set < kMaxUvSets; ++set) {
      const std::string name = fmt::format("TEXCOORD_{}", set);
      std::vector<glm::vec2>& uvs = result_.vertices.uvs[set];
      uvs = readAs<glm::vec2>(name, 2, kFloat | kAnySmallInteger);
      const uint64_t repaired = replaceBad(uvs, glm::vec2(0));
      document_.warnings.add("NaN or infinite texture coordinates are set to 0", at(name), repaired);
    }
    if (attributes_.contains(fmt::format("TEXCOORD_{}", kMaxUvSets))) {
      document_.warnings.add(fmt::format("UV sets above {} are left out", kMaxUvSets - 1), pointer_);
    }
  }

  void readColors() {
    constexpr uint32_t kKinds = kFloat | kUnsignedNormalized;
    const std::optional<uint32_t> accessor = indexOf(attributes_, "COLOR_0");
    if (!accessor) return;
    std::vector<glm::vec4>& colors = result_.vertices.colors;
    if (accessors_.layout(*accessor).componentCount == 3) {
      const std::vector<glm::vec3> opaque = readAs<glm::vec3>("COLOR_0", 3, kKinds);
      colors.reserve(opaque.size());
      for (const glm::vec3 color : opaque) colors.emplace_back(color, 1.0f);
    } else {
      colors = readAs<glm::vec4>("COLOR_0", 4, kKinds);
    }
    document_.warnings.add("NaN or infinite vertex colors are set to 1", at("COLOR_0"),
                           replaceBad(colors, glm::vec4(1)));
    uint64_t clampedCount = 0;
    for (glm::vec4& color : colors) {
      const glm::vec4 clamped = glm::clamp(color, 0.0f, 1.0f);
      if (clamped != color) ++clampedCount;
      color = clamped;
    }
    document_.warnings.add("vertex colors are clamped to [0, 1]", at("COLOR_0"), clampedCount);
  }

  template <class Vector> static uint64_t replaceBad(std::vector<Vector>& values, Vector replacement) {
    uint64_t count = 0;
    for (Vector& value : values) {
      if (isFinite(value)) continue;
      value = replacement;
      ++count;
    }
    return count;
  }

  void readJoints() {
    for (uint32_t set = 0;; ++set) {
      const std::string name = fmt::format("JOINTS_{}", set);
      const std::optional<uint32_t> joints = checkedAccessor(name, 4, kUnsignedInteger);
      if (!joints) return;
      JointSet& result = result_.jointSets.emplace_back();
      const std::vector<uint32_t> flat = accessors_.readUnsigned(*joints);
      result.joints.reserve(flat.size() / 4);
      for (size_t i = 0; i + 4 <= flat.size(); i += 4) {
        result.joints.emplace_back(flat[i], flat[i + 1], flat[i + 2], flat[i + 3]);
      }
      const std::string weightName = fmt::format("WEIGHTS_{}", set);
      result.weights = readAs<glm::vec4>(weightName, 4, kFloat | kUnsignedNormalized);
      if (result.weights.empty()) document_.fail(pointer_, fmt::format("{} beside {}", weightName, name));
    }
  }

  Document& document_;
  const Accessors& accessors_;
  const Json& attributes_;
  std::string pointer_;
  uint64_t count_ = 0;
  Attributes result_;
};

} // namespace

void requireFormat(const Document& document, const Accessors& accessors, uint32_t accessor, uint32_t components,
                   uint32_t kinds, const std::string& pointer) {
  const AccessorLayout& layout = accessors.layout(accessor);
  if (layout.componentCount != components || (numberKind(layout) & kinds) == 0) {
    document.fail(pointer,
                  fmt::format("an accessor of another type, {} has {} components of type {}{} "
                              "(MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_INVALID_FORMAT)",
                              accessorPointer(accessor), layout.componentCount,
                              static_cast<uint32_t>(layout.componentType), layout.normalized ? ", normalized" : ""));
  }
}

Attributes readAttributes(Document& document, const Accessors& accessors, const Json& primitive,
                          const std::string& pointer) {
  return AttributeReader(document, accessors, primitive.at("attributes"), pointer + "/attributes").read();
}

MorphTarget readMorphTarget(const Document& document, const Accessors& accessors, const Json& target,
                            size_t vertexCount, const std::string& pointer) {
  const auto read = [&](const char* name, uint32_t kinds) {
    const std::optional<uint32_t> accessor = indexOf(target, name);
    if (!accessor) return std::vector<glm::vec3>{};
    requireFormat(document, accessors, *accessor, 3, kinds, fmt::format("{}/{}", pointer, name));
    std::vector<glm::vec3> result = accessors.readFloats<glm::vec3>(*accessor);
    if (result.size() != vertexCount) {
      document.fail(fmt::format("{}/{}", pointer, name),
                    fmt::format("{} elements (MESH_PRIMITIVE_MORPH_TARGET_INVALID_ATTRIBUTE_COUNT)", vertexCount));
    }
    return result;
  };
  return {.positions = read("POSITION", kFloat | kAnySmallInteger),
          .normals = read("NORMAL", kFloat | kSignedNormalized),
          .tangents = read("TANGENT", kFloat | kSignedNormalized)};
}

} // namespace isophote::gltf
