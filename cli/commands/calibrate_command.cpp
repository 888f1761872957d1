// Whether the error bars of a scene are true: many short renders against a long one.
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "commands/commands.hpp"
#include "exit_codes.hpp"
#include "input/scene_source.hpp"
#include "isophote/coverage.hpp"
#include "isophote/error.hpp"
#include "isophote/path_tracer.hpp"
#include "parse.hpp"
#include "rendering/interrupt.hpp"

namespace isophote::cli {
namespace {

constexpr uint32_t kSampleCounts[] = {16, 64, 256, 1024};
constexpr uint64_t kReferenceSeed = 0x7265666572656e63; // none of the runs'

struct CalibrateOptions {
  std::string scene;
  EnvironmentOptions environment;
  std::string device;
  uint32_t width = 24;
  uint32_t runs = 4;
  uint32_t referenceSamples = 32768;
  bool json = false;
};

struct Rendered {
  Image image;
  ErrorEstimate error;
};

/// What some runs of one kind showed.
struct Outcome {
  Coverage pixels;
  uint32_t runs = 0;
  uint32_t imagesBelowUpper = 0; ///< runs whose true error is below the upper bound
  uint32_t imagesCovered = 0;
  double estimatedSquare = 0; ///< sums over runs, of the relative mean square error
  double trueSquare = 0;
};

class Calibration {
public:
  Calibration(const Device& device, const LoadedScene& loaded, const CalibrateOptions& options)
      : device_(device), scene_(device, loaded.scene), options_(options),
        view_(chooseView(loaded.scene, CameraOptions{}, options.width, std::nullopt)) {
    PathTracer tracer(device, scene_, {.seed = kReferenceSeed});
    reference_ = render(tracer, options.referenceSamples).image;
    double luminance = 0;
    const size_t pixels = size_t{view_.width} * view_.height;
    for (size_t i = 0; i < pixels; ++i) {
      luminance += 0.2126 * at(reference_, "R", i) + 0.7152 * at(reference_, "G", i) + 0.0722 * at(reference_, "B", i);
    }
    epsilon_ = 0.01 * luminance / static_cast<double>(pixels);
  }

  [[nodiscard]] Outcome measure(SamplerKind sampler, uint32_t samples) const {
    Outcome outcome;
    PathTracer tracer(device_, scene_, {.sampler = sampler});
    for (uint32_t run = 0; run < options_.runs && !interrupted(); ++run) {
      tracer.setSeed(1 + run);
      add(render(tracer, samples), samples, outcome);
    }
    return outcome;
  }

private:
  [[nodiscard]] Rendered render(PathTracer& tracer, uint32_t samples) const {
    Film film(device_, {.width = view_.width, .height = view_.height, .aovs = false});
    tracer.render(view_.camera, film, {0, samples}, [](const Progress&) { return !interrupted(); });
    return {film.resolve(), film.error()};
  }

  static double at(const Image& image, const std::string& channel, size_t pixel) {
    return image.find(channel)->values[pixel];
  }

  void add(const Rendered& run, uint32_t samples, Outcome& outcome) const {
    addCoverage(run.image, reference_, outcome.pixels);
    double relative = 0;
    const size_t pixels = size_t{view_.width} * view_.height;
    for (const std::string color : {"R", "G", "B"}) {
      for (size_t i = 0; i < pixels; ++i) {
        const double truth = at(reference_, color, i);
        const double difference = at(run.image, color, i) - truth;
        relative += difference * difference / (truth * truth + epsilon_ * epsilon_);
      }
    }
    // The reference's own error, in the mean, taken off again.
    const double trueSquare =
        relative / (3.0 * static_cast<double>(pixels)) / (1 + double(samples) / options_.referenceSamples);
    const double trueError = std::sqrt(trueSquare);
    outcome.runs += 1;
    outcome.imagesBelowUpper += trueError <= run.error.upper ? 1 : 0;
    outcome.imagesCovered += trueError <= run.error.upper && trueError >= run.error.lower ? 1 : 0;
    outcome.estimatedSquare += run.error.value * run.error.value;
    outcome.trueSquare += trueSquare;
  }

