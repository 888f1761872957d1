#include "fuzz/fuzz_target.hpp"

#include <array>
#include <sstream>
#include <vector>

#include <zlib.h>

#include "isophote/checkpoint.hpp"
#include "isophote/error.hpp"
#include "isophote/film.hpp"
#include "isophote/gltf.hpp"
#include "isophote/image.hpp"
#include "parse.hpp"
#include "scene/image_decode.hpp"
#include "setting_table.hpp"
#include "upload/pack_scene.hpp"

namespace isophote::fuzz {
namespace {

using test::TemporaryFolder;

/// Small enough for a hundred inputs a second, whatever they ask for.
const LoadOptions kLimits{.maxImagePixels = 1 << 16, .maxBufferBytes = 1 << 24, .maxNodes = 1000};

/// A glTF scene up to what would be uploaded.
void readScene(const TemporaryFolder& folder, const std::string& bytes) {
  const Scene scene = loadGltf(folder.write("asset.gltf", bytes), kLimits);
  (void)framingCamera(scene, 1);
  (void)packScene(scene);
}

/// The image of a texture: PNG, JPEG or WebP.
void readTexture(const TemporaryFolder&, const std::string& bytes) {
  const auto span = std::as_bytes(std::span(bytes));
  if (!imageFormat(span)) throw Error("no image");
  ImageData image;
  DecodeProblem problem = readImageHeader(span, kLimits.maxImagePixels, image);
  if (!problem.any()) problem = decodeImage(span, image);
  if (problem.any()) throw Error(problem.broken + problem.tooLarge);
}

void readEnvironment(const TemporaryFolder& folder, const std::string& bytes) {
  std::vector<std::string> warnings;
  (void)loadEnvironment(folder.write("environment", bytes), warnings);
}

/// An OpenEXR image as `isophote merge` takes it.
void readFilm(const TemporaryFolder& folder, const std::string& bytes) {
  (void)storedSums(readExr(folder.write("image.exr", bytes)));
}

/// A checkpoint whose checksum is always right, or no damage would get past it.
void readSums(const TemporaryFolder& folder, const std::string& bytes) {
  const auto checksum = static_cast<uint32_t>(
      crc32_z(crc32_z(0, nullptr, 0), reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
  (void)readCheckpoint(
      folder.write("checkpoint", bytes + std::string(reinterpret_cast<const char*>(&checksum), sizeof(checksum))));
}

/// What people type: a line each, of `key=value` or of a flag's value.
void readSettings(const TemporaryFolder&, const std::string& bytes) {
  std::istringstream lines(bytes);
  cli::Settings settings;
  bool refused = false;
  const auto attempt = [&](auto&& parse) {
    try {
      parse();
    } catch (const UsageError&) {
      refused = true;
    }
  };
  for (std::string line; std::getline(lines, line);) {
    attempt([&] { cli::setSetting(settings, line); });
    attempt([&] { (void)cli::parseSampleRange(line); });
    attempt([&] { (void)cli::parseCrop(line); });
    attempt([&] { (void)cli::parseColor(line); });
    attempt([&] { (void)cli::parseSky(line); });
    attempt([&] { (void)cli::parseShare(line); });
  }
  (void)cli::settingsJson(settings, cli::SettingKind::Estimator)
      .dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  if (refused) throw UsageError("refused");
}

constexpr std::array kTargets{
    FuzzTarget{"scene", readScene}, FuzzTarget{"texture", readTexture}, FuzzTarget{"environment", readEnvironment},
    FuzzTarget{"film", readFilm},   FuzzTarget{"checkpoint", readSums}, FuzzTarget{"settings", readSettings},
};

} // namespace

std::span<const FuzzTarget> fuzzTargets() { return kTargets; }

bool accepts(const FuzzTarget& target, const TemporaryFolder& folder, const std::string& bytes) {
  try {
    target.read(folder, bytes);
    return true;
  } catch (const Error&) {
    return false;
  }
}

} // namespace isophote::fuzz
