// `isophote verify`: renders parts of an image again from the receipt in its header.
#include <algorithm>
#include <bit>
#include <memory>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "commands/commands.hpp"
#include "console.hpp"
#include "exit_codes.hpp"
#include "input/scene_files.hpp"
#include "isophote/compare.hpp"
#include "isophote/error.hpp"
#include "isophote/path_tracer.hpp"
#include "isophote/version.hpp"
#include "parse.hpp"
#include "rendering/interrupt.hpp"
#include "rendering/progress_line.hpp"
#include "rendering/receipt.hpp"

namespace isophote::cli {
namespace {

constexpr uint32_t kTileSide = 16;

constexpr const char* kExamples = R"(Examples:
  isophote verify image.exr                        a few tiles
  isophote verify image.exr --tiles 1000000        all of it
  isophote verify image.exr --scene elsewhere/scene.glb

Exit code 0: the tiles match bit for bit, or, of another device or version, within their error. 1: they do not. 2: the
image has no receipt, or its scene has changed.)";

struct VerifyOptions {
  std::string image;
  uint32_t tiles = 8;
  std::optional<uint64_t> seed; ///< of the choice of tiles
  std::string scene;            ///< in place of the receipt's
  std::string device;
  bool json = false;
  bool quiet = false;
};

/// The tiles that cover `area`, in full image coordinates.
std::vector<PixelRect> tilesOf(const PixelRect& area) {
  std::vector<PixelRect> tiles;
  for (uint32_t y = area.y0; y < area.y1; y += kTileSide) {
    for (uint32_t x = area.x0; x < area.x1; x += kTileSide)
      tiles.push_back({x, y, std::min(x + kTileSide, area.x1), std::min(y + kTileSide, area.y1)});
  }
  return tiles;
}

std::vector<PixelRect> chosenTiles(const PixelRect& area, const VerifyOptions& options) {
  std::vector<PixelRect> tiles = tilesOf(area);
  std::mt19937_64 generator(options.seed ? *options.seed : std::random_device{}());
  std::shuffle(tiles.begin(), tiles.end(), generator);
  tiles.resize(std::min<size_t>(tiles.size(), options.tiles));
  return tiles;
}

/// The part of `image` that `tile` is. @param origin  of the image in the full one
Image cutOut(const Image& image, const PixelRect& tile, glm::uvec2 origin) {
  Image part{.width = tile.x1 - tile.x0, .height = tile.y1 - tile.y0};
  const auto copyRows = [&](const auto& from, auto& to) {
    for (uint32_t y = tile.y0 - origin.y; y < tile.y1 - origin.y; ++y) {
      const auto row = from.begin() + static_cast<std::ptrdiff_t>(size_t{y} * image.width + (tile.x0 - origin.x));
      to.insert(to.end(), row, row + part.width);
    }
  };
  for (const Channel& channel : image.channels)
    copyRows(channel.values, part.channels.emplace_back(Channel{channel.name, {}}).values);
  for (const IntegerChannel& channel : image.integers)
    copyRows(channel.values, part.integers.emplace_back(IntegerChannel{channel.name, {}}).values);
  return part;
}

bool sameBits(float a, float b) { return std::bit_cast<uint32_t>(a) == std::bit_cast<uint32_t>(b); }
bool sameBits(uint32_t a, uint32_t b) { return a == b; }

/// What the tiles say, pixel by pixel.
struct Findings {
  uint64_t tiles = 0;
  uint64_t pixels = 0;      ///< with all their samples
  uint64_t incomplete = 0;  ///< pixels of an interrupted render that lack some: they cannot be compared
  uint64_t differing = 0;   ///< pixels of which some bit differs
  uint64_t beyondError = 0; ///< tiles that differ by more than their error bars
  std::string firstDifference;

  [[nodiscard]] bool bitForBit() const { return differing == 0; }
  [[nodiscard]] bool withinError() const { return beyondError == 0; }
};

class Verifier {
public:
  Verifier(const Device& device, const GpuScene& scene, const Receipt& receipt, const View& view)
      : device_(device), receipt_(receipt), view_(view),
        tracer_(device, scene, receipt.settings.estimator, receipt.settings.execution) {}

