// A scene from the command line: the asset, an environment around it, a camera and the image's size.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "isophote/scene.hpp"

namespace isophote::cli {

struct EnvironmentOptions {
  std::string file;
  std::optional<glm::vec3> color;
  std::optional<double> intensity;
  std::optional<double> rotationDegrees;
};

/// --env, --env-color, --env-intensity, --env-rotation
void addEnvironmentFlags(CLI::App& command, EnvironmentOptions& options);

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
  bool framing = false; ///< the asset has no camera
};

/// The camera called or numbered `name`, else the first, else one that frames the scene. A size not given follows from
/// the other and from the camera's aspect ratio; neither given: 1280 wide.
/// @throws UsageError naming the cameras there are, LimitError
[[nodiscard]] View chooseView(const Scene& scene, const std::optional<std::string>& name, std::optional<uint32_t> width,
                              std::optional<uint32_t> height);

} // namespace isophote::cli
