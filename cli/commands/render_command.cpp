#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "commands/commands.hpp"
#include "console.hpp"
#include "exit_codes.hpp"
#include "input/scene_files.hpp"
#include "isophote/denoise.hpp"
#include "isophote/error.hpp"
#include "rendering/backend.hpp"
#include "rendering/interrupt.hpp"
#include "rendering/render_options.hpp"
#include "rendering/render_plan.hpp"
#include "rendering/render_report.hpp"

namespace isophote::cli {
namespace {

constexpr const char* kExamples = R"(Examples:
  isophote render scene.glb -o image.exr -o image.png
  isophote render scene.glb -o image.exr --target-error 2% --time 600     whichever comes first; exit code 8 if it is the time
  isophote render scene.glb --target-error 2% --plan                      how long that will take, before it begins
  isophote render model.glb -o image.png --env sky.hdr --env-rotation 90 --exposure -1 --tonemap agx
  isophote render model.glb -o image.png --sky 40,120 --exposure -13      a clear day
  isophote render model.glb -o image.png --env-color 1,1,1                for an asset without lights
  isophote render scene.glb -o part.exr --sample-range 64:128             the second 64 samples, for another machine
  isophote render scene.glb -o image.exr --spp 4096 --checkpoint image.ckpt --resume      safe against power cuts
  isophote render scene.glb -o direct.exr --max-depth 1 --stats stats.json
  isophote render scene.glb -o image.exr -o quiet.png --denoise           the EXR keeps the image as it is, with one layer more

Ctrl-C ends the render and saves the image (exit code 130); a second one aborts.)";

class Stopwatch {
public:
  /// Seconds since construction or the last call.
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - start_).count();
    start_ = now;
    return seconds;
  }

private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

bool isPng(const std::string& file) { return std::filesystem::path(file).extension() == ".png"; }

void checkOutputs(const RenderOptions& options) {
  std::vector<std::string> files = options.outputs;
  if (files.empty() && !options.plan) throw UsageError("--output is required");
  for (const std::string& file : files) {
    const auto extension = std::filesystem::path(file).extension();
    if (extension != ".exr" && extension != ".png")
      throw UsageError(fmt::format("--output: '{}' is neither .exr nor .png", file));
  }
  if (!options.statsFile.empty()) files.push_back(options.statsFile);
  if (!options.checkpoint.file.empty()) files.push_back(options.checkpoint.file);
  for (size_t i = 0; i < files.size(); ++i) {
    if (std::find(files.begin(), files.begin() + static_cast<std::ptrdiff_t>(i), files[i]) !=
        files.begin() + static_cast<std::ptrdiff_t>(i)) {
      throw UsageError(fmt::format("'{}' is given as output twice", files[i]));
    }
    checkWritable(files[i]);
  }
}

void refuseBias(const Settings& settings) {
  const auto bias = biasJson(settings);
  if (!bias.empty()) throw UsageError("--unbiased: " + bias.begin().key() + " biases the image");
}

void refuseOverwritingInputs(const RenderOptions& options, const LoadedScene& loaded) {
  for (const std::string& file : options.outputs) refuseOverwriting(file, loaded.files);
  if (!options.statsFile.empty()) refuseOverwriting(options.statsFile, loaded.files);
  if (!options.checkpoint.file.empty()) refuseOverwriting(options.checkpoint.file, loaded.files);
}

nlohmann::ordered_json environmentJson(const EnvironmentOptions& options) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  if (!options.file.empty()) json["file"] = options.file;
  if (options.color) json["color"] = {options.color->r, options.color->g, options.color->b};
  if (options.intensity) json["intensity"] = *options.intensity;
  if (options.sky) {
    json["sky"] = {{"elevation_degrees", options.sky->elevationDegrees},
                   {"azimuth_degrees", options.sky->azimuthDegrees},
                   {"turbidity", options.sky->turbidity}};
  }
  if (options.rotationDegrees) json["rotation_degrees"] = *options.rotationDegrees;
  return json;
}

void warnAboutScene(const Scene& scene) {
  for (const std::string& warning : scene.warnings) printWarning(warning);
  if (!hasLight(scene)) {
    printWarning("nothing in the scene gives light, the image will be black: add --env-color 1,1,1 or --env sky.hdr");
  }
}

void warnAboutStatus(const StatusCounters& status) {
  if (status.total() == 0) return;
  std::string text;
  const auto counters = statusJson(status);
  for (const auto& [name, count] : counters.items()) {
    if (count.get<uint64_t>() > 0)
      text += fmt::format("{}{} {}", text.empty() ? "" : ", ", name, count.get<uint64_t>());
  }
  printWarning("the render dropped or changed samples: " + text);
}