  /// @return false where it was interrupted
  bool check(const Image& image, const PixelRect& tile, Findings& findings) {
    const Image stored = cutOut(image, tile, {receipt_.crop.x0, receipt_.crop.y0});
    Film film(device_, {.width = view_.width,
                        .height = view_.height,
                        .crop = tile,
                        .clampLedger = receipt_.settings.estimator.clamp < kNoClamp,
                        .depthLedger = image.find("beyond.R") != nullptr});
    for (const SampleRange& range : receipt_.samples) {
      if (!tracer_.render(view_.camera, film, range, [](const Progress&) { return !interrupted(); })) return false;
    }
    Image again = film.resolve();
    if (!stored.integers.empty()) storeSums(again, film.sums());
    compare(stored, again, tile, findings);
    return true;
  }

private:
  void compare(const Image& stored, const Image& again, const PixelRect& tile, Findings& findings) const {
    const std::vector<bool> complete = completePixels(stored, again);
    std::vector<bool> differs(complete.size(), false);
    const auto compareChannels = [&](const auto& own, const auto& others, const char* name) {
      for (size_t i = 0; i < complete.size(); ++i) {
        if (!complete[i] || differs[i] || sameBits(own.values[i], others.values[i])) continue;
        differs[i] = true;
        if (!findings.firstDifference.empty()) continue;
        findings.firstDifference =
            fmt::format("{} of pixel {},{} is {}, rendered again {}", name, tile.x0 + i % stored.width,
                        tile.y0 + i / stored.width, own.values[i], others.values[i]);
      }
    };
    for (const Channel& channel : again.channels) {
      if (const Channel* own = stored.find(channel.name)) compareChannels(*own, channel, channel.name.c_str());
    }
    for (const IntegerChannel& channel : again.integers) {
      if (const IntegerChannel* own = stored.findIntegers(channel.name))
        compareChannels(*own, channel, channel.name.c_str());
    }
    const auto count = [](const std::vector<bool>& flags) { return std::count(flags.begin(), flags.end(), true); };
    ++findings.tiles;
    findings.pixels += static_cast<uint64_t>(count(complete));
    findings.incomplete += complete.size() - static_cast<uint64_t>(count(complete));
    findings.differing += static_cast<uint64_t>(count(differs));
    if (count(differs) == 0) return;
    const auto verdict = compareImages(stored, again).verdict;
    if (!verdict || !verdict->same) ++findings.beyondError;
  }

  static std::vector<bool> completePixels(const Image& stored, const Image& again) {
    const Channel* own = stored.find("sampleCount.Y");
    const Channel* all = again.find("sampleCount.Y");
    if (own == nullptr) throw UsageError("the image lacks sampleCount.Y");
    std::vector<bool> complete;
    for (size_t i = 0; i < own->values.size(); ++i) complete.push_back(own->values[i] >= all->values[i]);
    return complete;
  }

