#include "support/film_truth.hpp"

#include <algorithm>
#include <cmath>

#include "shared/film_types.h"

namespace isophote::test {

FilmMeans filmMeans(const FilmSums& sums) {
  const auto* replicates = reinterpret_cast<const gpu::ReplicateSum*>(sums.replicates.data());
  const size_t pixels = sums.replicates.size() / sizeof(gpu::ReplicateSum) / gpu::kReplicateCount;
  FilmMeans means{.pixels = std::vector<glm::dvec3>(pixels)};
  double samples = 0;
  for (size_t pixel = 0; pixel < pixels; ++pixel) {
    double count = 0;
    for (size_t r = 0; r < gpu::kReplicateCount; ++r) {
      const gpu::ReplicateSum& sum = replicates[pixel * gpu::kReplicateCount + r];
      means.pixels[pixel] += glm::dvec3(double(sum.red), double(sum.green), double(sum.blue)) * sums.radiancePerUnit;
      count += sum.count;
    }
    means.pixels[pixel] /= std::max(count, 1.0);
    samples += count;
  }
  means.samples = samples / static_cast<double>(pixels);
  return means;
}

double relativeMeanSquare(const FilmMeans& means, const FilmMeans& truth) {
  double luminance = 0;
  for (const glm::dvec3& pixel : truth.pixels) luminance += glm::dot(pixel, glm::dvec3(0.2126, 0.7152, 0.0722));
  const double e = 0.01 * luminance / static_cast<double>(truth.pixels.size());
  double sum = 0;
  for (size_t pixel = 0; pixel < truth.pixels.size(); ++pixel) {
    const glm::dvec3 difference = means.pixels[pixel] - truth.pixels[pixel];
    const glm::dvec3 scale = truth.pixels[pixel] * truth.pixels[pixel] + e * e;
    for (int c = 0; c < 3; ++c) sum += difference[c] * difference[c] / scale[c];
  }
  return sum / (3 * static_cast<double>(truth.pixels.size()));
}

std::vector<double> errorsAgainstTheOthers(std::span<const FilmMeans> renders) {
  FilmMeans all{.pixels = std::vector<glm::dvec3>(renders.front().pixels.size())};
  for (const FilmMeans& render : renders) {
    all.samples += render.samples;
    for (size_t i = 0; i < all.pixels.size(); ++i) all.pixels[i] += render.samples * render.pixels[i]; // sums
  }
  std::vector<double> errors;
  for (const FilmMeans& render : renders) {
    FilmMeans others{.pixels = all.pixels, .samples = all.samples - render.samples};
    for (size_t i = 0; i < others.pixels.size(); ++i) {
      others.pixels[i] = (all.pixels[i] - render.samples * render.pixels[i]) / others.samples;
    }
    errors.push_back(std::sqrt(relativeMeanSquare(render, others) / (1 + render.samples / others.samples)));
  }
  return errors;
}

} // namespace isophote::test
