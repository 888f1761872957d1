// The image's relative RMS error with its confidence interval, from sums made on the device.
#include <algorithm>
#include <vector>

#include "isophote/error.hpp"
#include "isophote/film.hpp"
#include "render/film_impl.hpp"
#include "render/image_error.hpp"

namespace isophote {
namespace {

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
    sums.termSquare += partial.termSquare;
    sums.untrusted += partial.untrusted;
    sums.pixels += partial.pixelCount;
    sums.untrustedPixels += partial.untrustedCount;
  }
  return sums;
}

} // namespace

ErrorEstimate Film::error(double confidence) const {
  if (!(confidence > 0 && confidence < 1)) throw UsageError("a confidence lies between 0 and 1");
  if (!impl_->scale) return {};
  if (impl_->errorPartials.bytes() == 0) {
    impl_->errorPartials = gpu::Buffer(*impl_->device, gpu::kErrorInvocations * sizeof(gpu::ErrorPartial),
                                       gpu::Memory::Device, "film.errorPartials");
  }
  // e is 1% of the mean luminance, which the first pass measures. A black image keeps a tiny e, so that 0/0 is 0.
  const ErrorSums first = sumPartials(*impl_, 1e-30);
  if (first.pixels == 0) return {};
  const double e = 0.01 * first.luminance / impl_->pixelCount();
  return imageError(sumPartials(*impl_, std::max(e * e, 1e-30)), confidence);
}

} // namespace isophote
