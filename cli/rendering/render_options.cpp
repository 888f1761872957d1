#include "rendering/render_options.hpp"

#include <limits>

#include "isophote/error.hpp"
#include "parse.hpp"
#include "rendering/backend.hpp"

namespace isophote::cli {
namespace {

constexpr uint32_t kDefaultSamples = 64;
constexpr uint32_t kMaxSamples = std::numeric_limits<uint32_t>::max();

ToneMap toneMapFromName(const std::string& name) {
  if (name == "neutral") return ToneMap::Neutral;
  if (name == "agx") return ToneMap::Agx;
  if (name == "aces") return ToneMap::Aces;
  if (name == "srgb") return ToneMap::Srgb;
  if (name == "linear") return ToneMap::Linear;
  throw UsageError("'" + name + "' is none of neutral, agx, aces, srgb, linear");
}

Transfer transferFromName(const std::string& name) {
  if (name == "srgb") return Transfer::Srgb;
  if (name == "gamma2.2") return Transfer::Gamma22;
  throw UsageError("'" + name + "' is neither srgb nor gamma2.2");
}

void addImageFlags(CLI::App& command, RenderOptions& options) {
  constexpr const char* kGroup = "Image";
  const auto side = [](const std::string& text) { return static_cast<uint32_t>(parseUnsigned(text, 1, 65535)); };
  addValue(
      command, "--width", "N", [&options, side](const std::string& text) { options.width = side(text); },
      "Pixels (1280, or from --height and the camera's aspect)")
      ->group(kGroup);
  addValue(
      command, "--height", "N", [&options, side](const std::string& text) { options.height = side(text); },
      "Pixels (from the width and the camera's aspect)")
      ->group(kGroup);
  addValue(
      command, "--crop", "X0,Y0,X1,Y1", [&options](const std::string& text) { options.crop = parseCrop(text); },
      "Render these pixels of the full image only; y runs down, X1 and Y1 are beyond the last")
      ->group(kGroup);
  addValue(
      command, "--exposure", "EV",
      [&options](const std::string& text) { options.exposureEv = static_cast<float>(parseNumber(text, -100, 100)); },
      "Exposure of PNG files in stops (0)")
      ->group(kGroup);
  addValue(
      command, "--tonemap", "NAME", [&options](const std::string& text) { options.toneMap = toneMapFromName(text); },
      "For PNG: neutral (Khronos PBR Neutral, default), agx, aces, srgb, linear")
      ->group(kGroup);
  addValue(
      command, "--transfer", "NAME", [&options](const std::string& text) { options.transfer = transferFromName(text); },
      "For PNG, how display values are encoded: srgb (default) or gamma2.2; no matter to agx and linear")
      ->group(kGroup);
}

void addStopFlags(CLI::App& command, RenderOptions& options) {
  constexpr const char* kGroup = "When to stop";
  CLI::Option* samples = addValue(
      command, "--spp,--samples", "N",
      [&options](const std::string& text) {
        options.samplesPerPixel = static_cast<uint32_t>(parseUnsigned(text, 1, kMaxSamples));
      },
      "Samples per pixel (64 when no other stop is given)");
  samples->group(kGroup);
  addValue(
      command, "--sample-range", "A:B",
      [&options](const std::string& text) { options.sampleRange = parseSampleRange(text); },
      "Samples A to B-1 only, for `isophote merge`")
      ->excludes(samples)
      ->group(kGroup);
  addValue(
      command, "--target-error", "P", [&options](const std::string& text) { options.targetError = parseShare(text); },
      "Stop when the image's relative RMS error is below P with --confidence: 2% or 0.02")
      ->group(kGroup);
  addValue(
      command, "--confidence", "P",
      [&options](const std::string& text) {
        options.confidence = parseShare(text);
        if (options.confidence < 0.5 || options.confidence > 0.9999) {
          throw UsageError("'" + text + "' is not between 50% and 99.99%");
        }
      },
      "Of the interval of the image's error (95%)")
      ->group(kGroup);
  addValue(
      command, "--time", "SECONDS",
      [&options](const std::string& text) { options.seconds = parseNumber(text, 1e-3, 1e9); },
      "Stop after this much rendering")
      ->group(kGroup);
  command
      .add_flag(
          "--adaptive", options.adaptive,
          "More samples where a pilot found more error; pays where parts of the image are much noisier than others")
      ->group(kGroup);
  CLI::Option* plan = command.add_flag(
      "--plan", options.plan, "Render nothing: say from a pilot of seconds what time, samples and memory it will take");
  plan->group(kGroup);
  addValue(
      command, "--pilot", "SECONDS",
      [&options](const std::string& text) { options.pilotSeconds = parseNumber(text, 1e-3, 1e6); },
      "Of the plan's pilot (3); a longer one tells more")
      ->needs(plan)
      ->group(kGroup);
  command.add_flag("--json", options.json, "Print the plan as JSON")->needs(plan)->group(kGroup);
}

void addCheckpointFlags(CLI::App& command, CheckpointOptions& options) {
  constexpr const char* kGroup = "Long renders";
  CLI::Option* file = command
                          .add_option("--checkpoint", options.file,
                                      "Keep the render's exact state in this file while it runs, and at its end")
                          ->type_name("F")
                          ->group(kGroup);
  addValue(
      command, "--checkpoint-every", "SECONDS",
      [&options](const std::string& text) { options.everySeconds = parseNumber(text, 0, 1e9); }, "How often (60)")
      ->needs(file)
      ->group(kGroup);
  command
      .add_flag("--resume", options.resume,
                "Go on from the checkpoint, if there is one, to the bits of a render without a break; more --spp than "
                "before are added")
      ->needs(file)
      ->group(kGroup);
}

void addEstimatorFlags(CLI::App& command, RenderOptions& options) {
  constexpr const char* kGroup = "Estimator";
  const auto addSetting = [&](const char* key, const char* type, const char* description) {
    addValue(
        command, std::string("--") + key, type,
        [&options, key](const std::string& text) { setSetting(options.settings, key, text); }, description)
        ->group(kGroup);
  };
  addSetting("max-depth", "N", "Scattering events on a path: 0 emission seen directly, 1 direct light (unlimited)");
  addSetting("seed", "N", "64 bits (0)");
  addSetting("filter", "NAME", "Pixel filter: box, gaussian, blackman-harris (default)");
  addSetting("sampler", "NAME",
             "sobol (Owen-scrambled, default), sobol-joint (less noise, error bars too wide), independent");
  addSetting("ndf", "NAME", "Microfacets: ggx (default), beckmann, blinn-phong");
  addSetting("masking", "NAME", "Of microfacets: correlated (default), separable");
  addSetting("fresnel", "NAME", "Of dielectrics: gltf (default), exact, schlick");
  command
      .add_option_function<std::vector<std::string>>(
          "--set",
          [&options](const std::vector<std::string>& assignments) {
            for (const std::string& assignment : assignments) setSetting(options.settings, assignment);
          },
          "Any setting that `isophote settings` lists; repeatable")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false)
      ->group(kGroup);
  command
      .add_flag_callback(
          "--denoise", [&options] { options.settings.layers.denoiser = Denoiser::Atrous; },
          "Add the layer denoised.{R,G,B}, less noisy and biased, and show it in PNG files; the image stays as it is")
      ->group(kGroup);
  command
      .add_flag("--unbiased", options.unbiased,
                "Refuse every setting that biases the image, and fail on a dropped sample")
      ->group(kGroup);
  command
      .add_flag_callback(
          "--no-specialize", [&options] { options.settings.execution.specialize = false; },
          "Kernels with every feature, not just those the scene needs")
      ->group(kGroup);
}

} // namespace

