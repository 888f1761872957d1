// The viewer's command line.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "isophote/image.hpp"

namespace isophote::viewer {

struct Options {
  std::string scene;
  uint32_t width = 960;
  uint32_t height = 600;
  uint32_t scale = 0; ///< window pixels a side of one image pixel; 0: 1 on a GPU, 2 on a CPU
  float exposure = 0; ///< EV
  ToneMap toneMap = ToneMap::Neutral;
  std::string camera; ///< name or index; empty: the first
  std::optional<std::string> variant;
  std::string environment; ///< HDR or EXR file
  std::string device;
  std::string output;          ///< stem of saved images; empty: the scene's name in the current folder
  std::string screenshot;      ///< written at the end
  uint32_t frames = 0;         ///< quit after this many; 0: stay
  uint32_t headlessFrames = 0; ///< submits without a window; 0: open one
  bool validation = false;
};

inline constexpr const char* kToneMapNames[] = {"neutral", "agx", "aces", "srgb", "linear"};

/// Prints help itself. @return no value where the program is to end with success
/// @throws UsageError
[[nodiscard]] std::optional<Options> parseOptions(int argc, char** argv);

} // namespace isophote::viewer
