// Rays per second of the intersection kernels, side by side with Embree, ray query, and kernels of another build.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <memory>
#include <optional>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#ifdef ISOPHOTE_HAS_EMBREE
#include "embree_tracer.hpp"
#endif
#include "cli/input/scene_source.hpp"
#include "isophote/device.hpp"
#include "isophote/error.hpp"
#include "isophote/gpu_scene.hpp"
#include "ratio.hpp"
#include "record_rays.hpp"
#include "render/ray_batch.hpp"
#include "shared/geometry_types.h"
#include "world_triangles.hpp"

using namespace isophote;
using namespace isophote::bench;
using Json = nlohmann::ordered_json;

namespace {

struct Options {
  std::string scene;
  cli::EnvironmentOptions environment;
  std::string device;
  uint32_t width = 640;
  uint32_t height = 360;
  uint32_t bounces = 4;
  uint32_t repetitions = 11;
  std::string saveRays;
  std::string against;
  bool rayQuery = false;
  bool fastBuild = false;
};

// Embree's edges are not watertight and its arithmetic is another: so many rays may meet something else.
constexpr double kAllowedMismatches = 1e-3;

struct Contender {
  std::string name;
  std::function<void()> prepare; ///< not timed
  std::function<void()> trace;
  std::vector<double> wallSeconds;
  std::vector<double> cpuSeconds; ///< of all threads: on a machine with other work the steadier of the two
};

double processSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

void runOnce(Contender& contender) {
  contender.prepare();
  const double cpu = processSeconds();
  const auto start = std::chrono::steady_clock::now();
  contender.trace();
  contender.wallSeconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  contender.cpuSeconds.push_back(std::max(processSeconds() - cpu, 1e-6));
}

/// Rounds of all contenders, forwards and backwards in turn, after one round that does not count.
void race(std::vector<Contender>& contenders, uint32_t rounds) {
  for (uint32_t round = 0; round <= rounds; ++round) {
    if (round % 2 == 0) {
      std::for_each(contenders.begin(), contenders.end(), runOnce);
    } else {
      std::for_each(contenders.rbegin(), contenders.rend(), runOnce);
    }
    if (round != 0) continue;
    for (Contender& contender : contenders) {
      contender.wallSeconds.clear();
      contender.cpuSeconds.clear();
    }
  }
}

std::vector<uint32_t> readSpirv(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file) throw Error(path.string() + ": no such file");
  std::vector<uint32_t> words(static_cast<size_t>(file.tellg()) / sizeof(uint32_t));
  file.seekg(0);
  file.read(reinterpret_cast<char*>(words.data()), static_cast<std::streamsize>(words.size() * sizeof(uint32_t)));
  return words;
}

/// The scene put on the device in another way than the renderer's default.
struct Rival {
  const char* name;
  GpuScene scene;
  WorldTriangles triangles;
};

/// A scene as its triangles are numbered on the device.
struct Numbered {
  const RayBatch& batch;
  const WorldTriangles& triangles;
};

/// Rays that the two answer otherwise, but for surfaces at the same distance.
uint64_t mismatches(const RayList& list, const Numbered& a, const Numbered& b) {
  const std::vector<bool> metA = a.batch.met(), metB = b.batch.met();
  uint64_t count = 0;
  for (size_t i = 0; i < metA.size(); ++i) count += metA[i] != metB[i];
  if (list.question == RayQuestion::Occluded) return count;
  const std::vector<gpu::HitState> hitsA = a.batch.hits(), hitsB = b.batch.hits();
  const auto distance = [&](const Numbered& side, const gpu::HitState& hit, const Ray& ray) {
    const glm::vec3* corners = &side.triangles.corners[3 * size_t{side.triangles.number(hit.instance, hit.triangle)}];
    return planeDistance({corners[0], corners[1], corners[2]}, ray.origin, ray.direction);
  };
  for (size_t i = 0; i < metA.size(); ++i) {
    if (!metA[i] || !metB[i]) continue;
    const double t = distance(a, hitsA[i], list.rays[i]);
    count += !(std::abs(t - distance(b, hitsB[i], list.rays[i])) <= 1e-4 * std::max(1.0, std::abs(t)));
  }
  return count;
}

