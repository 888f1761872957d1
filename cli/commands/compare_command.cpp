#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "commands/commands.hpp"
#include "exit_codes.hpp"
#include "isophote/compare.hpp"
#include "isophote/denoise.hpp"
#include "isophote/error.hpp"

namespace isophote::cli {
namespace {

struct CompareOptions {
  std::string test;
  std::string reference;
  std::string heatmap;
  std::string zMap;
  bool denoised = false;
  bool json = false;
};

/// Black over purple and orange to white, rising in lightness.
glm::vec3 heat(float value) {
  constexpr glm::vec3 kStops[] = {
      {0, 0, 0}, {0.3f, 0.05f, 0.45f}, {0.75f, 0.2f, 0.4f}, {0.98f, 0.6f, 0.3f}, {1, 1, 0.85f}};
  constexpr int kIntervals = 4;
  const float position = std::clamp(value, 0.0f, 1.0f) * kIntervals;
  const int stop = std::min(static_cast<int>(position), kIntervals - 1);
  return glm::mix(kStops[stop], kStops[stop + 1], position - static_cast<float>(stop));
}

void writeHeatmap(const std::string& file, const std::vector<float>& map, uint32_t width, uint32_t height) {
  Image image{.width = width, .height = height};
  for (const char* name : {"R", "G", "B"}) image.channels.push_back({name, std::vector<float>(map.size())});
  for (size_t i = 0; i < map.size(); ++i) {
    const glm::vec3 color = heat(map[i]);
    for (int c = 0; c < 3; ++c) image.channels[static_cast<size_t>(c)].values[i] = color[c];
  }
  writePng(file, image, 0, ToneMap::Linear); // the stops are display values
}

/// Deviations as z.{R,G,B}, or as a picture: of each pixel the channel that deviates most, red where the test is
/// brighter, blue where darker, pale below the critical deviation and full beyond it.
void writeZMap(const std::string& file, const Verdict& verdict, uint32_t width, uint32_t height) {
  const size_t pixels = size_t{width} * height;
  const bool exr = std::filesystem::path(file).extension() == ".exr";
  Image image{.width = width, .height = height};
  for (const char* name : {"R", "G", "B"})
    image.channels.push_back({exr ? std::string("z.") + name : name, std::vector<float>(pixels)});
  for (size_t i = 0; i < pixels; ++i) {
    const float* z = verdict.deviations.data() + 3 * i;
    if (exr) {
      for (size_t c = 0; c < 3; ++c) image.channels[c].values[i] = z[c];
      continue;
    }
    const float most = *std::max_element(z, z + 3, [](float a, float b) { return std::abs(a) < std::abs(b); });
    const float share = std::abs(most) / static_cast<float>(verdict.criticalDeviation);
    const glm::vec3 full = most > 0 ? glm::vec3(0.75f, 0.1f, 0.1f) : glm::vec3(0.1f, 0.25f, 0.75f);
    const glm::vec3 color = glm::mix(glm::vec3(1), full, share > 1 ? 1.0f : 0.4f * share);
    for (int c = 0; c < 3; ++c) image.channels[static_cast<size_t>(c)].values[i] = color[c];
  }
  exr ? writeExr(file, image) : writePng(file, image, 0, ToneMap::Linear);
}

/// JSON knows no NaN; null says that there is no number.
nlohmann::ordered_json numberOrNull(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

void printJson(const CompareOptions& options, const Comparison& comparison) {
  nlohmann::ordered_json json = {{"schema", 1},
                                 {"test", options.test},
                                 {"reference", options.reference},
                                 {"relMSE", numberOrNull(comparison.relMse)},
                                 {"rmse", numberOrNull(comparison.rmse)},
                                 {"psnr", numberOrNull(comparison.psnr)},
                                 {"flip", numberOrNull(comparison.flip)},
                                 {"hdr_flip", numberOrNull(comparison.hdrFlip)}};
  if (comparison.verdict) {
    json["verdict"] = {{"same", comparison.verdict->same},
                       {"p", comparison.verdict->p},
                       {"passing_fraction", comparison.verdict->passingFraction},
                       {"failing_blocks", comparison.verdict->failingBlocks},
                       {"critical_z", comparison.verdict->criticalDeviation}};
  }
  fmt::print("{}\n", json.dump(2));
}

void printText(const Comparison& comparison) {
  fmt::print("relMSE  {:.6g}\nRMSE    {:.6g}\nPSNR    {:.4g} dB\nFLIP    {:.6g}\nHDRFLIP {:.6g}\n", comparison.relMse,
             comparison.rmse, comparison.psnr, comparison.flip, comparison.hdrFlip);
  if (!comparison.verdict) {
    fmt::print("verdict none: an image has no error bars (stderr.R, .G, .B)\n");
    return;
  }
  const Verdict& verdict = *comparison.verdict;
  fmt::print("verdict {} (p = {:.3g}, {:.4f}% of the values pass, {} blocks differ)\n",
             verdict.same ? "same" : "different", verdict.p, 100 * verdict.passingFraction, verdict.failingBlocks);
}

int runCompare(const CompareOptions& options) {
  if (!options.heatmap.empty()) checkWritable(options.heatmap);
  if (!options.zMap.empty()) checkWritable(options.zMap);
  const Image image = readExr(options.test);
  const Image test = options.denoised ? denoisedImage(image) : image;
  const Comparison comparison = compareImages(test, readExr(options.reference));
  if (!options.heatmap.empty()) writeHeatmap(options.heatmap, comparison.flipMap, test.width, test.height);
  if (!options.zMap.empty()) {
    if (!comparison.verdict) throw UsageError("--z-map: an image has no error bars (stderr.R, .G, .B)");
    writeZMap(options.zMap, *comparison.verdict, test.width, test.height);
  }
  options.json ? printJson(options, comparison) : printText(comparison);
  return comparison.verdict && !comparison.verdict->same ? kFailed : kDone;
}

} // namespace

void addCompareCommand(CLI::App& program, Action& action) {
  CLI::App* command =
      program.add_subcommand("compare", "Measure how different two images are, and whether that is more than noise");
  const auto options = std::make_shared<CompareOptions>();
  command->add_option("TEST", options->test, "OpenEXR image")->required();
  command
      ->add_option("REFERENCE", options->reference,
                   "OpenEXR image of the same size; relative errors are relative to it")
      ->required();
  command->add_flag("--denoised", options->denoised,
                    "Compare TEST's denoised layer, of whose error nothing is known: no verdict");
  command->add_flag("--json", options->json, "Machine-readable");
  command->add_option("--heatmap", options->heatmap, "Write the FLIP error map as PNG, black for no difference")
      ->type_name("F.png");
  command
      ->add_option(
          "--z-map", options->zMap,
          "Write each pixel's difference in standard errors: .exr (z.R, z.G, z.B), or .png (red brighter, blue "
          "darker, full color where it fails)")
      ->type_name("F.exr|F.png");
  command->footer(R"(Examples:
  isophote compare new.exr reference.exr
  isophote compare new.exr reference.exr --json --heatmap difference.png

Where both images carry error bars, the verdict tests at family-wise significance 0.001 that they show the same: 99.9% of
the values must agree within their errors, and so must every block of 4x4 pixels and more. Exit code 0: same, or no error
bars; 1: different.)");
  command->callback([options, &action] { action = [options] { return runCompare(*options); }; });
}

} // namespace isophote::cli
