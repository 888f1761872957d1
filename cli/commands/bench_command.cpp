#include <algorithm>
#include <memory>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "commands/commands.hpp"
#include "exit_codes.hpp"
#include "input/scene_source.hpp"
#include "isophote/path_tracer.hpp"
#include "isophote/ray_bench.hpp"
#include "parse.hpp"
#include "rendering/backend.hpp"

namespace isophote::cli {
namespace {

using Json = nlohmann::ordered_json;

// The same image whatever the asset says, so that numbers compare.
constexpr uint32_t kWidth = 640;
constexpr uint32_t kHeight = 360;

struct BenchOptions {
  std::string scene;
  EnvironmentOptions environment;
  std::optional<std::string> variant;
  std::string device;
  Backend backend = Backend::Compute;
  std::string rays;
  double seconds = 4;
  bool json = false;
};

DeviceOptions deviceOptions(const BenchOptions& options) {
  return {.selector = options.device, .rayQuery = options.backend == Backend::RayQuery};
}

double kernelMilliseconds(const RenderStatistics& statistics, const std::string& name) {
  for (const KernelStatistics& kernel : statistics.kernels) {
    if (kernel.name == name) return kernel.milliseconds;
  }
  return 0;
}

/// What happened between two readings.
RenderStatistics difference(RenderStatistics later, const RenderStatistics& earlier) {
  later.primaryRays -= earlier.primaryRays;
  later.bounceRays -= earlier.bounceRays;
  later.shadowRays -= earlier.shadowRays;
  later.renderSeconds -= earlier.renderSeconds;
  for (KernelStatistics& kernel : later.kernels) {
    for (const KernelStatistics& before : earlier.kernels) {
      if (before.name != kernel.name) continue;
      kernel.milliseconds -= before.milliseconds;
      kernel.dispatches -= before.dispatches;
    }
  }
  return later;
}

/// Renders one sample that is not counted (compilation, caches), then passes of more and more samples, which fill a
/// large device, for about `seconds`.
RenderStatistics measure(PathTracer& tracer, const Camera& camera, Film& film, double seconds) {
  tracer.render(camera, film, {0, 1});
  const RenderStatistics warm = tracer.statistics();
  uint32_t next = 1;
  double elapsed = 0;
  while (elapsed < seconds) {
    const uint32_t done = next - 1;
    const double wanted = elapsed > 0 ? done * (seconds - elapsed) / elapsed : 1;
    const uint32_t pass = std::clamp(static_cast<uint32_t>(wanted), 1u, std::max(1u, done));
    tracer.render(camera, film, {next, next + pass});
    next += pass;
    elapsed = tracer.statistics().renderSeconds - warm.renderSeconds;
  }
  return difference(tracer.statistics(), warm);
}

double perSecond(double rays, double milliseconds) { return milliseconds > 0 ? rays / milliseconds * 1e-3 : 0; }

struct BenchResult {
  RenderStatistics primary; ///< camera rays alone
  RenderStatistics full;

