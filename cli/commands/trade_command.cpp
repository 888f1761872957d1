// What each setting costs and gains on a scene.
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "commands/commands.hpp"
#include "console.hpp"
#include "exit_codes.hpp"
#include "input/scene_files.hpp"
#include "isophote/error.hpp"
#include "lecture/lecture.hpp"
#include "parse.hpp"
#include "rendering/interrupt.hpp"
#include "rendering/progress_line.hpp"
#include "trade/page.hpp"
#include "trade/study.hpp"
#include "trade/study_files.hpp"

namespace isophote::cli {
namespace {

constexpr uint32_t kDefaultWidth = 96;
constexpr const char* kFiles[] = {"trade.json", "trade.csv", "trade.html"};

constexpr const char* kExamples = R"(Examples:
  isophote trade scene.glb -o study                                       two minutes; open study/trade.html
  isophote trade scene.glb -o study --budget 600 --env sky.hdr
  isophote trade scene.glb -o study --settings sampler --settings max-depth=2,4,8
  isophote trade scene.glb -o study --reference converged.exr             at that image's size

A reference is rendered (or read, with its error bars), then each value of each setting alone and combinations of what
pays, in short runs that take turns, with several seeds. Errors are split into noise and bias, each with its 95%
interval. Ctrl-C keeps what was measured (exit code 130).)";

struct TradeOptions {
  std::string scene;
  std::string directory;
  StudyPlan plan;
  std::string reference;
  std::optional<uint32_t> width;
  CameraOptions camera;
  EnvironmentOptions environment;
  std::optional<std::string> variant;
  std::string device;
  bool lecture = false;
  bool quiet = false;
};

/// The flags of `isophote render` that make the same picture.
std::string sceneFlags(const TradeOptions& options) {
  std::string text;
  const EnvironmentOptions& e = options.environment;
  if (!e.file.empty()) text += " --env " + shellWord(e.file);
  if (e.color) text += fmt::format(" --env-color {},{},{}", e.color->r, e.color->g, e.color->b);
  if (e.sky) {
    text += fmt::format(" --sky {},{},{}", e.sky->elevationDegrees, e.sky->azimuthDegrees, e.sky->turbidity);
  }
  if (e.intensity) text += fmt::format(" --env-intensity {}", *e.intensity);
  if (e.rotationDegrees) text += fmt::format(" --env-rotation {}", *e.rotationDegrees);
  const CameraOptions& c = options.camera;
  if (c.name) text += " --camera " + shellWord(*c.name);
  if (c.lensRadius) text += fmt::format(" --lens-radius {}", *c.lensRadius);
  if (c.focusDistance) text += fmt::format(" --focus-distance {}", *c.focusDistance);
  if (c.apertureBlades) text += fmt::format(" --aperture-blades {}", *c.apertureBlades);
  if (c.panorama) text += " --panorama";
  if (options.variant) text += " --variant " + shellWord(*options.variant);
  return text;
}

void prepareDirectory(const std::string& directory) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (error) throw OutputError(directory + ": cannot be made: " + error.message());
  for (const char* file : kFiles) checkWritable(std::filesystem::path(directory) / file);
}

void writeStudy(const Study& study, const StudyContext& context, const std::string& directory) {
  const std::filesystem::path folder = directory;
  writeFileAtomically(folder / kFiles[0],
                      studyJson(study, context).dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) +
                          "\n");
  writeFileAtomically(folder / kFiles[1], studyCsv(study));
  writeFileAtomically(folder / kFiles[2], studyPage(study, context));
}

void describe(const Study& study, const StudyContext& context) {
  for (const Recommendation& r : study.recommendations) {
    fmt::print("{:<9} {}\n", r.purpose + ":", commandLine(study, r, context));
    if (r.tried()) {
      fmt::print("{:<9} {}: error {:.3g}% after {} samples, forecast {:.3g}%\n", "",
                 r.confirmed() ? "confirmed" : "not confirmed", 100 * rootOf(r.found.totalSquare.value),
                 r.confirmedSamples, 100 * r.forecastError);
    }
  }
}

int runLecture(const TradeOptions& options) {
  const VulkanInstance instance;
  const Device device(instance, {.selector = options.device});
  const LectureOptions lecture{
      .scene = options.scene, .folder = options.directory, .width = options.width.value_or(72)};
  const bool finished = writeLecture(device, lecture, [&](const std::string& text) {
    if (!options.quiet) fmt::print(stderr, "{}\n", text);
  });
  if (finished) return kDone;
  printError("interrupted; nothing is written");
  return kInterrupted;
}