  const Device& device_;
  GpuScene scene_;
  const CalibrateOptions& options_;
  View view_;
  Image reference_;
  double epsilon_ = 0;
};

double share(uint64_t part, uint64_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0;
}

int runCalibrate(const CalibrateOptions& options) {
  catchInterrupts();
  const LoadedScene loaded = loadScene(options.scene, options.environment);
  const VulkanInstance instance;
  const Device device(instance, {.selector = options.device});
  const Calibration calibration(device, loaded, options);
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  if (!options.json)
    fmt::print("sampler      spp    covered  of trusted  blind misses  image covered  estimated/true error\n");
  for (const auto& [sampler, name] :
       {std::pair{SamplerKind::Sobol, "sobol"}, std::pair{SamplerKind::Independent, "independent"}}) {
    for (const uint32_t samples : kSampleCounts) {
      const Outcome outcome = calibration.measure(sampler, samples);
      const Coverage& c = outcome.pixels;
      if (interrupted()) return kInterrupted;
      const double ratio = outcome.trueSquare > 0 ? std::sqrt(outcome.estimatedSquare / outcome.trueSquare) : 1;
      list.push_back({{"sampler", name},
                      {"spp", samples},
                      {"covered", share(c.covered, c.values)},
                      {"covered_where_trusted", share(c.trustedCovered, c.trustedValues)},
                      {"trusted", share(c.trustedValues, c.values)},
                      {"missed_above", share(c.missedAbove, c.values)},
                      {"missed_blind", share(c.missedBlind, c.values)},
                      {"images", outcome.runs},
                      {"images_covered", outcome.imagesCovered},
                      {"images_below_upper", outcome.imagesBelowUpper},
                      {"estimated_over_true_error", ratio}});
      if (options.json) continue;
      fmt::print("{:<11} {:>5}  {:>8.1f}%  {:>9.1f}%  {:>11.1f}%  {:>9} of {}  {:>18.2f}\n", name, samples,
                 100 * share(c.covered, c.values), 100 * share(c.trustedCovered, c.trustedValues),
                 100 * share(c.missedBlind, c.values), outcome.imagesCovered, outcome.runs, ratio);
      std::fflush(stdout);
    }
  }
  if (options.json) {
    fmt::print("{}\n", nlohmann::ordered_json{{"schema", 1},
                                              {"scene", options.scene},
                                              {"device", device.info().name},
                                              {"width", options.width},
                                              {"runs", options.runs},
                                              {"reference_spp", options.referenceSamples},
                                              {"coverage", list}}
                           .dump(2));
  }
  return kDone;
}

} // namespace

void addCalibrateCommand(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("calibrate", "Measure whether a scene's error bars are true");
  const auto options = std::make_shared<CalibrateOptions>();
  command->add_option("SCENE", options->scene, "glTF 2.0 file")->required();
  addEnvironmentFlags(*command, options->environment);
  const auto whole = [&](const char* name, uint32_t CalibrateOptions::*member, uint64_t most, const char* description) {
    addValue(
        *command, name, "N",
        [options, member, most](const std::string& text) {
          (*options).*member = static_cast<uint32_t>(parseUnsigned(text, 1, most));
        },
        description);
  };
  whole("--width", &CalibrateOptions::width, 4096, "Pixels (24)");
  whole("--runs", &CalibrateOptions::runs, 1000000, "Seeds for each number of samples (4)");
  whole("--reference-spp", &CalibrateOptions::referenceSamples, 1u << 30, "Samples of the converged image (32768)");
  command->add_option("--device", options->device, "Vulkan device by part of its name, index, or cpu");
  command->add_flag("--json", options->json, "Machine-readable");
  command->footer(R"(Example:
  isophote calibrate scene.glb

At 16, 64, 256 and 1024 samples a pixel, with both samplers: the share of pixel values whose 95% interval holds the
converged value, the same where the trust layer is at least 0.1, and the values that miss it without reporting any error;
and of how many images the interval of the error holds the true one.)");
  command->callback([options, &action] { action = [options] { return runCalibrate(*options); }; });
}

} // namespace isophote::cli