  /// Time in the intersection kernels alone. Camera and bounce rays share a kernel: the camera rays' part of its time
  /// is what a render of emission alone took for each.
  [[nodiscard]] Json mraysPerSecond() const {
    const double primaryRate =
        perSecond(static_cast<double>(primary.primaryRays), kernelMilliseconds(primary, "intersect_closest"));
    const double primaryPart = primaryRate > 0 ? static_cast<double>(full.primaryRays) / primaryRate * 1e-3 : 0;
    const double bouncePart = kernelMilliseconds(full, "intersect_closest") - primaryPart;
    return {{"primary", primaryRate},
            {"bounce", perSecond(static_cast<double>(full.bounceRays), bouncePart)},
            {"shadow", perSecond(static_cast<double>(full.shadowRays), kernelMilliseconds(full, "intersect_shadow"))}};
  }
};

Json resultJson(const BenchOptions& options, const DeviceInfo& device, const SceneStatistics& scene,
                const BenchResult& result, bool whiteEnvironment) {
  const RenderStatistics& full = result.full;
  Json kernels = Json::array();
  double total = 0;
  for (const KernelStatistics& kernel : full.kernels) {
    kernels.push_back({{"name", kernel.name},
                       {"dispatches", kernel.dispatches},
                       {"ms", kernel.milliseconds},
                       {"compile_ms", kernel.compileMilliseconds},
                       {"spirv_bytes", kernel.spirvBytes}});
    total += kernel.milliseconds;
  }
  const double rays = static_cast<double>(full.primaryRays + full.bounceRays + full.shadowRays);
  const double bytes = static_cast<double>(scene.sceneBytes + scene.bvhBytes);
  return {{"schema", 1},
          {"scene", options.scene},
          {"device", device.name},
          {"driver", device.driver},
          {"backend", backendName(options.backend)},
          {"triangles", scene.triangles},
          {"instanced_triangles", scene.instancedTriangles},
          {"image", {{"width", kWidth}, {"height", kHeight}}},
          {"white_environment_added", whiteEnvironment},
          {"mrays_per_s", result.mraysPerSecond()},
          {"mrays_per_s_all_kernels", perSecond(rays, total)},
          {"rays", {{"primary", full.primaryRays}, {"bounce", full.bounceRays}, {"shadow", full.shadowRays}}},
          {"kernels", kernels},
          {"bytes_per_path", full.bytesPerPath},
          {"bytes_per_triangle", scene.triangles > 0 ? bytes / static_cast<double>(scene.triangles) : 0.0},
          {"seconds",
           {{"bvh", scene.bvhSeconds},
            {"compile", full.compileSeconds},
            {"first_pixel", full.firstPixelSeconds},
            {"measured", full.renderSeconds}}}};
}

void printText(const Json& json) {
  fmt::print("{} on {}\n", json["scene"].get<std::string>(), json["device"].get<std::string>());
  const Json& rates = json["mrays_per_s"];
  fmt::print("Mrays/s in intersection: primary {:.2f}, bounce {:.2f}, shadow {:.2f}; in all kernels {:.2f}\n",
             rates["primary"].get<double>(), rates["bounce"].get<double>(), rates["shadow"].get<double>(),
             json["mrays_per_s_all_kernels"].get<double>());
  for (const Json& kernel : json["kernels"]) {
    fmt::print("  {:<20} {:10.2f} ms in {} dispatches\n", kernel["name"].get<std::string>(), kernel["ms"].get<double>(),
               kernel["dispatches"].get<uint64_t>());
  }
  fmt::print("{} triangles, {:.1f} bytes each with BVH; {} bytes a path; first pixel after {:.3f} s\n",
             json["triangles"].get<uint64_t>(), json["bytes_per_triangle"].get<double>(),
             json["bytes_per_path"].get<uint64_t>(), json["seconds"]["first_pixel"].get<double>());
  if (json["white_environment_added"].get<bool>())
    fmt::print("the scene has no light: a white environment was added\n");
}

/// Traces recorded rays alone.
int runRays(const BenchOptions& options) {
  const RayList list = readRays(options.rays);
  const VulkanInstance instance;
  const Device device(instance, deviceOptions(options));
  const GpuScene scene(device, loadScene(options.scene, options.environment, options.variant).scene, options.backend);
  RayTimes times = timeRays(device, scene, list, options.seconds);
  std::sort(times.seconds.begin(), times.seconds.end());
  const double median = times.seconds[times.seconds.size() / 2];
  const double rate = perSecond(static_cast<double>(list.rays.size()), median * 1e3);
  const bool closest = list.question == RayQuestion::ClosestHit;
  if (options.json) {
    const Json json = {{"schema", 1},
                       {"scene", options.scene},
                       {"device", device.info().name},
                       {"driver", device.info().driver},
                       {"backend", backendName(options.backend)},
                       {"triangles", scene.statistics().triangles},
                       {"rays_file", options.rays},
                       {"question", closest ? "closest" : "occluded"},
                       {"rays", list.rays.size()},
                       {"hits", times.hits},
                       {"repetitions", times.seconds.size()},
                       {"median_seconds", median},
                       {"mrays_per_s_of_file", rate}};
    fmt::print("{}\n", json.dump(2, ' ', false, Json::error_handler_t::replace));
  } else {
    fmt::print("{} rays ({}) of {} in {} on {}: {:.2f} Mrays/s, {} met a surface\n", list.rays.size(),
               closest ? "closest hit" : "occlusion", options.rays, options.scene, device.info().name, rate,
               times.hits);
  }
  return kDone;
}

int runBench(const BenchOptions& options) {
  if (!options.rays.empty()) return runRays(options);
  Scene asset = loadScene(options.scene, options.environment, options.variant).scene;
  const bool whiteEnvironment = !hasLight(asset);
  if (whiteEnvironment) asset.environment = Environment{.width = 1, .height = 1, .pixels = {glm::vec3(1)}};
  const View view = chooseView(asset, {}, kWidth, kHeight);

  const VulkanInstance instance;
  const Device device(instance, deviceOptions(options));
  const GpuScene scene(device, asset, options.backend);
  const FilmOptions film{.width = kWidth, .height = kHeight, .aovs = false};
  BenchResult result;
  {
    PathTracer tracer(device, scene, {.maxDepth = 0}, {.pipeline = Pipeline::Wavefront});
    Film target(device, film);
    result.primary = measure(tracer, view.camera, target, options.seconds / 4);
  }
  PathTracer tracer(device, scene, {}, {.pipeline = Pipeline::Wavefront});
  Film target(device, film);
  result.full = measure(tracer, view.camera, target, options.seconds * 3 / 4);

  const Json json = resultJson(options, device.info(), scene.statistics(), result, whiteEnvironment);
  if (options.json) {
    fmt::print("{}\n", json.dump(2, ' ', false, Json::error_handler_t::replace));
  } else {
    printText(json);
  }
  return kDone;
}

} // namespace

void addBenchCommand(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("bench", "Measure rays per second and kernel times on one scene");
  const auto options = std::make_shared<BenchOptions>();
  command->add_option("SCENE", options->scene, "glTF 2.0 file, .gltf or .glb")->required();
  command->add_flag("--json", options->json, "Machine-readable");
  command->add_option("--device", options->device, "Vulkan device by part of its name, index, or cpu")
      ->type_name("NAME|INDEX|cpu");
  addBackendFlag(*command, options->backend);
  command->add_option("--rays", options->rays, "Trace the rays of a file that bench/ recorded, and nothing else")
      ->type_name("FILE");
  addValue(
      *command, "--time", "SECONDS",
      [options](const std::string& text) { options->seconds = parseNumber(text, 0.1, 3600); },
      "How long to measure (4); compilation and a first sample come on top");
  addVariantFlag(*command, options->variant);
  addEnvironmentFlags(*command, options->environment);
  command->footer("Examples:\n  isophote bench scene.glb\n  isophote bench scene.glb --env sky.hdr --time 10 --json\n\n"
                  "The image is 640 x 360 with default settings, whatever the camera's aspect.");
  command->callback([options, &action] { action = [options] { return runBench(*options); }; });
}

} // namespace isophote::cli
