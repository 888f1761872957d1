// The error of a way to render, split into noise and bias.
#pragma once

#include <cstdint>
#include <vector>

#include "isophote/image.hpp"
#include "isophote/interval.hpp"

namespace isophote {

/// Squares are relative to the reference: means over pixels and channels of d^2 / (r^2 + e^2), r the reference and e 1%
/// of its mean luminance, which is the metric of ErrorEstimate. Intervals have 95% confidence.
struct ErrorSplit {
  uint32_t runs = 0;
  Interval
      noiseSquare; ///< of one run: by its own error bars, or without them by how runs differ; known from two runs on
  Interval biasSquare;             ///< unbiased, so that it may be negative; nothing is known below two runs
  Interval totalSquare;            ///< of one run, noise and bias together; unbiased
  Interval brightness;             ///< (mean of the runs - mean of the reference) / mean of the reference
  double biasDeviations = 0;       ///< biasSquare over its standard error
  double brightnessDeviations = 0; ///< brightness over its standard error
};

/// Takes runs that differ in their seed alone, all with error bars or all without (as of a filtered image). Without,
/// half the squared difference to the run before is the noise of a run; the first two share theirs.
///
/// With D_k the difference of run k to the reference, whose squared standard error is v, E[D_k D_l] = bias^2 + v for k
/// != l: the mean of those products, less v, estimates the squared bias without bias. Pixels are independent, so the
/// spread over pixels gives its standard error; it holds the spread of the bias itself too, and is rather too wide. A
/// few bright pixels that dominate make the normal interval too narrow. Brightness takes pixels that are not trusted
/// with their widened error. Filtered pixels hang together, which the interval of their bias does not know: rather take
/// it as a lower bound of the width. The reference's noise is in the weights too: with v relative and b the mean
/// relative bias that shifts the squared bias by about 4 b v + 6 v^2.
class ErrorSplitter {
public:
  /// @throws UsageError where the reference has no error bars (R, G, B and stderr.{R,G,B})
  explicit ErrorSplitter(const Image& reference);

  /// @param run  like the reference, of eight samples a pixel or more; @throws UsageError for another size
  void add(const Image& run);

  [[nodiscard]] ErrorSplit split() const;
  /// Mean square of the reference's own relative error.
  [[nodiscard]] double referenceSquare() const { return referenceSquare_; }
  /// Relative mean square of each run's noise. Without error bars that of the first is 0 until there is a second.
  [[nodiscard]] const std::vector<double>& noiseSquares() const { return noiseSquares_; }

  [[nodiscard]] Image meanImage() const; ///< of the runs: R, G, B
  /// (mean of the runs - reference) / sqrt(reference^2 + e^2): R, G, B
  [[nodiscard]] Image differenceImage() const;

private:
  void noiseFromErrorBars(const Image& run);
  void noiseFromSpread(std::vector<double> differences);

  uint32_t width_;
  uint32_t height_;
  std::vector<double> reference_;          ///< three values a pixel
  std::vector<double> variance_;           ///< of the reference
  std::vector<double> weight_;             ///< 1 / (r^2 + e^2)
  std::vector<double> sum_;                ///< of the runs' differences
  std::vector<double> squares_;            ///< of them
  std::vector<double> noiseSquares_;       ///< one a run
  std::vector<double> previous_;           ///< differences of the last run, where it had no error bars
  double brightnessVariance_ = 0;          ///< sum over runs and values of squared standard errors
  double brightnessReferenceVariance_ = 0; ///< sum over values
  double referenceSquare_ = 0;
};

} // namespace isophote