#ifdef ISOPHOTE_HAS_EMBREE
/// Rays for which the two disagree about what they meet, other than between surfaces at the same distance.
uint64_t mismatches(const RayBatch& batch, const RayList& list, const std::vector<EmbreeHit>& other,
                    const WorldTriangles& triangles) {
  uint64_t count = 0;
  if (list.question == RayQuestion::Occluded) {
    const std::vector<bool> met = batch.met();
    for (size_t i = 0; i < met.size(); ++i) count += met[i] != (other[i].triangle != kNothingMet);
    return count;
  }
  const std::vector<gpu::HitState> hits = batch.hits();
  for (size_t i = 0; i < hits.size(); ++i) {
    const bool met = hits[i].instance != gpu::kInvalidIndex;
    if (met != (other[i].triangle != kNothingMet)) {
      ++count;
    } else if (met) {
      const uint32_t number = triangles.number(hits[i].instance, hits[i].triangle);
      if (number == other[i].triangle) continue;
      const glm::vec3* corners = &triangles.corners[3 * size_t{number}];
      const double t = planeDistance({corners[0], corners[1], corners[2]}, list.rays[i].origin, list.rays[i].direction);
      count += !(std::abs(t - other[i].t) <= 1e-4 * std::max(1.0, std::abs(t)));
    }
  }
  return count;
}
#endif

Json ratioJson(const Ratio& ratio) { return {{"median", ratio.median}, {"low", ratio.low}, {"high", ratio.high}}; }

