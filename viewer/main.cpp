// isophote-viewer: look around in a glTF scene while it is path traced.
#include <cctype>
#include <cstdio>
#include <exception>
#include <optional>

#include "isophote/error.hpp"
#include "isophote/gltf.hpp"
#include "viewer/interactive.hpp"
#include "viewer/live_render.hpp"
#include "viewer/options.hpp"

namespace isophote::viewer {
namespace {

Scene loadScene(const Options& options) {
  Scene scene = loadGltf(options.scene, {.variant = options.variant});
  if (!options.environment.empty()) scene.environment = loadEnvironment(options.environment, scene.warnings);
  for (const std::string& warning : scene.warnings) std::fprintf(stderr, "isophote-viewer: %s\n", warning.c_str());
  return scene;
}

Camera chooseCamera(const Options& options, const Scene& scene) {
  const double aspectRatio = static_cast<double>(options.width) / options.height;
  if (options.camera.empty()) return scene.cameras.empty() ? framingCamera(scene, aspectRatio) : scene.cameras.front();
  for (size_t i = 0; i < scene.cameras.size(); ++i) {
    if (scene.cameras[i].name == options.camera || std::to_string(i) == options.camera) return scene.cameras[i];
  }
  throw UsageError(options.scene + ": no camera '" + options.camera + "'");
}

void runHeadless(const Options& options, const Device& device, const GpuScene& gpuScene, Camera camera) {
  camera.aspectRatio.reset();
  LiveRender render(device, gpuScene, options.width, options.height, {});
  render.start(camera);
  for (uint32_t frame = 0; frame < options.headlessFrames; ++frame) render.step();
  if (options.screenshot.empty()) return;
  writePng(options.screenshot, render.shown().resolve(), options.exposure, options.toneMap);
}

int run(const Options& options) {
  const Scene scene = loadScene(options);
  const Camera camera = chooseCamera(options, scene);
  if (!options.screenshot.empty()) checkWritable(options.screenshot);

  std::optional<Window> window;
  InstanceOptions instanceOptions{.validation = options.validation};
  if (options.headlessFrames == 0) {
    window.emplace(static_cast<int>(options.width), static_cast<int>(options.height), "Isophote: " + scene.name);
    instanceOptions.extensions = surfaceExtensions();
  }
  const VulkanInstance instance(instanceOptions);
  {
    const Device device(instance, {.selector = options.device, .present = window.has_value()});
    const GpuScene gpuScene(device, scene);
    if (window) {
      runWindow(options, device, *window, gpuScene, scene, camera);
    } else {
      runHeadless(options, device, gpuScene, camera);
    }
  }
  const std::vector<std::string> messages = instance.validationMessages();
  for (const std::string& message : messages) std::fprintf(stderr, "isophote-viewer: %s\n", message.c_str());
  return messages.empty() ? 0 : 1;
}

int report(const std::exception& error, int code) {
  std::fprintf(stderr, "isophote-viewer: %s\n", error.what());
  return code;
}

} // namespace
} // namespace isophote::viewer

// The exit codes are those of the isophote command.
int main(int argc, char** argv) {
  using namespace isophote;
  try {
    const std::optional<viewer::Options> options = viewer::parseOptions(argc, argv);
    return options ? viewer::run(*options) : 0;
  } catch (const UsageError& error) {
    return viewer::report(error, 2);
  } catch (const UnsupportedError& error) {
    return viewer::report(error, 4);
  } catch (const SceneError& error) {
    return viewer::report(error, 3);
  } catch (const LimitError& error) {
    return viewer::report(error, 5);
  } catch (const DeviceError& error) {
    return viewer::report(error, 6);
  } catch (const OutputError& error) {
    return viewer::report(error, 7);
  } catch (const std::exception& error) {
    return viewer::report(error, 1);
  }
}
