#include "scene_source.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "isophote/error.hpp"
#include "isophote/features.hpp"
#include "isophote/gltf.hpp"
#include "parse.hpp"
#include "scene_files.hpp"

namespace isophote::cli {
namespace {

constexpr uint32_t kDefaultWidth = 1280;
constexpr double kDefaultAspectRatio = 16.0 / 9;
constexpr double kLargestSide = 65535;

void setEnvironment(Scene& scene, const EnvironmentOptions& options) {
  if (!options.file.empty()) scene.environment = loadEnvironment(options.file, scene.warnings);
  if (options.color) scene.environment = Environment{.width = 1, .height = 1, .pixels = {*options.color}};
  if (!options.intensity && !options.rotationDegrees) return;
  if (!scene.environment)
    throw UsageError("--env-intensity and --env-rotation need an environment: --env or --env-color");
  if (options.intensity) scene.environment->intensity = static_cast<float>(*options.intensity);
  if (options.rotationDegrees) scene.environment->rotation = *options.rotationDegrees * std::numbers::pi / 180;
}

double aspectRatio(const Camera& camera) {
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

const Camera& findCamera(const Scene& scene, const std::string& name) {
  const auto named = std::find_if(scene.cameras.begin(), scene.cameras.end(),
                                  [&](const Camera& camera) { return !name.empty() && camera.name == name; });
  if (named != scene.cameras.end()) return *named;
  for (size_t i = 0; i < scene.cameras.size(); ++i) {
    if (name == std::to_string(i)) return scene.cameras[i];
  }
  throw UsageError(fmt::format("--camera: no camera '{}'; {}", name, cameraList(scene)));
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
  addValue(
      command, "--env-color", "R,G,B", [&options](const std::string& text) { options.color = parseColor(text); },
      "Constant environment radiance, linear Rec.709")
      ->excludes(file)
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

View chooseView(const Scene& scene, const std::optional<std::string>& name, std::optional<uint32_t> width,
                std::optional<uint32_t> height) {
  View view;
  view.framing = scene.cameras.empty() && !name;
  if (!view.framing) view.camera = name ? findCamera(scene, *name) : scene.cameras.front();
  const double aspect = view.framing ? kDefaultAspectRatio : aspectRatio(view.camera);
  view.width = width.value_or(height ? toSide(*height * aspect) : kDefaultWidth);
  view.height = height.value_or(toSide(view.width / aspect));
  if (view.framing) view.camera = framingCamera(scene, double(view.width) / view.height);
  return view;
}

} // namespace isophote::cli
