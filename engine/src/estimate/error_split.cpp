#include "isophote/error_split.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "isophote/error.hpp"

namespace isophote {
namespace {

constexpr std::array<const char*, 3> kColors = {"R", "G", "B"};
constexpr double kNormal95 = 1.959963984540054;

/// Three values a pixel, from the planes `prefix`R, `prefix`G and `prefix`B.
std::vector<double> interleaved(const Image& image, const std::string& prefix) {
  std::vector<double> values(size_t{3} * image.width * image.height);
  for (size_t c = 0; c < 3; ++c) {
    const Channel* channel = image.find(prefix + kColors[c]);
    if (channel == nullptr) throw UsageError("an image without error bars: no channel " + prefix + kColors[c]);
    for (size_t i = 0; i < channel->values.size(); ++i) values[3 * i + c] = double(channel->values[i]);
  }
  return values;
}

/// Squared standard errors; of pixels that are not trusted those of their widened intervals.
std::vector<double> cautiousVariances(const Image& image) {
  constexpr double kTrusted = 0.1;
  constexpr double kWiden = 4.57 / 2.3646; // of the interval of an event seen once, over Student's (pixel_error.cpp)
  const Channel* trust = image.find("trust.Y");
  std::vector<double> values = interleaved(image, "stderr.");
  for (size_t i = 0; i < values.size(); ++i) {
    const bool trusted = trust == nullptr || double(trust->values[i / 3]) >= kTrusted;
    values[i] *= values[i] * (trusted ? 1 : kWiden * kWiden);
  }
  return values;
}

Image planes(uint32_t width, uint32_t height, const std::vector<double>& values) {
  Image image{.width = width, .height = height};
  for (size_t c = 0; c < 3; ++c) {
    Channel channel{kColors[c], std::vector<float>(values.size() / 3)};
    for (size_t i = 0; i < channel.values.size(); ++i) channel.values[i] = static_cast<float>(values[3 * i + c]);
    image.channels.push_back(std::move(channel));
  }
  return image;
}

/// Mean and standard error of the mean.
struct MeanError {
  double mean = 0;
  double error = 0;
};

MeanError meanError(const std::vector<double>& values) {
  const auto count = static_cast<double>(values.size());
  double sum = 0;
  for (const double value : values) sum += value;
  const double mean = sum / count;
  double squares = 0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return {mean, values.size() > 1 ? std::sqrt(squares / (count - 1) / count) : 0};
}

Interval normalInterval(double value, double error) {
  return {value, value - kNormal95 * error, value + kNormal95 * error};
}

} // namespace

ErrorSplitter::ErrorSplitter(const Image& reference)
    : width_(reference.width), height_(reference.height), reference_(interleaved(reference, "")),
      variance_(interleaved(reference, "stderr.")), weight_(reference_.size()), sum_(reference_.size()),
      squares_(reference_.size()) {
  double luminance = 0;
  for (size_t i = 0; i < reference_.size(); i += 3)
    luminance += 0.2126 * reference_[i] + 0.7152 * reference_[i + 1] + 0.0722 * reference_[i + 2];
  const std::vector<double> cautious = cautiousVariances(reference);
  const double e = 0.01 * luminance / (static_cast<double>(reference_.size()) / 3);
  for (size_t i = 0; i < reference_.size(); ++i) {
    brightnessReferenceVariance_ += cautious[i];
    variance_[i] *= variance_[i];
    const double scale = reference_[i] * reference_[i] + e * e;
    weight_[i] = scale > 0 ? 1 / scale : 0; // a black image
    referenceSquare_ += weight_[i] * variance_[i] / static_cast<double>(reference_.size());
  }
}

void ErrorSplitter::add(const Image& run) {
  if (run.width != width_ || run.height != height_) throw UsageError("a run of another size than the reference");
  std::vector<double> differences = interleaved(run, "");
  for (size_t i = 0; i < differences.size(); ++i) {
    differences[i] -= reference_[i];
    sum_[i] += differences[i];
    squares_[i] += differences[i] * differences[i];
  }
  if (run.find("stderr.R") != nullptr) {
    noiseFromErrorBars(run);
  } else {
    noiseFromSpread(std::move(differences));
  }
}

void ErrorSplitter::noiseFromErrorBars(const Image& run) {
  const std::vector<double> errors = interleaved(run, "stderr.");
  const std::vector<double> cautious = cautiousVariances(run);
  double noise = 0;
  for (size_t i = 0; i < errors.size(); ++i) {
    noise += weight_[i] * errors[i] * errors[i];
    brightnessVariance_ += cautious[i];
  }
  noiseSquares_.push_back(noise / static_cast<double>(errors.size()));
}

void ErrorSplitter::noiseFromSpread(std::vector<double> differences) {
  double noise = 0;
  double total = 0;
  for (size_t i = 0; i < previous_.size(); ++i) {
    const double step = differences[i] - previous_[i];
    noise += weight_[i] * step * step / 2;
    total += step;
  }
  noiseSquares_.push_back(noise / static_cast<double>(differences.size()));
  brightnessVariance_ += total * total / 2;
  if (noiseSquares_.size() == 2) {
    noiseSquares_.front() = noiseSquares_.back();
    brightnessVariance_ += total * total / 2;
  }
  previous_ = std::move(differences);
}

ErrorSplit ErrorSplitter::split() const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  ErrorSplit result{.runs = static_cast<uint32_t>(noiseSquares_.size())};
  result.biasSquare = result.totalSquare = result.brightness = {0, -kInfinity, kInfinity};
  result.noiseSquare = meanInterval(noiseSquares_);
  if (noiseSquares_.empty()) return result;
  const auto runs = static_cast<double>(result.runs);