int runTrade(TradeOptions options) {
  catchInterrupts();
  if (options.lecture) return runLecture(options);
  const auto start = std::chrono::steady_clock::now();
  const auto elapsed = [start] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  prepareDirectory(options.directory);
  (void)singleChanges(options.plan.settings); // complains now, not later
  LoadedScene loaded = loadScene(options.scene, options.environment, options.variant);
  for (const std::string& warning : loaded.scene.warnings) printWarning(warning);
  if (!hasLight(loaded.scene))
    throw UsageError("nothing in the scene gives light: there is no error to trade; add --env-color or --env");
  std::optional<uint32_t> height;
  if (!options.reference.empty()) {
    options.plan.reference = readExr(options.reference);
    options.plan.referenceFile = options.reference;
    options.width = options.plan.reference->width;
    height = options.plan.reference->height;
    (void)ErrorSplitter(*options.plan.reference); // it needs error bars
  }
  const View view = chooseView(loaded.scene, options.camera, options.width.value_or(kDefaultWidth), height);

  const VulkanInstance instance;
  const Device device(instance, {.selector = options.device});
  ProgressLine line(options.quiet);
  std::string stage = "compiling";
  const auto showStage = [&] {
    const double left = std::max(options.plan.seconds - elapsed(), 0.0);
    const double share = std::min(elapsed() / options.plan.seconds, 1.0);
    line.show(fmt::format("{:3.0f}%  {} elapsed, at most {} left: {}", std::floor(100 * share), clockText(elapsed()),
                          clockText(left), stage));
  };
  Workbench bench(device, std::move(loaded.scene), view, [&] {
    if (line.due()) showStage();
    return !interrupted();
  });
  const Study study = runStudy(bench, options.plan, elapsed, [&](const std::string& now) {
    stage = now;
    if (line.due()) showStage();
  });
  line.clear();

  const StudyContext context{.scene = options.scene,
                             .sceneFlags = sceneFlags(options),
                             .device = device.info().name,
                             .driver = device.info().driver,
                             .width = view.width,
                             .height = view.height,
                             .budgetSeconds = options.plan.seconds};
  writeStudy(study, context, options.directory);
  if (!options.quiet) {
    describe(study, context);
    fmt::print("{} configurations in {:.1f} s: {}\n", study.measuredCount(), elapsed(),
               (std::filesystem::path(options.directory) / kFiles[2]).string());
  }
  if (!study.reference.goodEnough)
    printWarning("the reference is not good enough to tell bias from its own error: give it a larger --budget");
  if (study.interrupted) {
    printError("interrupted; what was measured is saved");
    return kInterrupted;
  }
  return kDone;
}

} // namespace

void addTradeCommand(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("trade", "Measure what each setting costs and gains on a scene");
  const auto options = std::make_shared<TradeOptions>();
  command->add_option("SCENE", options->scene, "glTF 2.0 file, .gltf or .glb")->required();
  command
      ->add_option("-o,--output", options->directory,
                   "Folder for trade.html, trade.json and trade.csv; made if missing")
      ->type_name("DIR")
      ->required();
  addValue(
      *command, "--budget", "SECONDS",
      [options](const std::string& text) { options->plan.seconds = parseNumber(text, 1, 1e7); },
      "For everything, compilation of kernels included (120)");
  command
      ->add_option(
          "--settings", options->plan.settings,
          "This setting only, with all its values or those given; repeatable (all that `isophote settings` lists)")
      ->type_name("KEY[=VALUE,…]")
      ->allow_extra_args(false);
  CLI::Option* reference =
      command
          ->add_option("--reference", options->reference,
                       "Converged image of the same scene, camera and environment, with its error bars")
          ->type_name("R.exr");
  addValue(
      *command, "--width", "N",
      [options](const std::string& text) { options->width = static_cast<uint32_t>(parseUnsigned(text, 1, 65535)); },
      "Pixels (96); errors are those of a larger image, times grow with it")
      ->excludes(reference);
  addCameraFlags(*command, options->camera);
  addVariantFlag(*command, options->variant);
  addEnvironmentFlags(*command, options->environment);
  command->add_option("--device", options->device, "Vulkan device by part of its name, index, or cpu")
      ->type_name("NAME|INDEX|cpu");
  command->add_flag(
      "--lecture", options->lecture,
      "Instead, render and measure the comparisons of the course: of assets/lecture.glb, into docs/lecture");
  command->add_flag("--quiet", options->quiet, "Print warnings and errors only");
  command->footer(kExamples);
  command->callback([options, &action] { action = [options] { return runTrade(*options); }; });
}

} // namespace isophote::cli
