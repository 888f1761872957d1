// Exact sums -> the float channels of an image, in double on the host.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "isophote/film.hpp"
#include "render/film_impl.hpp"
#include "render/pixel_error.hpp"

namespace isophote {
namespace {

void resolveRadiance(const FilmSums& film, Image& image) {
  const auto* sums = reinterpret_cast<const gpu::ReplicateSum*>(film.replicates.data());
  const size_t pixels = film.replicates.size() / sizeof(gpu::ReplicateSum) / gpu::kReplicateCount;
  const double perUnit = film.radiancePerUnit;
  constexpr std::array<const char*, 3> kColors = {"R", "G", "B"};
  for (const char* color : kColors) image.channels.push_back({color, std::vector<float>(pixels)});
  image.channels.push_back({"A", std::vector<float>(pixels)});
  for (const char* color : kColors)
    image.channels.push_back({std::string("stderr.") + color, std::vector<float>(pixels)});
  for (const char* color : kColors)
    image.channels.push_back({std::string("ci95.") + color, std::vector<float>(pixels)});
  image.channels.push_back({"sampleCount.Y", std::vector<float>(pixels)});
  image.channels.push_back({"trust.Y", std::vector<float>(pixels)});
  for (size_t pixel = 0; pixel < pixels; ++pixel) {
    const gpu::ReplicateSum* sum = sums + pixel * gpu::kReplicateCount;
    std::array<std::array<int64_t, gpu::kReplicateCount>, 3> values{};
    std::array<uint32_t, gpu::kReplicateCount> counts{};
    uint64_t samples = 0;
    uint64_t hits = 0;
    for (uint32_t r = 0; r < gpu::kReplicateCount; ++r) {
      values[0][r] = sum[r].red;
      values[1][r] = sum[r].green;
      values[2][r] = sum[r].blue;
      counts[r] = sum[r].count;
      samples += sum[r].count;
      hits += sum[r].hitCount;
    }
    double largestShare = 0;
    for (size_t c = 0; c < 3; ++c) {
      const PixelError mean = pixelError(values[c], counts, perUnit);
      largestShare = std::max(largestShare, mean.largestShare);
      image.channels[c].values[pixel] = static_cast<float>(mean.mean);
      image.channels[4 + c].values[pixel] = static_cast<float>(mean.standardError);
      image.channels[7 + c].values[pixel] = static_cast<float>(mean.halfWidth95);
    }
    const double coverage = samples > 0 ? static_cast<double>(hits) / static_cast<double>(samples) : 0.0;
    image.channels[3].values[pixel] = static_cast<float>(coverage);
    image.channels[10].values[pixel] = static_cast<float>(samples);
    image.channels[11].values[pixel] = static_cast<float>(trust(largestShare));
  }
}

void resolveAovs(const FilmSums& film, Image& image) {
  const auto* sums = reinterpret_cast<const gpu::AovSum*>(film.aovs.data());
  const size_t pixels = film.aovs.size() / sizeof(gpu::AovSum);
  const size_t first = image.channels.size();
  for (const char* name : {"albedo.R", "albedo.G", "albedo.B", "normal.X", "normal.Y", "normal.Z", "depth.Z",
                           "position.X", "position.Y", "position.Z"}) {
    image.channels.push_back({name, std::vector<float>(pixels)});
  }
  if (!(film.radiancePerUnit > 0)) return;
  const double unit = std::ldexp(1.0, -static_cast<int>(gpu::kRadianceFractionBits));
  const double length = film.lengthPerUnit;
  for (size_t pixel = 0; pixel < pixels; ++pixel) {
    const gpu::AovSum& sum = sums[pixel];
    if (sum.count == 0) continue;
    const auto set = [&](size_t channel, double value) {
      image.channels[first + channel].values[pixel] = static_cast<float>(value);
    };
    glm::dvec3 normal;
    for (int c = 0; c < 3; ++c) {
      set(static_cast<size_t>(c), static_cast<double>(sum.albedo[c]) * unit / sum.count);
      normal[c] = static_cast<double>(sum.normal[c]);
      set(static_cast<size_t>(7 + c), static_cast<double>(sum.position[c]) * length / sum.count + film.worldOrigin[c]);
    }
    if (glm::length(normal) > 0) normal = glm::normalize(normal);
    for (int c = 0; c < 3; ++c) set(static_cast<size_t>(3 + c), normal[c]);
    set(6, static_cast<double>(sum.depth) * length / sum.count);
  }
}

// Mean radiance that a setting took from a sample of each pixel; after resolveRadiance.
void resolveRemoved(const FilmSums& film, const std::vector<std::byte>& removedSums, const char* layer, Image& image) {
  const auto* sums = reinterpret_cast<const gpu::RemovedSum*>(removedSums.data());
  const size_t pixels = removedSums.size() / sizeof(gpu::RemovedSum);
  const std::vector<float> counts = image.find("sampleCount.Y")->values;
  const size_t first = image.channels.size();
  for (const char* color : {".R", ".G", ".B"})
    image.channels.push_back({std::string(layer) + color, std::vector<float>(pixels)});
  for (size_t pixel = 0; pixel < pixels; ++pixel) {
    if (counts[pixel] == 0) continue;
    const int64_t removed[3] = {sums[pixel].red, sums[pixel].green, sums[pixel].blue};
    for (size_t c = 0; c < 3; ++c) {
      image.channels[first + c].values[pixel] =
          static_cast<float>(static_cast<double>(removed[c]) * film.radiancePerUnit / double(counts[pixel]));
    }
  }
}

} // namespace

Image Film::resolve() const {
  Image image;
  image.width = impl_->cropWidth;
  image.height = impl_->cropHeight;
  const FilmSums film = sums();
  resolveRadiance(film, image);
  if (!film.clamped.empty()) resolveRemoved(film, film.clamped, "clamped", image);
  if (!film.beyond.empty()) resolveRemoved(film, film.beyond, "beyond", image);
  if (!film.aovs.empty()) resolveAovs(film, image);
  return image;
}

} // namespace isophote
