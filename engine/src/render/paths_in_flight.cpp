#include "render/paths_in_flight.hpp"

#include <algorithm>
#include <bit>
#include <string>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

#include "gpu/cache_file.hpp"

namespace isophote {
namespace {

using Json = nlohmann::json;

// The first submits of a turn still carry, or lack, the other count's paths.
constexpr uint32_t kSettling = 2;
constexpr uint32_t kTurn = 5;
constexpr size_t kMeasured = 12; // of each
// Less is noise.
constexpr double kWorthwhile = 1.01;

// llvmpipe: the fused kernel's state stays in a core's caches, the wavefront's dispatches each end with a wait
// (docs/performance.md, "Paths in flight").
constexpr uint32_t kFusedPathsPerCore = 1u << 12;
constexpr uint32_t kWavefrontPathsPerCore = 1u << 14;
constexpr uint32_t kGpuPaths = 1u << 20;
constexpr uint32_t kMostPaths = 1u << 22;
// A pool takes 160 to 300 bytes a path, so at most about a 64th of the memory.
constexpr uint64_t kMemoryPerPath = 16384;
constexpr uint32_t kSearchedRange = 8;

constexpr uint64_t kMostFileBytes = 4096;

const char* keyOf(Pipeline pipeline) { return pipeline == Pipeline::Fused ? "fused" : "wavefront"; }

std::filesystem::path fileOf(const Device& device) { return gpu::cacheFile(device.physical(), ".json"); }

// An object always; an empty one where there is no file, or another program's.
Json readFile(const std::filesystem::path& file) {
  const std::vector<char> text = gpu::readCacheFile(file, kMostFileBytes);
  Json found = Json::parse(text.begin(), text.end(), nullptr, false);
  return found.is_object() ? found : Json::object();
}

} // namespace

PathsInFlight::PathsInFlight(uint32_t first, uint32_t fewest, uint32_t most)
    : fewest_(fewest), most_(most), best_(first) {
  challenge();
}

// The next rival in this direction; none: the other direction, unless this one has helped.
void PathsInFlight::challenge() {
  bestSpeeds_ = {};
  rivalSpeeds_ = {};
  submits_ = 0;
  rivalsTurn_ = false;
  if (halving_ && best_ / 2 >= fewest_) {
    rival_ = best_ / 2;
    return;
  }
  if (halving_ && !halfHasWon_) halving_ = false;
  settled_ = halving_ || best_ > most_ / 2;
  rival_ = settled_ ? best_ : best_ * 2;
}

void PathsInFlight::decide() {
  if (rivalSpeeds_.median() > kWorthwhile * bestSpeeds_.median()) {
    best_ = rival_;
    halfHasWon_ = halfHasWon_ || halving_;
    challenge();
  } else if (halving_ && !halfHasWon_) {
    halving_ = false;
    challenge();
  } else {
    rivalsTurn_ = false;
    settled_ = true;
  }
}

void PathsInFlight::add(uint64_t rays, double milliseconds) {
  if (settled_) return;
  if (++submits_ > kSettling) (rivalsTurn_ ? rivalSpeeds_ : bestSpeeds_).add(rays, milliseconds);
  if (submits_ < kTurn) return;
  submits_ = 0;
  rivalsTurn_ = !rivalsTurn_;
  if (rivalSpeeds_.count() >= kMeasured) decide();
}

PathsRange pathsRange(const Device& device, Pipeline pipeline) {
  if (!device.isCpu()) {
    const uint64_t room = std::bit_floor(device.info().memoryBytes / kMemoryPerPath);
    const auto most = static_cast<uint32_t>(std::clamp<uint64_t>(room, kGpuPaths / kSearchedRange, kMostPaths));
    const uint32_t first = std::min(kGpuPaths, most);
    return {.fewest = first / kSearchedRange, .most = most, .first = first};
  }
  // One pool serves both, and is as large as the wavefront wants it.
  const uint32_t cores = std::bit_floor(std::clamp(std::thread::hardware_concurrency(), 1u, 128u));
  const uint32_t most = cores * kWavefrontPathsPerCore;
  return {.fewest = most / (2 * kSearchedRange),
          .most = most,
          .first = pipeline == Pipeline::Fused ? cores * kFusedPathsPerCore : most};
}

PathsInFlight recallPathsInFlight(const Device& device, Pipeline pipeline) {
  const PathsRange range = pathsRange(device, pipeline);
  const Json kept = readFile(fileOf(device));
  // The same driver may have had fewer cores to run on.
  const Json::json_pointer place(std::string("/paths_in_flight/") + keyOf(pipeline) + "/of_" +
                                 std::to_string(range.most));
  if (!kept.contains(place) || !kept[place].is_number_unsigned()) return {range.first, range.fewest, range.most};
  const uint64_t count = kept[place].get<uint64_t>();
  if (count < range.fewest || count > range.most) return {range.first, range.fewest, range.most};
  return PathsInFlight(static_cast<uint32_t>(count));
}

void rememberPathsInFlight(const Device& device, Pipeline pipeline, uint32_t count) noexcept {
  try {
    const std::filesystem::path file = fileOf(device);
    if (file.empty()) return;
    Json kept = readFile(file);
    Json found;
    found["paths_in_flight"][keyOf(pipeline)]["of_" + std::to_string(pathsRange(device, pipeline).most)] = count;
    kept.merge_patch(found);
    const std::string text = kept.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
    gpu::replaceCacheFile(file, {text.begin(), text.end()});
  } catch (...) {
    // Out of memory, or a path the file system refuses: the next run searches again.
  }
}

} // namespace isophote
