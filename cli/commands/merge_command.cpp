// `isophote merge`: shards of one render become the image of the whole, bit for bit.
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "commands/commands.hpp"
#include "exit_codes.hpp"
#include "isophote/denoise.hpp"
#include "isophote/error.hpp"
#include "isophote/film.hpp"
#include "rendering/bias_ledger.hpp"
#include "rendering/receipt.hpp"
#include "rendering/render_report.hpp"

namespace isophote::cli {
namespace {

using Json = nlohmann::ordered_json;

struct MergeOptions {
  std::vector<std::string> inputs;
  std::string output;
  std::string device;
  LayerSettings layers;
  bool quiet = false;
};

std::string textOf(std::vector<SampleRange> ranges) {
  std::vector<std::string> parts;
  for (const SampleRange& range : ranges) parts.push_back(fmt::format("{}:{}", range.first, range.last));
  return fmt::format("{}", fmt::join(parts, ","));
}

/// Sorted, neighbors joined. @throws UsageError where two overlap
std::vector<SampleRange> joined(std::vector<SampleRange> ranges) {
  std::sort(ranges.begin(), ranges.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<SampleRange> result;
  for (const SampleRange& range : ranges) {
    if (!result.empty() && range.first < result.back().last) {
      throw UsageError(fmt::format("samples {} to {} are in two of the images", range.first,
                                   std::min(range.last, result.back().last) - 1));
    }
    if (!result.empty() && range.first == result.back().last) {
      result.back().last = range.last;
    } else {
      result.push_back(range);
    }
  }
  return result;
}

/// Adds the counters of one image's status or ledger to the other's.
void addNumbers(Json& sum, const Json& other) {
  for (const auto& [name, value] : other.items()) {
    if (!sum.contains(name)) {
      sum[name] = value;
    } else if (value.is_object()) {
      addNumbers(sum[name], value);
    } else if (value.is_number_unsigned() && name != "value") {
      sum[name] = sum[name].get<uint64_t>() + value.get<uint64_t>();
    }
  }
}

/// The images in one: what their headers must agree on, and the samples of all.
class Merger {
public:
  void add(const std::string& file) {
    const Image image = readExr(file);
    FilmSums sums;
    try {
      sums = storedSums(image);
    } catch (const UsageError& error) {
      throw UsageError(file + ": " + error.what());
    }
    const std::vector<SampleRange> samples = sampleRanges(attribute(file, image, "isophote.sampleRange"));
    if (first_.empty()) {
      first_ = file;
      attributes_ = image.attributes;
      sums_ = std::move(sums);
      ranges_ = samples;
    } else {
      checkSameRender(file, image);
      ranges_.insert(ranges_.end(), samples.begin(), samples.end());
      ranges_ = joined(std::move(ranges_));
      addSums(sums_, sums);
    }
    for (const char* name : {"isophote.status", "isophote.bias"}) {
      Json& total = name == std::string("isophote.bias") ? bias_ : status_;
      const Json own = Json::parse(attribute(file, image, name), nullptr, false);
      if (own.is_object()) addNumbers(total, own);
    }
    seconds_ += image.renderSeconds;
  }

  [[nodiscard]] Image result(const Device& device, const LayerSettings& layers) const {
    Film film(device, sums_.options);
    film.restore(sums_);
    Image image = film.resolve();
    image.attributes = attributes_;
    image.attributes["isophote.sampleRange"] = textOf(ranges_);
    image.attributes["isophote.error"] = errorText(film.error());
    image.attributes["isophote.status"] = status_.dump();
    if (layers.denoiser != Denoiser::None) addDenoised(image);
    Json ledger = bias_;
    ledger.update(biasJson({.layers = layers}));
    enterAccount(biasAccount(image), ledger);
    image.attributes["isophote.bias"] = ledger.dump();
    image.renderSeconds = seconds_;
    storeSums(image, sums_);
    return image;
  }

private:
  void checkSameRender(const std::string& file, const Image& image) const {
    for (const char* name : {"isophote.version", "isophote.sceneHash", "isophote.seed", "isophote.settings"}) {
      if (attribute(file, image, name) == attributes_.at(name)) continue;
      throw UsageError(fmt::format("{} and {} are of different renders: {} differs", first_, file, name));
    }
  }

  std::string first_;
  std::map<std::string, std::string> attributes_;
  std::vector<SampleRange> ranges_;
  FilmSums sums_;
  Json status_ = Json::object();
  Json bias_ = Json::object();
  float seconds_ = 0;
};

int runMerge(const MergeOptions& options) {
  checkWritable(options.output);
  Merger merger;
  for (const std::string& file : options.inputs) merger.add(file);
  const VulkanInstance instance({.validation = false});
  const Device device(instance, {.selector = options.device});
  const Image image = merger.result(device, options.layers);
  writeExr(options.output, image);
  if (!options.quiet) {
    fmt::print("{} images, samples {}: {}\n", options.inputs.size(), image.attributes.at("isophote.sampleRange"),
               options.output);
  }
  return kDone;
}

} // namespace

void addMergeCommand(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("merge", "Add images of different samples of one render, exactly");
  const auto options = std::make_shared<MergeOptions>();
  command->add_option("IMAGES", options->inputs, "Images written by `isophote render --sample-range`")
      ->required()
      ->expected(1, -1);
  command->add_option("-o,--output", options->output, "Image to write, .exr")->type_name("F")->required();
  command->add_option("--device", options->device, "Vulkan device, as for render")->type_name("NAME|INDEX|cpu");
  command->add_flag_callback(
      "--denoise", [options] { options->layers.denoiser = Denoiser::Atrous; },
      "Add the layer denoised.{R,G,B}, as `isophote render --denoise`");
  command->add_flag("--quiet", options->quiet, "Print warnings and errors only");
  command->footer(R"(Examples:
  isophote render scene.glb -o a.exr --sample-range 0:512         on one machine
  isophote render scene.glb -o b.exr --sample-range 512:1024      on another
  isophote merge a.exr b.exr -o image.exr                         what --spp 1024 would have given, bit for bit

The images keep their exact sums, so merged ones can be merged again, in any order.)");
  command->callback([options, &action] { action = [options] { return runMerge(*options); }; });
}

} // namespace isophote::cli