/// What the sample counts of the pixels say was done.
void countSamples(const Image& image, const SampleRange& asked, RenderReport& report) {
  const Channel* counts = image.find("sampleCount.Y");
  if (counts == nullptr || counts->values.empty()) throw Error("the film resolved without sample counts");
  const auto [fewest, most] = std::minmax_element(counts->values.begin(), counts->values.end());
  report.samplesPerPixel = static_cast<uint32_t>(*fewest);
  report.samples = {asked.first, asked.first + static_cast<uint32_t>(*most)};
}

void refuseAdaptive(const RenderOptions& options) {
  if (!options.adaptive) return;
  if (options.sampleRange) throw UsageError("--adaptive: such samples cannot be merged, leave out --sample-range");
  if (!options.checkpoint.file.empty())
    throw UsageError("--adaptive: such a render cannot resume, leave out --checkpoint");
  if (options.plan) throw UsageError("--adaptive: --plan does not know what it saves");
}

void refuseDenoisedShard(const RenderOptions& options) {
  if (options.sampleRange && options.settings.layers.denoiser != Denoiser::None)
    throw UsageError("--denoise: this is a part of an image, denoise the whole: isophote merge --denoise");
}

/// Samples a pixel of the pilot that says where the error is: a sixteenth of all, in whole rounds.
uint32_t pilotSamples(const RenderOptions& options) {
  constexpr uint32_t kRound = 8, kMost = 64, kUsual = 16;
  return options.samplesPerPixel ? std::clamp(*options.samplesPerPixel / 16 / kRound * kRound, kRound, kMost) : kUsual;
}

/// The rule for pixels of the first class that spends as many samples as asked for, the pilot's among them.
StopRule sharedOut(StopRule rule, const AdaptivePlan& plan) {
  constexpr uint32_t kRound = 8;
  const double left = std::max(double(rule.samples.last) - plan.pilotSamples, 0.0);
  const auto rounds = static_cast<uint32_t>(std::lround(left / plan.allocation.samplesPerPixel / kRound));
  rule.samples.last = kRound * std::max(rounds, 1u);
  return rule;
}

/// What a PNG shows: the denoised layer where there is one, as it was asked for.
/// Alpha is coverage by geometry; where an environment shows, the picture is opaque all the same.
Image pictureOf(const Image& image, bool denoised, bool environment) {
  Image picture{.width = image.width, .height = image.height};
  for (const char* color : {"R", "G", "B"})
    picture.channels.push_back({color, image.find((denoised ? "denoised." : "") + std::string(color))->values});
  if (!environment) picture.channels.push_back(*image.find("A"));
  return picture;
}

void writeImages(const RenderOptions& options, const Image& image, bool environment) {
  const bool denoised = options.settings.layers.denoiser != Denoiser::None;
  for (const std::string& file : options.outputs) {
    if (isPng(file)) {
      writePng(file, pictureOf(image, denoised, environment), options.exposureEv, options.toneMap, options.transfer);
    } else {
      writeExr(file, image);
    }
  }
}

void describeStart(const RenderReport& report) {
  fmt::print("{}: {} triangles, {} with instances; BVH in {:.2f} s\n", report.scene, report.sceneStatistics.triangles,
             report.sceneStatistics.instancedTriangles, report.seconds.bvh);
  fmt::print("device: {} ({}), {}; backend {}\n", report.device.name, report.device.kind, report.device.driver,
             backendName(report.sceneStatistics.backend));
  fmt::print("features: {}\n", fmt::join(report.features.names(), ", "));
  std::fflush(stdout); // a log should say so before the hours of rendering
}

void describeResult(const RenderOptions& options, const RenderReport& report) {
  std::string error = "error unknown (one replicate)";
  const ErrorEstimate& e = report.result.error;
  if (e.known)
    error = fmt::format("error {:.3g}% ({:g}%: {:.3g} to {:.3g}%)", 100 * e.value, 100 * e.confidence, 100 * e.lower,
                        100 * e.upper);
  fmt::print("{} x {} pixels, {} spp, {}, {:.2f} s: {}\n", report.view.width, report.view.height,
             report.samplesPerPixel, error, report.seconds.render, fmt::join(options.outputs, ", "));
}

