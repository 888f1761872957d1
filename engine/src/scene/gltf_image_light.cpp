// Source: Khronos EXT_lights_image_based; face orientations of the OpenGL 4.6 core specification, table 8.19.
#include "scene/gltf_image_light.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>

namespace isophote::gltf {
namespace {

constexpr const char* kExtension = "EXT_lights_image_based";
constexpr uint32_t kLargestWidth = 4096;
constexpr uint32_t kLookups = 4; // across a texel
constexpr float kMaxIntensity = 1e18f;

/// Linear radiance of one face, row 0 at the top.
struct Face {
  uint32_t size = 0;
  std::vector<glm::vec3> texels;
};

double linearFromSrgb(double value) {
  return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

/// sRGB over alpha; `undefined` counts texels of alpha 0, which become black.
Face decodeFace(const ImageData& image, uint64_t& undefined) {
  Face face{image.width, {}};
  const size_t channelBytes = image.bitsPerChannel / 8;
  const double largest = channelBytes == 2 ? 65535.0 : 255.0;
  const auto channel = [&](size_t index) {
    const size_t at = index * channelBytes;
    uint32_t value = std::to_integer<uint32_t>(image.pixels[at]);
    if (channelBytes == 2) value |= std::to_integer<uint32_t>(image.pixels[at + 1]) << 8;
    return value / largest;
  };
  const size_t count = size_t{image.width} * image.height;
  face.texels.reserve(count);
  for (size_t i = 0; i < count; ++i) {
    const double alpha = channel(4 * i + 3);
    undefined += alpha == 0;
    const double scale = alpha > 0 ? 1 / alpha : 0;
    glm::dvec3 color;
    for (int c = 0; c < 3; ++c) color[c] = scale * linearFromSrgb(channel(4 * i + static_cast<size_t>(c)));
    face.texels.emplace_back(color);
  }
  return face;
}

/// Bilinear, clamped to the face. @param u, v  in [0, 1], v down
glm::dvec3 lookUp(const Face& face, double u, double v) {
  const double last = face.size - 1.0;
  const double x = std::clamp(u * face.size - 0.5, 0.0, last);
  const double y = std::clamp(v * face.size - 0.5, 0.0, last);
  const auto x0 = static_cast<size_t>(x), y0 = static_cast<size_t>(y);
  const size_t x1 = std::min<size_t>(x0 + 1, face.size - 1), y1 = std::min<size_t>(y0 + 1, face.size - 1);
  const auto at = [&](size_t column, size_t row) { return glm::dvec3(face.texels[row * face.size + column]); };
  const double s = x - static_cast<double>(x0), t = y - static_cast<double>(y0);
  return glm::mix(glm::mix(at(x0, y0), at(x1, y0), s), glm::mix(at(x0, y1), at(x1, y1), s), t);
}

/// Radiance from `d`. Faces are stored as a viewer inside sees them: mirrored against OpenGL's, as the extension says.
glm::dvec3 cubeRadiance(const std::array<Face, 6>& faces, const glm::dvec3& d) {
  const glm::dvec3 size = glm::abs(d);
  size_t face = 0;
  double major = 0, s = 0, t = 0;
  if (size.x >= size.y && size.x >= size.z) {
    face = d.x > 0 ? 0 : 1;
    major = size.x;
    s = d.x > 0 ? -d.z : d.z;
    t = -d.y;
  } else if (size.y >= size.z) {
    face = d.y > 0 ? 2 : 3;
    major = size.y;
    s = d.x;
    t = d.y > 0 ? d.z : -d.z;
  } else {
    face = d.z > 0 ? 4 : 5;
    major = size.z;
    s = d.z > 0 ? d.x : -d.x;
    t = -d.y;
  }
  return lookUp(faces[face], 0.5 - 0.5 * s / major, 0.5 + 0.5 * t / major);
}

Environment equirectangular(const std::array<Face, 6>& faces, const glm::dquat& worldFromMap) {
  Environment map;
  map.width = std::min(4 * faces[0].size, kLargestWidth);
  map.height = map.width / 2;
  map.pixels.reserve(size_t{map.width} * map.height);
  const glm::dmat3 mapFromWorld = glm::transpose(glm::mat3_cast(worldFromMap));
  for (uint32_t row = 0; row < map.height; ++row) {
    const double cosTop = std::cos(glm::pi<double>() * row / map.height);
    const double cosBottom = std::cos(glm::pi<double>() * (row + 1) / map.height);
    for (uint32_t column = 0; column < map.width; ++column) {
      glm::dvec3 sum(0);
      for (uint32_t k = 0; k < kLookups * kLookups; ++k) {
        const double y = glm::mix(cosTop, cosBottom, (k / kLookups + 0.5) / kLookups);
        const double phi = 2 * glm::pi<double>() * ((column + (k % kLookups + 0.5) / kLookups) / map.width - 0.5);
        const double r = std::sqrt(std::max(1 - y * y, 0.0));
        sum += cubeRadiance(faces, mapFromWorld * glm::dvec3(r * std::sin(phi), y, -r * std::cos(phi)));
      }
      map.pixels.emplace_back(sum / static_cast<double>(kLookups * kLookups));
    }
  }
  return map;
}

glm::dquat readRotation(const Document& document, const Json& light, const std::string& pointer) {
  const Json* values = member(light, "rotation");
  if (!values) return {1, 0, 0, 0};
  const auto at = [&](size_t i) { return (*values)[i].get<double>(); };
  const glm::dquat rotation(at(3), at(0), at(1), at(2)); // w first; glTF has it last
  const double length = glm::length(rotation);
  if (!(length > 0)) document.fail(pointer + "/rotation", "a unit quaternion");
  return rotation / length;
}

std::array<Face, 6> readFaces(Document& document, Textures& textures, const Json& light, const std::string& pointer) {
  const Json& indices = light.at("specularImages")[0];
  std::array<Face, 6> faces;
  uint64_t undefined = 0;
  for (size_t i = 0; i < faces.size(); ++i) {
    const std::string facePointer = fmt::format("{}/specularImages/0/{}", pointer, i);
    const ImageData image = textures.decode(indices[i].get<uint32_t>());
    if (image.width != image.height) document.fail(facePointer, "a square image");
    faces[i] = decodeFace(image, undefined);
    if (faces[i].size != faces[0].size) document.fail(facePointer, "an image of the size of the other faces");
  }
  if (undefined > 0) {
    document.warnings.add(fmt::format("{} texels of an image-based light have alpha 0 and count as black", undefined),
                          pointer);
  }
  if (integerOr(light, "specularImageSize", 0) != faces[0].size) {
    document.warnings.add("specularImageSize is not the size of the images, which counts", pointer);
  }
  return faces;
}

} // namespace

std::optional<Environment> readImageLight(Document& document, Textures& textures) {
  const Json& scenes = arrayOrEmpty(document.root, "scenes");
  if (scenes.empty()) return std::nullopt;
  const uint32_t scene = document.options.scene.value_or(indexOf(document.root, "scene").value_or(0));
  const Json* reference = extension(scenes[scene], kExtension);
  if (!reference) return std::nullopt;
  const uint32_t index = *indexOf(*reference, "light");
  const Json& light = extension(document.root, kExtension)->at("lights")[index];
  const std::string pointer = fmt::format("/extensions/{}/lights/{}", kExtension, index);
  const auto intensity = static_cast<float>(numberOr(light, "intensity", 1));
  if (!(intensity >= 0 && intensity <= kMaxIntensity))
    document.warnings.add(fmt::format("a light's intensity is clamped to [0, {}]", kMaxIntensity), pointer);
  Environment environment =
      equirectangular(readFaces(document, textures, light, pointer), readRotation(document, light, pointer));
  environment.intensity = std::clamp(intensity, 0.0f, kMaxIntensity);
  return environment;
}

} // namespace isophote::gltf
