#include "render/camera_media.hpp"

#include <algorithm>

namespace isophote {

gpu::MediumStack mostFrequent(std::span<const gpu::MediaState> answers) {
  const auto votes = [&](const gpu::MediaState& candidate) {
    return std::count_if(answers.begin(), answers.end(), [&](const gpu::MediaState& other) {
      return std::ranges::equal(candidate.path.materials, other.path.materials);
    });
  };
  return std::max_element(answers.begin(), answers.end(),
                          [&](const auto& a, const auto& b) { return votes(a) < votes(b); })
      ->path;
}

} // namespace isophote
