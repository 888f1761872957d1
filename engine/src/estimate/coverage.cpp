#include "isophote/coverage.hpp"

#include <cmath>
#include <string>

#include "isophote/error.hpp"

namespace isophote {
namespace {

constexpr float kTrusted = 0.1f;

const std::vector<float>& channel(const Image& image, const std::string& name) {
  const Channel* found = image.find(name);
  if (found == nullptr) throw UsageError("no channel " + name);
  return found->values;
}

} // namespace

void addCoverage(const Image& image, const Image& truth, Coverage& coverage) {
  if (image.width != truth.width || image.height != truth.height) throw UsageError("images of different sizes");
  const Channel* trust = image.find("trust.Y");
  for (const std::string color : {"R", "G", "B"}) {
    const std::vector<float>&mean = channel(image, color), &expected = channel(truth, color);
    const std::vector<float>& halfWidth = channel(image, "ci95." + color);
    const Channel* truthHalfWidth = truth.find("ci95." + color);
    for (size_t i = 0; i < mean.size(); ++i) {
      const double difference = double(mean[i]) - double(expected[i]);
      const double half = double(halfWidth[i]);
      const double own = truthHalfWidth != nullptr ? double(truthHalfWidth->values[i]) : 0;
      const bool covered = std::abs(difference) <= std::hypot(half, own);
      const bool trusted = trust == nullptr || trust->values[i] >= kTrusted;
      coverage.values += 1;
      coverage.covered += covered ? 1 : 0;
      coverage.trustedValues += trusted ? 1 : 0;
      coverage.trustedCovered += trusted && covered ? 1 : 0;
      coverage.missedAbove += !covered && difference < 0 ? 1 : 0;
      coverage.missedBlind += !covered && half == 0 ? 1 : 0;
    }
  }
}

} // namespace isophote
