// Source: Khronos glTF 2.0.1 specification, section 3.10 "Cameras", and KHR_lights_punctual.
#include "scene/gltf_cameras_lights.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>
#include <glm/gtc/constants.hpp>

namespace isophote::gltf {
namespace {

/// Intensity above this is cut, so that its square is still finite in 32-bit floats.
constexpr float kMaxIntensity = 1e18f;
/// A light whose size would make its radiance larger stays without one.
constexpr double kMaxRadiance = 1e30;
constexpr double kMaxRadius = 1e15; // world units

void requireThat(const Document& document, bool holds, const std::string& pointer, const char* expected) {
  if (!holds) document.fail(pointer, expected);
}

void readClipping(const Document& document, const Json& json, const std::string& pointer, Camera& camera) {
  camera.znear = numberOr(json, "znear", 0);
  camera.zfar = numberOr(json, "zfar", 0);
  if (json.contains("zfar"))
    requireThat(document, camera.zfar > camera.znear, pointer + "/zfar", "a value above znear");
}

void readPerspective(const Document& document, const Json& json, const std::string& pointer, Camera& camera) {
  camera.kind = CameraKind::Perspective;
  camera.yfov = numberOr(json, "yfov", 0);
  requireThat(document, camera.yfov > 0 && camera.yfov < glm::pi<double>(), pointer + "/yfov",
              "an angle between 0 and pi");
  if (json.contains("aspectRatio")) {
    camera.aspectRatio = numberOr(json, "aspectRatio", 1);
    requireThat(document, *camera.aspectRatio > 0, pointer + "/aspectRatio", "a value above 0");
  }
  readClipping(document, json, pointer, camera);
  requireThat(document, camera.znear > 0, pointer + "/znear", "a value above 0");
}

void readOrthographic(Document& document, const Json& json, const std::string& pointer, Camera& camera) {
  camera.kind = CameraKind::Orthographic;
  for (const auto& [name, value] : {std::pair{"xmag", &camera.xmag}, std::pair{"ymag", &camera.ymag}}) {
    *value = numberOr(json, name, 0);
    requireThat(document, *value != 0, fmt::format("{}/{}", pointer, name), "a value other than 0"); // exact
    if (*value < 0) document.warnings.add("a negative magnification counts as positive", pointer);
    *value = std::abs(*value);
  }
  readClipping(document, json, pointer, camera);
  requireThat(document, camera.znear >= 0, pointer + "/znear", "a value of at least 0");
}

// What glTF has no words for; docs/cameras.md.
void readCameraExtras(Document& document, const Json& json, const std::string& pointer, Camera& camera) {
  const auto atLeastZero = [&](const char* name) {
    const double value = extraNumber(json, name).value_or(0);
    if (value < 0) document.warnings.add(fmt::format("a camera's {} below 0 counts as 0", name), pointer);
    return std::max(value, 0.0);
  };
  camera.lensRadius = std::min(atLeastZero("lensRadius"), kMaxRadius);
  camera.focusDistance = std::min(atLeastZero("focusDistance"), kMaxRadius);
  camera.apertureBlades = static_cast<uint32_t>(std::min(atLeastZero("apertureBlades"), double{kMaxApertureBlades}));
  camera.apertureRotation = std::remainder(extraNumber(json, "apertureRotation").value_or(0), glm::two_pi<double>());
  if (camera.lensRadius > 0 && !(camera.focusDistance > 0)) {
    document.warnings.add("a camera with a lensRadius but no focusDistance stays a pinhole", pointer);
    camera.lensRadius = 0;
  }
  const Json* extras = member(json, "extras");
  if (extras == nullptr || !extras->is_object() || extras->value("projection", Json()) != "panorama") return;
  camera.kind = CameraKind::Panorama;
  camera.aspectRatio = 2;
}

class LightReader {
public:
  LightReader(Document& document, const Json& json, std::string pointer)
      : document_(document), json_(json), pointer_(std::move(pointer)) {}

  PunctualLight read() {
    PunctualLight light;
    light.name = stringOr(json_, "name", "");
    readKind(light);
    const float intensity = clamped(json_, "intensity", 1, 0, kMaxIntensity);
    light.intensity = color() * intensity;
    readRange(light);
    if (light.kind == LightKind::Spot) readCone(light);
    readRadius(light);
    return light;
  }

private:
  void readKind(PunctualLight& light) {
    const std::string type = stringOr(json_, "type", "");
    if (type == "point") {
      light.kind = LightKind::Point;
    } else if (type == "spot") {
      light.kind = LightKind::Spot;
    } else if (type == "directional") {
      light.kind = LightKind::Directional;
    } else {
      document_.fail(pointer_ + "/type", "point, spot or directional");
    }
  }

  glm::vec3 color() {
    glm::vec3 result(1);
    const Json* values = member(json_, "color");
    if (!values) return result;
    for (int i = 0; i < 3; ++i) result[i] = (*values)[static_cast<size_t>(i)].get<float>();
    const glm::vec3 inRange = glm::clamp(result, 0.0f, 1.0f);
    if (inRange != result) document_.warnings.add("a light's color is clamped to [0, 1]", pointer_);
    return inRange;
  }