  double total = 0;
  double difference = 0;
  const double variance = brightnessVariance_ / (runs * runs) + brightnessReferenceVariance_;
  for (size_t i = 0; i < reference_.size(); ++i) {
    total += reference_[i];
    difference += sum_[i] / runs;
  }
  if (total > 0) {
    result.brightness = normalInterval(difference / total, std::sqrt(variance) / total);
    if (variance > 0) result.brightnessDeviations = difference / std::sqrt(variance);
  }

  std::vector<double> pixels(reference_.size() / 3);
  for (size_t i = 0; i < reference_.size(); ++i) pixels[i / 3] += weight_[i] * (squares_[i] / runs - variance_[i]) / 3;
  const MeanError all = meanError(pixels);
  result.totalSquare = normalInterval(all.mean, all.error);
  if (result.runs < 2) return result;

  pixels.assign(pixels.size(), 0);
  for (size_t i = 0; i < reference_.size(); ++i) {
    const double products = (sum_[i] * sum_[i] - squares_[i]) / (runs * (runs - 1));
    pixels[i / 3] += weight_[i] * (products - variance_[i]) / 3;
  }
  const MeanError bias = meanError(pixels);
  result.biasSquare = normalInterval(bias.mean, bias.error);
  if (bias.error > 0) result.biasDeviations = bias.mean / bias.error;
  return result;
}

Image ErrorSplitter::meanImage() const {
  std::vector<double> values(reference_.size());
  const double runs = std::max<double>(1, static_cast<double>(noiseSquares_.size()));
  for (size_t i = 0; i < values.size(); ++i) values[i] = reference_[i] + sum_[i] / runs;
  return planes(width_, height_, values);
}

Image ErrorSplitter::differenceImage() const {
  std::vector<double> values(reference_.size());
  const double runs = std::max<double>(1, static_cast<double>(noiseSquares_.size()));
  for (size_t i = 0; i < values.size(); ++i) values[i] = sum_[i] / runs * std::sqrt(weight_[i]);
  return planes(width_, height_, values);
}

} // namespace isophote