void addRenderFlags(CLI::App& command, RenderOptions& options) {
  command.add_option("SCENE", options.scene, "glTF 2.0 file, .gltf or .glb")->required();
  command
      .add_option("-o,--output", options.outputs,
                  "Image to write: .exr (float32, linear, all layers) or .png; repeatable")
      ->type_name("F")
      ->allow_extra_args(false);
  addImageFlags(command, options);
  addCameraFlags(command, options.camera);
  addStopFlags(command, options);
  addCheckpointFlags(command, options.checkpoint);
  addEstimatorFlags(command, options);
  addVariantFlag(command, options.variant);
  addEnvironmentFlags(command, options.environment);
  command
      .add_option("--device", options.device,
                  "Vulkan device by part of its name, index, or cpu (the fastest kind present)")
      ->type_name("NAME|INDEX|cpu");
  addBackendFlag(command, options.backend);
  command.add_option("--stats", options.statsFile, "Write times, rays, memory and error as JSON")->type_name("F.json");
  command.add_flag("--quiet", options.quiet, "Print warnings and errors only");
  command.add_flag("-v,--verbose", options.verbose, "Say what is loaded, built and used");
  command.add_flag("--validation", options.validation, "Vulkan validation layers; any message makes the exit code 1");
}

FilmOptions RenderOptions::filmOptions(const View& view) const {
  return {.width = view.width,
          .height = view.height,
          .crop = crop,
          .clampLedger = settings.estimator.clamp < kNoClamp,
          .depthLedger = settings.estimator.maxDepth != kUnlimitedDepth && settings.execution.depthLedger};
}

DeviceOptions RenderOptions::deviceOptions() const {
  return {.selector = device, .rayQuery = backend == Backend::RayQuery};
}

StopRule RenderOptions::stopRule() const {
  StopRule rule{.samples = {0, kMaxSamples}, .confidence = confidence, .target = targetError, .seconds = seconds};
  if (sampleRange) {
    rule.samples = *sampleRange;
  } else if (samplesPerPixel) {
    rule.samples.last = *samplesPerPixel;
  } else if (!targetError && !seconds) {
    rule.samples.last = kDefaultSamples;
  }
  return rule;
}

} // namespace isophote::cli
