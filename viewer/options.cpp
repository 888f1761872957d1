#include "viewer/options.hpp"

#include <cstdio>
#include <map>

#include <CLI/CLI.hpp>

#include "isophote/error.hpp"
#include "isophote/version.hpp"

namespace isophote::viewer {

std::optional<Options> parseOptions(int argc, char** argv) {
  Options options;
  std::map<std::string, ToneMap> toneMaps;
  for (uint32_t i = 0; i < std::size(kToneMapNames); ++i) toneMaps[kToneMapNames[i]] = static_cast<ToneMap>(i);

  CLI::App app("Shows a glTF scene, path traced while you look around.", "isophote-viewer");
  app.set_version_flag("--version", std::string("isophote-viewer ") + kVersion);
  app.add_option("scene", options.scene, "glTF 2.0 file (.gltf, .glb)")->required();
  app.add_option("--width", options.width, "window width")->check(CLI::Range(64, 16384));
  app.add_option("--height", options.height, "window height")->check(CLI::Range(64, 16384));
  app.add_option("--scale", options.scale, "window pixels a side of one image pixel (1 on a GPU, 2 on a CPU)")
      ->check(CLI::Range(1, 16));
  app.add_option("--camera", options.camera, "glTF camera, by name or index");
  app.add_option("--variant", options.variant, "materials of the asset's variant of this name");
  app.add_option("--env", options.environment, "equirectangular HDR or EXR environment");
  app.add_option("--exposure", options.exposure, "EV")->check(CLI::Range(-30.0, 30.0));
  app.add_option("--tonemap", options.toneMap, "neutral, agx, aces, srgb or linear")
      ->transform(CLI::CheckedTransformer(toneMaps, CLI::ignore_case));
  app.add_option("--device", options.device, "device name, index or cpu");
  app.add_option("-o,--output", options.output, "stem of saved images (the scene's name)");
  app.add_option("--frames", options.frames, "quit after this many frames");
  app.add_option("--screenshot", options.screenshot, "PNG written at the end")->check(!CLI::ExistingDirectory);
  app.add_option("--headless-frames", options.headlessFrames, "render this many submits without a window, then quit");
  app.add_flag("--validation", options.validation, "Vulkan validation; any message makes the exit code 1");
  app.footer("Left drag orbits, right drag and wheel come closer, middle drag or shift and left drag move sideways.\n"
             "S saves EXR and PNG, R starts over, H hides the panel, Esc quits.");
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {
    app.exit(success);
    return std::nullopt;
  } catch (const CLI::ParseError& error) {
    throw UsageError(error.what());
  }
  return options;
}

} // namespace isophote::viewer
