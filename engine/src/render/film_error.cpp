// The image's relative RMS error with its confidence interval, from sums made on the device.
#include <cmath>
#include <vector>

#include "isophote/film.hpp"
#include "render/film_impl.hpp"

namespace isophote {
namespace {

struct ErrorSums {
  double luminance = 0;
  double relativeSquare = 0;
  double spread = 0;
  uint64_t pixels = 0;
};

ErrorSums sumPartials(const Film::Impl& film, double epsilonSquare) {
  gpu::FilmArgs args = film.arguments(film.errorPartials.address());
  args.epsilonSquare = static_cast<float>(epsilonSquare);
  film.run(film.errorKernel, "film_error", args, gpu::kErrorInvocations);
  std::vector<gpu::ErrorPartial> partials(gpu::kErrorInvocations);
  gpu::readBuffer(*film.device, film.errorPartials, 0, std::as_writable_bytes(std::span(partials)));
  ErrorSums sums;
  for (const auto& partial : partials) {
    sums.luminance += partial.luminance;
    sums.relativeSquare += partial.relativeSquare;
    sums.spread += partial.spread;
    sums.pixels += partial.pixelCount;
  }
  return sums;
}

} // namespace

ErrorEstimate Film::error() const {
  if (!impl_->scale) return {};
  if (impl_->errorPartials.bytes() == 0) {
    impl_->errorPartials = gpu::Buffer(*impl_->device, gpu::kErrorInvocations * sizeof(gpu::ErrorPartial),
                                       gpu::Memory::Device, "film.errorPartials");
  }
  // e is 1% of the mean luminance, which the first pass measures. A black image keeps a tiny e, so that 0/0 is 0.
  const ErrorSums first = sumPartials(*impl_, 1e-30);
  if (first.pixels == 0) return {};
  const double e = 0.01 * first.luminance / impl_->pixelCount();
  const ErrorSums sums = sumPartials(*impl_, std::max(e * e, 1e-30));
  const double count = 3.0 * static_cast<double>(sums.pixels);
  const double relMse = sums.relativeSquare / count;
  const double halfWidth = 1.959964 * std::sqrt(sums.spread) / count; // normal: a sum over many independent pixels
  return {.value = std::sqrt(relMse),
          .lower = std::sqrt(std::max(0.0, relMse - halfWidth)),
          .upper = std::sqrt(relMse + halfWidth),
          .known = true};
}

} // namespace isophote