  const Device& device_;
  const Receipt& receipt_;
  const View& view_;
  PathTracer tracer_;
};

void refuseChangedScene(const LoadedScene& loaded, const Receipt& receipt) {
  const std::string hash = hashFiles(loaded.files);
  if (hash != receipt.sceneHash)
    throw UsageError(fmt::format("{}: the scene has changed since: its hash is {}, the image's {}",
                                 loaded.files[0].string(), hash, receipt.sceneHash));
}

std::string verdictText(const Findings& findings) {
  if (findings.pixels == 0) return "nothing to compare";
  if (findings.bitForBit()) return "bit for bit";
  return findings.withinError() ? "within error" : "different";
}

void report(const VerifyOptions& options, const Findings& findings, bool sameMaker) {
  if (options.json) {
    const nlohmann::ordered_json json = {{"schema", 1},
                                         {"image", options.image},
                                         {"verdict", verdictText(findings)},
                                         {"same_device_and_version", sameMaker},
                                         {"tiles", findings.tiles},
                                         {"pixels", findings.pixels},
                                         {"incomplete_pixels", findings.incomplete},
                                         {"differing_pixels", findings.differing},
                                         {"first_difference", findings.firstDifference}};
    fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  } else if (!options.quiet) {
    fmt::print("{} tiles, {} pixels: {}\n", findings.tiles, findings.pixels, verdictText(findings));
    if (findings.incomplete > 0)
      fmt::print("{} pixels of this interrupted render lack samples and were left out\n", findings.incomplete);
  }
}

int verdictCode(const VerifyOptions& options, const Findings& findings, bool sameMaker) {
  if (findings.pixels == 0) {
    printError(options.image + ": no pixel of these tiles has all samples: nothing could be compared");
    return kFailed;
  }
  if (findings.bitForBit() || (findings.withinError() && !sameMaker)) return kDone;
  printError(fmt::format("{}: {} of {} pixels differ{}: {}", options.image, findings.differing, findings.pixels,
                         sameMaker ? " though device and version are the same" : " by more than their error",
                         findings.firstDifference));
  return kFailed;
}

int runVerify(const VerifyOptions& options) {
  catchInterrupts();
  const Image image = readExr(options.image);
  Receipt receipt = readReceipt(options.image, image);
  if (!options.scene.empty()) receipt.scene = options.scene;
  const LoadedScene loaded = loadScene(receipt.scene, receipt.environment, receipt.variant);
  refuseChangedScene(loaded, receipt);
  const View view = chooseView(loaded.scene, receipt.camera, receipt.width, receipt.height);

  const VulkanInstance instance;
  const Device device(instance, {.selector = options.device, .rayQuery = receipt.backend == Backend::RayQuery});
  const bool sameMaker =
      receipt.version == kVersion && receipt.device == fmt::format("{}, {}", device.info().name, device.info().driver);
  if (!sameMaker && !options.quiet)
    printWarning(fmt::format("the image is of version {} on {}: it can be expected to match within its error only",
                             receipt.version, receipt.device));
  const GpuScene scene(device, loaded.scene, receipt.backend);
  Verifier verifier(device, scene, receipt, view);
  const std::vector<PixelRect> tiles = chosenTiles(receipt.crop, options);
  ProgressLine line(options.quiet);
  Findings findings;
  for (const PixelRect& tile : tiles) {
    if (line.due()) line.show(fmt::format("tile {} of {}", findings.tiles + 1, tiles.size()));
    if (!verifier.check(image, tile, findings)) {
      printError("interrupted");
      return kInterrupted;
    }
  }
  line.clear();
  report(options, findings, sameMaker);
  return verdictCode(options, findings, sameMaker);
}

} // namespace

void addVerifyCommand(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("verify", "Render parts of an image again and see whether they match");
  const auto options = std::make_shared<VerifyOptions>();
  command->add_option("IMAGE", options->image, "Image written by `isophote render` or merge, .exr")->required();
  addValue(
      *command, "--tiles", "K",
      [options](const std::string& text) { options->tiles = static_cast<uint32_t>(parseUnsigned(text, 1, 1u << 28)); },
      "Tiles of 16 x 16 pixels to render, chosen at random (8)");
  addValue(
      *command, "--seed", "N", [options](const std::string& text) { options->seed = parseUnsigned(text, 0, ~0ull); },
      "Of that choice (another each time)");
  command->add_option("--scene", options->scene, "Where the scene is now (where it was)")->type_name("FILE");
  command->add_option("--device", options->device, "Vulkan device, as for render")->type_name("NAME|INDEX|cpu");
  command->add_flag("--json", options->json, "Machine-readable");
  command->add_flag("--quiet", options->quiet, "Print warnings and errors only");
  command->footer(kExamples);
  command->callback([options, &action] { action = [options] { return runVerify(*options); }; });
}

} // namespace isophote::cli
