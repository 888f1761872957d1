#include "input/scene_source.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "input/scene_files.hpp"
#include "isophote/error.hpp"
#include "isophote/features.hpp"
#include "isophote/gltf.hpp"
#include "parse.hpp"

namespace isophote::cli {
namespace {

constexpr uint32_t kDefaultWidth = 1280;
constexpr double kDefaultAspectRatio = 16.0 / 9;
constexpr double kLargestSide = 65535;
constexpr double kLargestLength = 1e15; // scene units

// The sun is one of the scene's lights; a factor on the environment is one on both.
void setSky(Scene& scene, const EnvironmentOptions& options) {
  Sky sky = makeSky(*options.sky);
  sky.sun.intensity *= static_cast<float>(options.intensity.value_or(1));
  scene.environment = std::move(sky.environment);
  scene.lights.push_back(std::move(sky.sun));
}

void setEnvironment(Scene& scene, const EnvironmentOptions& options) {
  if (!options.file.empty()) scene.environment = loadEnvironment(options.file, scene.warnings);
  if (options.color) scene.environment = Environment{.width = 1, .height = 1, .pixels = {*options.color}};
  if (options.sky) setSky(scene, options);
  if (!options.intensity && !options.rotationDegrees) return;
  if (!scene.environment)
    throw UsageError("--env-intensity and --env-rotation need an environment: --env, --env-color or --sky");
  if (options.intensity) scene.environment->intensity = static_cast<float>(*options.intensity);
  if (options.rotationDegrees) scene.environment->rotation = *options.rotationDegrees * std::numbers::pi / 180;
}

double aspectRatio(const Camera& camera) {
  if (camera.kind == CameraKind::Panorama) return 2;
  if (camera.kind == CameraKind::Orthographic) return camera.xmag / camera.ymag;
  return camera.aspectRatio.value_or(kDefaultAspectRatio);
}

std::string cameraList(const Scene& scene) {
  if (scene.cameras.empty()) return "the asset has none";
  std::string text = "there are";
  for (size_t i = 0; i < scene.cameras.size(); ++i) {
    text += fmt::format("{} {} '{}'", i == 0 ? "" : ",", i, scene.cameras[i].name);
  }
  return text;
}

size_t findCamera(const Scene& scene, const CameraOptions& options) {
  if (options.index && *options.index < scene.cameras.size()) return *options.index;
  const std::string name = options.index ? std::to_string(*options.index) : options.name.value_or("0");
  const auto named = std::find_if(scene.cameras.begin(), scene.cameras.end(),
                                  [&](const Camera& camera) { return !name.empty() && camera.name == name; });
  if (named != scene.cameras.end() && options.name) return static_cast<size_t>(named - scene.cameras.begin());
  for (size_t i = 0; i < scene.cameras.size(); ++i) {
    if (name == std::to_string(i)) return i;
  }
  throw UsageError(fmt::format("--camera: no camera '{}'; {}", name, cameraList(scene)));
}

void change(Camera& camera, const CameraOptions& options) {
  if (options.lensRadius) camera.lensRadius = *options.lensRadius;
  if (options.focusDistance) camera.focusDistance = *options.focusDistance;
  if (options.apertureBlades) camera.apertureBlades = *options.apertureBlades;
  if (options.panorama) camera.kind = CameraKind::Panorama;
  if (camera.lensRadius > 0 && !(camera.focusDistance > 0))
    throw UsageError("--lens-radius needs a distance to focus at: --focus-distance");
}

uint32_t toSide(double pixels) {
  const double side = std::max(1.0, std::round(pixels));
  if (!(side <= kLargestSide)) {
    throw LimitError(fmt::format("the camera's aspect ratio asks for {:.0f} pixels on one side; the limit is {:.0f}",
                                 side, kLargestSide));
  }
  return static_cast<uint32_t>(side);
}

} // namespace

void addEnvironmentFlags(CLI::App& command, EnvironmentOptions& options) {
  constexpr const char* kGroup = "Environment";
  CLI::Option* file = command.add_option("--env", options.file, "Equirectangular environment map, .hdr or .exr")
                          ->type_name("FILE")
                          ->group(kGroup);
  CLI::Option* color =
      addValue(
          command, "--env-color", "R,G,B", [&options](const std::string& text) { options.color = parseColor(text); },
          "Constant environment radiance, linear Rec.709")
          ->excludes(file)
          ->group(kGroup);
  CLI::Option* sky =
      addValue(
          command, "--sky", "ELEVATION[,AZIMUTH[,TURBIDITY]]",
          [&options](const std::string& text) { options.sky = parseSky(text); },
          "Clear sky and sun in cd/m^2 and lux: degrees above the horizon, degrees from -z towards +x (0), haze from "
          "2 to 10 (3)")
          ->excludes(file)
          ->excludes(color)
          ->group(kGroup);
  addValue(
      command, "--env-intensity", "X",
      [&options](const std::string& text) { options.intensity = parseNumber(text, 0, 1e30); },
      "Factor on the environment's radiance (1)")
      ->group(kGroup);
  addValue(
      command, "--env-rotation", "DEGREES",
      [&options](const std::string& text) { options.rotationDegrees = parseNumber(text, -1e6, 1e6); },
      "Turns the environment about the vertical axis (0)")
      ->excludes(sky)
      ->group(kGroup);
}

void addCameraFlags(CLI::App& command, CameraOptions& options) {
  constexpr const char* kGroup = "Camera";
  addValue(
      command, "--camera", "NAME|INDEX", [&options](const std::string& text) { options.name = text; },
      "Camera of the asset (the first; one that frames the scene where there is none)")
      ->group(kGroup);
  addValue(
      command, "--lens-radius", "R",
      [&options](const std::string& text) { options.lensRadius = parseNumber(text, 0, kLargestLength); },
      "Thin lens of this radius in scene units: depth of field (0: a pinhole)")
      ->group(kGroup);
  addValue(
      command, "--focus-distance", "D",
      [&options](const std::string& text) { options.focusDistance = parseNumber(text, 1e-9, kLargestLength); },
      "Distance of the plane in focus, along the view axis")
      ->group(kGroup);
  addValue(
      command, "--aperture-blades", "N",
      [&options](const std::string& text) {
        options.apertureBlades = static_cast<uint32_t>(parseUnsigned(text, 0, kMaxApertureBlades));
      },
      "Straight blades, so that highlights out of focus are polygons (below 3: round)")
      ->group(kGroup);
  command.add_flag("--panorama", options.panorama, "All directions, equirectangular; width twice the height")
      ->group(kGroup);
}

void addVariantFlag(CLI::App& command, std::optional<std::string>& variant) {
  command.add_option("--variant", variant, "Materials of the asset's variant of this name (its default materials)")
      ->type_name("NAME");
}

LoadedScene loadScene(const std::string& file, const EnvironmentOptions& environment,
                      const std::optional<std::string>& variant) {
  LoadedScene loaded;
  loaded.scene = loadGltf(file, {.variant = variant});
  loaded.files = sceneFiles(file);
  setEnvironment(loaded.scene, environment);
  if (!environment.file.empty()) loaded.files.emplace_back(environment.file);
  return loaded;
}

bool hasLight(const Scene& scene) {
  const auto shines = [](glm::vec3 color) { return color != glm::vec3(0); };
  const auto& lights = scene.lights;
  if (std::any_of(lights.begin(), lights.end(), [&](const PunctualLight& light) { return shines(light.intensity); }))
    return true;
  if (scene.environment && scene.environment->intensity > 0) {
    const auto& pixels = scene.environment->pixels;
    if (std::any_of(pixels.begin(), pixels.end(), shines)) return true;
  }
  const FeatureSet features = sceneFeatures(scene);
  return features.has(Feature::kHasEmissiveTriangles) || features.has(Feature::kHasUnlit);
}

View chooseView(const Scene& scene, const CameraOptions& camera, std::optional<uint32_t> width,
                std::optional<uint32_t> height) {
  View view;
  view.framing = scene.cameras.empty() && !camera.name && !camera.index;
  if (!view.framing) {
    view.cameraIndex = findCamera(scene, camera);
    view.camera = scene.cameras[view.cameraIndex];
  }
  change(view.camera, camera);
  const double aspect = aspectRatio(view.camera);
  view.width = width.value_or(height ? toSide(*height * aspect) : kDefaultWidth);
  view.height = height.value_or(toSide(view.width / aspect));
  if (view.framing) {
    view.camera = framingCamera(scene, double(view.width) / view.height);
    change(view.camera, camera);
  }
  return view;
}

} // namespace isophote::cli
