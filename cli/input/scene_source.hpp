// A scene from the command line: the asset, an environment around it, a camera and the image's size.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "isophote/scene.hpp"
#include "isophote/sky.hpp"

namespace isophote::cli {

struct EnvironmentOptions {
  std::string file;
  std::optional<glm::vec3> color;
  std::optional<SkyOptions> sky;
  std::optional<double> intensity;
  std::optional<double> rotationDegrees;
};

/// --env, --env-color, --sky, --env-intensity, --env-rotation
void addEnvironmentFlags(CLI::App& command, EnvironmentOptions& options);

/// What replaces the chosen camera's own values.
struct CameraOptions {
  std::optional<std::string> name; ///< or index
  std::optional<size_t> index;     ///< in place of the name
  std::optional<double> lensRadius;
  std::optional<double> focusDistance;
  std::optional<uint32_t> apertureBlades;
  bool panorama = false;
};

/// --camera, --lens-radius, --focus-distance, --aperture-blades, --panorama
void addCameraFlags(CLI::App& command, CameraOptions& options);

/// --variant
void addVariantFlag(CLI::App& command, std::optional<std::string>& variant);

struct LoadedScene {
  Scene scene;
  std::vector<std::filesystem::path> files; ///< all inputs, the asset first
};

/// @throws SceneError, UnsupportedError, LimitError, UsageError
[[nodiscard]] LoadedScene loadScene(const std::string& file, const EnvironmentOptions& environment,
                                    const std::optional<std::string>& variant = std::nullopt);

/// Whether anything in the scene gives light.
[[nodiscard]] bool hasLight(const Scene& scene);

struct View {
  Camera camera;
  uint32_t width = 0;
  uint32_t height = 0;
  bool framing = false;   ///< the asset has no camera
  size_t cameraIndex = 0; ///< of the asset's cameras, where it has any
};

/// The camera called or numbered as `camera` says, else the first, else one that frames the scene. A size not given
/// follows from the other and from the camera's aspect ratio; neither given: 1280 wide.
/// @throws UsageError naming the cameras there are, or for a lens without a distance to focus at; LimitError
[[nodiscard]] View chooseView(const Scene& scene, const CameraOptions& camera, std::optional<uint32_t> width,
                              std::optional<uint32_t> height);

} // namespace isophote::cli