  void readRange(PunctualLight& light) {
    if (!json_.contains("range")) return;
    light.range = static_cast<float>(numberOr(json_, "range", 0));
    if (light.range > 0) return;
    document_.warnings.add("a light's range of 0 or less counts as unlimited", pointer_);
    light.range = 0;
  }

  void readCone(PunctualLight& light) {
    const Json* spot = member(json_, "spot");
    if (!spot) {
      document_.warnings.add("a spot light without \"spot\" gets the default cone", pointer_);
      return;
    }
    constexpr float kNarrowest = 1e-4f; // radians; a cone of 0 would light nothing
    light.outerConeAngle = clamped(*spot, "outerConeAngle", light.outerConeAngle, kNarrowest, glm::half_pi<float>());
    // The inner angle has to be smaller; the falloff between them divides by the difference of their cosines.
    light.innerConeAngle = clamped(*spot, "innerConeAngle", 0, 0, std::nextafter(light.outerConeAngle, 0.0f));
  }

  void readRadius(PunctualLight& light) {
    const std::optional<double> radius = extraNumber(json_, "radius");
    if (!radius) return;
    const bool sun = light.kind == LightKind::Directional;
    light.radius = clamped("radius", *radius, 0, sun ? glm::half_pi<float>() : static_cast<float>(kMaxRadius));
    const double extent = sun ? std::sin(double{light.radius}) : double{light.radius};
    const glm::vec3 intensity = light.intensity;
    const double brightest = std::max(intensity.x, std::max(intensity.y, intensity.z));
    if (light.radius > 0 && !(brightest <= kMaxRadiance * extent * extent)) {
      document_.warnings.add("a light's radius too small for its intensity counts as 0", pointer_);
      light.radius = 0;
    }
  }

  float clamped(const Json& object, const char* name, float fallback, float lower, float upper) {
    return clamped(name, numberOr(object, name, fallback), lower, upper);
  }

  float clamped(const char* name, double given, float lower, float upper) {
    const float value = static_cast<float>(given);
    if (value < lower || value > upper) {
      document_.warnings.add(fmt::format("a light's {} is clamped to [{}, {}]", name, lower, upper), pointer_);
    }
    return std::clamp(value, lower, upper);
  }

  Document& document_;
  const Json& json_;
  std::string pointer_;
};

} // namespace

std::vector<Camera> readCameras(Document& document) {
  const Json& cameras = arrayOrEmpty(document.root, "cameras");
  std::vector<Camera> result;
  for (size_t i = 0; i < cameras.size(); ++i) {
    const std::string pointer = fmt::format("/cameras/{}", i);
    const std::string type = cameras[i].at("type").get<std::string>();
    if (type != "perspective" && type != "orthographic") {
      document.fail(pointer + "/type", "perspective or orthographic");
    }
    const Json* projection = member(cameras[i], type.c_str());
    if (!projection) document.fail(pointer, fmt::format("a member \"{}\"", type));
    Camera camera;
    camera.name = stringOr(cameras[i], "name", "");
    const std::string inner = fmt::format("{}/{}", pointer, type);
    if (type == "perspective") {
      readPerspective(document, *projection, inner, camera);
    } else {
      readOrthographic(document, *projection, inner, camera);
    }
    readCameraExtras(document, cameras[i], pointer, camera);
    result.push_back(std::move(camera));
  }
  return result;
}

Camera placed(const Camera& camera, const glm::dmat4& worldFromNode) {
  Camera result = camera;
  const auto unitOr = [](glm::dvec3 v, glm::dvec3 fallback) {
    const double length = glm::length(v);
    return length > 0 ? v / length : fallback;
  };
  const glm::dvec3 back = unitOr(glm::dvec3(worldFromNode[2]), {0, 0, 1});
  const glm::dvec3 anyUp = std::abs(back.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
  const glm::dvec3 y(worldFromNode[1]);
  const glm::dvec3 fallbackUp = glm::normalize(anyUp - back * glm::dot(anyUp, back));
  const glm::dvec3 up = unitOr(y - back * glm::dot(y, back), fallbackUp);
  result.worldFromCamera = glm::dmat4(glm::dvec4(glm::cross(up, back), 0), glm::dvec4(up, 0), glm::dvec4(back, 0),
                                      glm::dvec4(glm::dvec3(worldFromNode[3]), 1));
  return result;
}

std::vector<PunctualLight> readLights(Document& document) {
  std::vector<PunctualLight> result;
  const Json* lights = extension(document.root, "KHR_lights_punctual");
  if (!lights) return result;
  const Json& list = arrayOrEmpty(*lights, "lights");
  for (size_t i = 0; i < list.size(); ++i) {
    result.push_back(
        LightReader(document, list[i], fmt::format("/extensions/KHR_lights_punctual/lights/{}", i)).read());
  }
  return result;
}

std::optional<PunctualLight> placed(const PunctualLight& light, const glm::dmat4& worldFromNode) {
  PunctualLight result = light;
  const glm::dvec3 forward = -glm::dvec3(worldFromNode[2]);
  const double length = glm::length(forward);
  if (!(length > 0) && light.kind != LightKind::Point) return std::nullopt;
  if (length > 0) result.direction = forward / length;
  result.position = glm::dvec3(worldFromNode[3]);
  return result;
}

} // namespace isophote::gltf
