// Wavefront and fused kernel side by side on one scene: the same samples by turns, timed by processor time and by the
// clock, with a look that the images are equal bit for bit. Prints one line of JSON.
#include <chrono>
#include <cstring>
#include <ctime>
#include <iostream>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "input/scene_source.hpp"
#include "isophote/device.hpp"
#include "isophote/error.hpp"
#include "isophote/path_tracer.hpp"
#include "ratio.hpp"

using namespace isophote;
using Json = nlohmann::ordered_json;

namespace {

struct Options {
  std::string scene;
  cli::EnvironmentOptions environment;
  std::string device = "cpu";
  uint32_t width = 256;
  uint32_t height = 144;
  uint32_t samples = 16;
  uint32_t maxDepth = kUnlimitedDepth;
  uint32_t rounds = 7;
  uint32_t fusedPool = 0; ///< 0: as large as the other's
};

/// Of all threads: on a machine with other work steadier than the clock, but blind to cores that wait.
double processSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

double clockSeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Of each round but the first, which compiles and warms up.
struct Times {
  std::vector<double> processor;
  std::vector<double> clock;
};

struct Contender {
  PathTracer tracer;
  Film film;
  Times times;

  Contender(const Device& device, const GpuScene& scene, const Options& options, Pipeline pipeline)
      : tracer(device, scene, {.maxDepth = options.maxDepth},
               {.pathPoolSize = pipeline == Pipeline::Fused ? options.fusedPool : 0,
                .pipeline = pipeline,
                .depthLedger = false}),
        film(device, {.width = options.width, .height = options.height}) {}

  void render(const Camera& camera, SampleRange samples) {
    const double processor = processSeconds();
    const double clock = clockSeconds();
    tracer.render(camera, film, samples);
    if (samples.first == 0) return;
    times.processor.push_back(processSeconds() - processor);
    times.clock.push_back(clockSeconds() - clock);
  }
};

bool equal(const Image& a, const Image& b) {
  for (size_t i = 0; i < a.channels.size(); ++i) {
    const auto& x = a.channels[i].values;
    const auto& y = b.channels[i].values;
    if (std::memcmp(x.data(), y.data(), x.size() * sizeof(float)) != 0) return false;
  }
  return a.channels.size() == b.channels.size();
}

Json contenderJson(const Contender& contender) {
  const RenderStatistics statistics = contender.tracer.statistics();
  double compile = 0;
  uint64_t spirv = 0;
  for (const KernelStatistics& kernel : statistics.kernels) {
    compile += kernel.compileMilliseconds;
    spirv += kernel.spirvBytes;
  }
  return {{"processor_seconds", bench::median(contender.times.processor)},
          {"clock_seconds", bench::median(contender.times.clock)},
          {"compile_ms", compile},
          {"spirv_bytes", spirv},
          {"primary_rays", statistics.primaryRays},
          {"bounce_rays", statistics.bounceRays},
          {"shadow_rays", statistics.shadowRays}};
}

void race(const Options& options) {
  const cli::LoadedScene loaded = cli::loadScene(options.scene, options.environment);
  const cli::View view = cli::chooseView(loaded.scene, {}, options.width, options.height);
  const VulkanInstance instance;
  const Device device(instance, {.selector = options.device});
  const GpuScene scene(device, loaded.scene);
  Contender wavefront(device, scene, options, Pipeline::Wavefront);
  Contender fused(device, scene, options, Pipeline::Fused);
  for (uint32_t round = 0; round <= options.rounds; ++round) {
    const SampleRange samples{round * options.samples, (round + 1) * options.samples};
    for (Contender* contender : {&wavefront, &fused}) {
      contender->render(view.camera, samples);
    }
  }
  const auto speed = [&](std::vector<double> Times::*kind) {
    const bench::Ratio ratio = bench::pairedRatio(wavefront.times.*kind, fused.times.*kind);
    return Json{ratio.median, ratio.low, ratio.high};
  };
  const Json json = {
      {"scene", options.scene},
      {"fused_speed_over_wavefront", {{"processor", speed(&Times::processor)}, {"clock", speed(&Times::clock)}}},
      {"equal", equal(wavefront.film.resolve(), fused.film.resolve())},
      {"wavefront", contenderJson(wavefront)},
      {"fused", contenderJson(fused)}};
  std::cout << json.dump() << "\n";
}

} // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Wavefront and fused kernel side by side");
  app.add_option("SCENE", options.scene)->required();
  app.add_option("--device", options.device);
  app.add_option("--width", options.width);
  app.add_option("--height", options.height);
  app.add_option("--spp", options.samples, "of a round");
  app.add_option("--max-depth", options.maxDepth);
  app.add_option("--rounds", options.rounds);
  app.add_option("--fused-path-pool-size", options.fusedPool);
  cli::addEnvironmentFlags(app, options.environment);
  CLI11_PARSE(app, argc, argv);
  try {
    race(options);
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