void run(const Options& options) {
  Scene asset = cli::loadScene(options.scene, options.environment, std::nullopt).scene;
  if (!cli::hasLight(asset)) asset.environment = Environment{.width = 1, .height = 1, .pixels = {glm::vec3(1)}};
  // Embree knows no alpha here: a blended surface that lets a ray pass would be met by Embree alone.
  for (Material& material : asset.materials) material.alphaMode = AlphaMode::Opaque;
  const cli::View view = cli::chooseView(asset, cli::CameraOptions{}, options.width, options.height);
  const VulkanInstance instance;
  const Device device(instance, {.selector = options.device, .rayQuery = options.rayQuery});
  const GpuScene scene(device, asset);
  const auto recorded = recordRays(device, scene, view.camera, options.width, options.height, options.bounces);
  const std::string stem = std::filesystem::path(options.scene).stem().string();
  const WorldTriangles triangles = worldTriangles(asset, Backend::Compute, BvhBuild::FastTrace);
  std::vector<Rival> rivals;
  const auto addRival = [&](const char* name, Backend backend, BvhBuild build) {
    rivals.push_back({name, GpuScene(device, asset, backend, build), worldTriangles(asset, backend, build)});
  };
  if (options.rayQuery) addRival("ray-query", Backend::RayQuery, BvhBuild::FastTrace);
  if (options.fastBuild) addRival("fast-build", Backend::Compute, BvhBuild::FastBuild);
#ifdef ISOPHOTE_HAS_EMBREE
  const EmbreeTracer embree(triangles.corners);
#endif

  for (const NamedRays& rays : recorded) {
    if (!options.saveRays.empty()) {
      std::filesystem::create_directories(options.saveRays);
      writeRays(std::filesystem::path(options.saveRays) / (stem + "-" + rays.name + ".rays"), rays.list);
    }
    if (rays.list.rays.empty()) continue;
    Json json = {{"scene", stem},
                 {"device", device.info().name},
                 {"driver", device.info().driver},
                 {"triangles", scene.statistics().triangles},
                 {"rays_of", rays.name},
                 {"rays", rays.list.rays.size()},
                 {"bvh_seconds", scene.statistics().bvhSeconds}};
    std::vector<Contender> contenders;
    RayBatch own(device, scene, rays.list);
    contenders.push_back({"isophote", [&] { own.reset(); }, [&] { own.trace(); }, {}, {}});
    std::optional<RayBatch> variant;
    std::vector<uint32_t> words;
    if (!options.against.empty()) {
      const bool closest = rays.list.question == RayQuestion::ClosestHit;
      words = readSpirv(std::filesystem::path(options.against) /
                        (closest ? "intersect_closest.spv" : "intersect_shadow.spv"));
      const gpu::KernelSource source{.name = "variant", .spirv = words};
      variant.emplace(device, scene, rays.list, &source);
      contenders.push_back({"against", [&] { variant->reset(); }, [&] { variant->trace(); }, {}, {}});
    }
    std::vector<std::unique_ptr<RayBatch>> batches; // of rivals
    for (const Rival& rival : rivals) {
      RayBatch& batch = *batches.emplace_back(std::make_unique<RayBatch>(device, rival.scene, rays.list));
      contenders.push_back({rival.name, [&batch] { batch.reset(); }, [&batch] { batch.trace(); }, {}, {}});
      json["build_seconds_of"][rival.name] = rival.scene.statistics().bvhSeconds;
    }
#ifdef ISOPHOTE_HAS_EMBREE
    std::vector<EmbreeHit> single, packet;
    contenders.push_back({"embree1", [] {}, [&] { embree.trace(rays.list, false, single); }, {}, {}});
    contenders.push_back({"embree8", [] {}, [&] { embree.trace(rays.list, true, packet); }, {}, {}});
    json["embree_build_seconds"] = embree.buildSeconds();
#endif
    race(contenders, options.repetitions);
#ifdef ISOPHOTE_HAS_EMBREE
    const uint64_t wrong = mismatches(own, rays.list, single, triangles);
    json["mismatches"] = wrong;
    if (static_cast<double>(wrong) > kAllowedMismatches * static_cast<double>(rays.list.rays.size()) + 1) {
      throw Error(
          fmt::format("{} of {} rays of {} meet something else in Embree", wrong, rays.list.rays.size(), rays.name));
    }
#endif
    for (size_t i = 0; i < rivals.size(); ++i) {
      const uint64_t others = mismatches(rays.list, {own, triangles}, {*batches[i], rivals[i].triangles});
      json["mismatches_of"][rivals[i].name] = others;
      if (static_cast<double>(others) > kAllowedMismatches * static_cast<double>(rays.list.rays.size()) + 1)
        throw Error(fmt::format("{} of {} rays of {} meet something else by {}", others, rays.list.rays.size(),
                                rays.name, rivals[i].name));
    }
    if (variant && variant->met() != own.met()) throw Error("the kernels of --against give other hits");
    const auto count = static_cast<double>(rays.list.rays.size());
    const Contender& first = contenders.front();
    for (const Contender& contender : contenders) {
      json["mrays_per_s"][contender.name] = count / median(contender.wallSeconds) * 1e-6;
      json["mrays_per_cpu_second"][contender.name] = count / median(contender.cpuSeconds) * 1e-6;
      if (&contender == &first) continue;
      json["speed_relative_to"][contender.name] = ratioJson(pairedRatio(contender.wallSeconds, first.wallSeconds));
      json["cpu_speed_relative_to"][contender.name] = ratioJson(pairedRatio(contender.cpuSeconds, first.cpuSeconds));
    }
    std::cout << json.dump() << std::endl;
  }
}

} // namespace

int main(int argc, char** argv) {
  CLI::App program(
      "Traces recorded rays in Isophote's kernels, in Embree and by ray query; one JSON line a kind of ray");
  Options options;
  program.add_option("SCENE", options.scene, "glTF 2.0 file")->required();
  program.add_option("--device", options.device, "as for isophote render");
  program.add_option("--width", options.width, "camera rays a row");
  program.add_option("--height", options.height, "rows");
  program.add_option("--bounces", options.bounces, "generations after the camera rays");
  program.add_option("--repetitions", options.repetitions, "rounds that count")->check(CLI::Range(1, 1000));
  program.add_option("--save-rays", options.saveRays, "folder for the rays, for isophote bench --rays");
  program.add_option("--against", options.against, "folder with SPIR-V of another build that reads the same layout");
  program.add_flag("--ray-query", options.rayQuery, "also trace through the device's acceleration structures");
  program.add_flag("--fast-build", options.fastBuild, "also trace through trees of bvh-build=fast-build");
  cli::addEnvironmentFlags(program, options.environment);
  CLI11_PARSE(program, argc, argv);
  try {
    run(options);
  } catch (const std::exception& error) {
    std::cerr << "isophote_bench: " << error.what() << "\n";
    return 1;
  }
  return 0;
}
