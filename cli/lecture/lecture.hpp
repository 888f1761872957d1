// The course's comparisons rendered, measured and written as a page with pictures.
#pragma once

#include <functional>
#include <string>

#include "isophote/device.hpp"

namespace isophote::cli {

struct LectureOptions {
  std::string scene;  ///< assets/lecture.glb, with its variants
  std::string folder; ///< README.md and the pictures go here
  uint32_t width = 72;
  uint32_t runs = 5; ///< seeds of each picture
  uint32_t referenceSamples = 2048;
};

/// @param progress  told what is being done
/// @return false where the user interrupted it; nothing is written then
bool writeLecture(const Device& device, const LectureOptions& options,
                  const std::function<void(const std::string&)>& progress);

} // namespace isophote::cli
