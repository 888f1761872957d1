// What an image's header says of how it was made: enough to make any pixel of it again.
#pragma once

#include <string>
#include <vector>

#include "input/scene_source.hpp"
#include "isophote/image.hpp"
#include "setting_table.hpp"

namespace isophote::cli {

/// The attribute `name` of `image`. @throws UsageError where `file` has none: it is no image of Isophote
[[nodiscard]] const std::string& attribute(const std::string& file, const Image& image, const std::string& name);

/// `0:16` or, of merged images, `0:16,32:48`.
[[nodiscard]] std::vector<SampleRange> sampleRanges(const std::string& text);

struct Receipt {
  std::string version;
  std::string device; ///< name and driver
  std::string scene;  ///< path as it was given
  std::string sceneHash;
  std::vector<SampleRange> samples;
  Settings settings;
  Backend backend = Backend::Compute;
  uint32_t width = 0; ///< of the full image
  uint32_t height = 0;
  PixelRect crop; ///< the part that the image shows
  CameraOptions camera;
  EnvironmentOptions environment;
  std::optional<std::string> variant;
};

/// @throws UsageError where the header has no receipt or one that cannot be understood
[[nodiscard]] Receipt readReceipt(const std::string& file, const Image& image);

} // namespace isophote::cli
