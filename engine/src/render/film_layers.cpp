// A film's sums as integer planes of an image.
#include <cstring>
#include <string>

#include <fmt/format.h>

#include "isophote/error.hpp"
#include "isophote/film.hpp"
#include "render/film_head.hpp"
#include "shared/film_types.h"

namespace isophote {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kAttribute = "isophote.sums";
constexpr size_t kReplicateWords = gpu::kReplicateCount * sizeof(gpu::ReplicateSum) / sizeof(uint32_t);
constexpr size_t kAovWords = sizeof(gpu::AovSum) / sizeof(uint32_t);
constexpr size_t kRemovedWords = sizeof(gpu::RemovedSum) / sizeof(uint32_t);

std::string layerName(const char* group, size_t word) { return fmt::format("sums.{}.{:02}", group, word); }

/// One plane for each word of a record of `words`.
void scatter(const std::vector<std::byte>& records, size_t words, const char* group, Image& image) {
  const size_t pixels = records.size() / (words * sizeof(uint32_t));
  for (size_t word = 0; word < words; ++word) {
    IntegerChannel channel{layerName(group, word), std::vector<uint32_t>(pixels)};
    for (size_t pixel = 0; pixel < pixels; ++pixel) {
      std::memcpy(&channel.values[pixel], records.data() + (pixel * words + word) * sizeof(uint32_t), sizeof(uint32_t));
    }
    image.integers.push_back(std::move(channel));
  }
}

std::vector<std::byte> gather(const Image& image, size_t words, const char* group) {
  const size_t pixels = size_t{image.width} * image.height;
  std::vector<std::byte> records(pixels * words * sizeof(uint32_t));
  for (size_t word = 0; word < words; ++word) {
    const std::string name = layerName(group, word);
    const IntegerChannel* channel = image.findIntegers(name);
    if (channel == nullptr) throw UsageError("the layer " + name + " is missing");
    for (size_t pixel = 0; pixel < pixels; ++pixel) {
      std::memcpy(records.data() + (pixel * words + word) * sizeof(uint32_t), &channel->values[pixel],
                  sizeof(uint32_t));
    }
  }
  return records;
}

} // namespace

void storeSums(Image& image, const FilmSums& sums) {
  image.attributes[kAttribute] = filmHead(sums).dump();
  scatter(sums.replicates, kReplicateWords, "replicates", image);
  if (!sums.aovs.empty()) scatter(sums.aovs, kAovWords, "aovs", image);
  if (!sums.clamped.empty()) scatter(sums.clamped, kRemovedWords, "clamped", image);
  if (!sums.beyond.empty()) scatter(sums.beyond, kRemovedWords, "beyond", image);
}

FilmSums storedSums(const Image& image) {
  const auto head = image.attributes.find(kAttribute);
  if (head == image.attributes.end()) {
    throw UsageError("no exact sums in it: images to merge are rendered with --sample-range");
  }
  FilmSums sums;
  try {
    sums = filmFromHead(Json::parse(head->second));
  } catch (const std::exception& error) {
    throw UsageError(std::string(kAttribute) + ": " + error.what());
  }
  const PixelRect& crop = sums.options.crop;
  if (crop.x1 - crop.x0 != image.width || crop.y1 - crop.y0 != image.height) {
    throw UsageError(std::string(kAttribute) + ": of another size than the image");
  }
  sums.replicates = gather(image, kReplicateWords, "replicates");
  if (sums.options.aovs) sums.aovs = gather(image, kAovWords, "aovs");
  if (sums.options.clampLedger) sums.clamped = gather(image, kRemovedWords, "clamped");
  if (sums.options.depthLedger) sums.beyond = gather(image, kRemovedWords, "beyond");
  return sums;
}

} // namespace isophote
