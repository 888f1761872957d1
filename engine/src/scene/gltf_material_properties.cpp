// Source: Khronos glTF 2.0.1 specification, section 3.9, and KHR_texture_transform.
#include "scene/gltf_material_properties.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>

#include <fmt/format.h>

namespace isophote::gltf {
namespace {

/// translation * rotation * scale; v points down, so a counter-clockwise rotation of uv reads (cos, sin; -sin, cos).
/// This is the sense in which the extension's own example picks the lower left quarter of the image.
void setTransform(const Json& transform, TextureRef& result) {
  const auto pair = [&](const char* name, double fallback) {
    const Json* value = member(transform, name);
    return value ? glm::dvec2((*value)[0].get<double>(), (*value)[1].get<double>()) : glm::dvec2(fallback);
  };
  const glm::dvec2 offset = pair("offset", 0);
  const glm::dvec2 scale = pair("scale", 1);
  const double angle = numberOr(transform, "rotation", 0);
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  result.uRow = glm::vec3(glm::dvec3(c * scale.x, s * scale.y, offset.x));
  result.vRow = glm::vec3(glm::dvec3(-s * scale.x, c * scale.y, offset.y));
}

} // namespace

float MaterialProperties::clamped(const Json& value, const char* name, float lower, float upper) {
  const float number = value.get<float>();
  if (number < lower || number > upper) {
    const std::string range =
        upper == FLT_MAX ? fmt::format("at least {}", lower) : fmt::format("in [{}, {}]", lower, upper);
    document_.warnings.add(fmt::format("{} is clamped, it has to be {}", name, range), pointer_);
  }
  return std::clamp(number, lower, upper);
}

float MaterialProperties::factor(const Json& object, const char* name, float fallback, float lower, float upper) {
  const Json* value = member(object, name);
  return value ? clamped(*value, name, lower, upper) : fallback;
}

glm::vec3 MaterialProperties::color(const Json& object, const char* name, glm::vec3 fallback, float upper) {
  const Json* value = member(object, name);
  if (!value) return fallback;
  return {clamped((*value)[0], name, 0, upper), clamped((*value)[1], name, 0, upper),
          clamped((*value)[2], name, 0, upper)};
}

TextureRef MaterialProperties::texture(const Json& object, const char* name) {
  TextureRef result;
  const Json* info = member(object, name);
  if (!info) return result;
  result.texture = static_cast<int32_t>(*indexOf(*info, "index"));
  result.scale = static_cast<float>(numberOr(*info, "scale", 1));
  uint64_t uvSet = integerOr(*info, "texCoord", 0);
  if (const Json* transform = extension(*info, "KHR_texture_transform")) {
    uvSet = integerOr(*transform, "texCoord", uvSet);
    setTransform(*transform, result);
  }
  if (uvSet >= kMaxUvSets) {
    document_.warnings.add(fmt::format("a texture on a UV set above {} is left out", kMaxUvSets - 1), pointer_);
    return {};
  }
  result.uvSet = static_cast<uint32_t>(uvSet);
  return result;
}

} // namespace isophote::gltf