int finish(const RenderOptions& options, const RenderReport& report, const VulkanInstance& instance) {
  warnAboutStatus(report.statistics.status);
  const std::vector<std::string> messages = instance.validationMessages();
  for (const std::string& message : messages) printWarning("validation: " + message);
  if (report.result.outcome == Outcome::Interrupted) {
    printError("interrupted; the image so far is saved");
    return kInterrupted;
  }
  if (!messages.empty()) return kFailed;
  if (options.unbiased && report.statistics.status.total() > 0) {
    printError("--unbiased: samples were dropped or changed, see isophote.status; the image is saved");
    return kFailed;
  }
  if (report.result.outcome == Outcome::BudgetEnded) {
    printError(fmt::format("the budget ended at an error of {:.3g}%, above the target of {:.3g}%; the image is saved",
                           100 * report.result.error.upper, 100 * *options.targetError));
    return kBudgetEnded;
  }
  return kDone;
}

int runRender(const RenderOptions& options) {
  catchInterrupts();
  checkOutputs(options);
  if (options.unbiased) refuseBias(options.settings);
  refuseAdaptive(options);
  refuseDenoisedShard(options);
  if (options.plan) return runPlan(options);
  Stopwatch watch;
  RenderReport report{.scene = options.scene,
                      .settings = options.settings,
                      .environment = environmentJson(options.environment),
                      .variant = options.variant};

  LoadedScene loaded = loadScene(options.scene, options.environment, options.variant);
  refuseOverwritingInputs(options, loaded);
  warnAboutScene(loaded.scene);
  report.view = chooseView(loaded.scene, options.camera, options.width, options.height);
  report.sceneHash = hashFiles(loaded.files);
  report.seconds.load = watch.lap();

  const VulkanInstance instance({.validation = options.validation});
  const Device device(instance, options.deviceOptions());
  report.device = device.info();
  const GpuScene scene(device, loaded.scene, options.backend);
  const bool environment = loaded.scene.environment.has_value();
  loaded = {}; // the device has its own copy
  report.sceneStatistics = scene.statistics();
  report.seconds.bvh = report.sceneStatistics.bvhSeconds;
  report.seconds.upload = report.sceneStatistics.packSeconds + report.sceneStatistics.uploadSeconds;
  Film film(device, options.filmOptions(report.view));
  report.crop = film.options().crop;
  report.filmBytes = film.bytes();
  PathTracer tracer(device, scene, options.settings.estimator, options.settings.execution);
  report.features = tracer.features();
  if (options.verbose) describeStart(report);

  if (interrupted()) {
    printError("interrupted before the first sample; nothing is written");
    return kInterrupted;
  }
  report.rule = options.stopRule();
  {
    ProgressLine progress(options.quiet);
    CheckpointKeeper checkpoints(options.checkpoint, sampleIdentity(report, report.rule.samples.first));
    if (options.adaptive) {
      report.adaptive = planSamples(tracer, report.view.camera, film, device, options.settings.estimator.seed,
                                    pilotSamples(options), [] { return !interrupted(); });
      if (!report.adaptive) {
        printError("interrupted before the first sample of the image; nothing is written");
        return kInterrupted;
      }
      report.rule = sharedOut(report.rule, *report.adaptive);
    }
    report.result = renderUntil(tracer, report.view.camera, film, report.rule, progress, &checkpoints,
                                report.adaptive ? &*report.adaptive : nullptr);
  }
  report.statistics = tracer.statistics();
  report.features = tracer.features();
  report.seconds.compile = report.statistics.compileSeconds;
  report.seconds.render = report.result.seconds;
  report.seconds.device = report.statistics.renderSeconds;

  watch.lap();
  Image image = film.resolve();
  countSamples(image, report.rule.samples, report);
  if (options.settings.layers.denoiser != Denoiser::None) {
    addDenoised(image);
    report.seconds.denoise = watch.lap();
  }
  report.bias = biasAccount(image);
  image.attributes = imageAttributes(report);
  image.renderSeconds = static_cast<float>(report.seconds.render);
  if (options.sampleRange) storeSums(image, film.sums()); // a shard, to be merged
  writeImages(options, image, environment);
  report.seconds.write = watch.lap();
  if (!options.statsFile.empty()) {
    writeFileAtomically(options.statsFile,
                        statsJson(report).dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
  }
  if (!options.quiet) describeResult(options, report);
  return finish(options, report, instance);
}

} // namespace

void addRenderCommand(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("render", "Render a glTF scene to OpenEXR and PNG");
  const auto options = std::make_shared<RenderOptions>();
  addRenderFlags(*command, *options);
  command->footer(kExamples);
  command->callback([options, &action] { action = [options] { return runRender(*options); }; });
}

} // namespace isophote::cli
