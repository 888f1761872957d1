// The Dear ImGui panel over the image.
#pragma once

#include <string>

#include "isophote/device.hpp"
#include "isophote/film.hpp"
#include "viewer/unique_handle.hpp"
#include "viewer/window.hpp"

namespace isophote::viewer {

/// What the panel shows and what the user may change in it.
struct PanelState {
  bool visible = true;
  float exposure = 0;
  ToneMap toneMap = ToneMap::Neutral;
  std::string device;
  uint32_t width = 0, height = 0; ///< of the image
  uint32_t samples = 0;
  double raysPerSecond = 0;
  ErrorEstimate error;
  std::string message; ///< the last save
};

struct PanelClicks {
  bool saveExr = false;
  bool savePng = false;
  bool restart = false;
};

/// Dear ImGui's context. Borrows device and window.
class Panel {
public:
  Panel(const Device& device, const Window& window, VkRenderPass renderPass, uint32_t imageCount);
  Panel(const Panel&) = delete;
  Panel& operator=(const Panel&) = delete;
  ~Panel();

  /// Lays out one frame. Call once before record.
  [[nodiscard]] PanelClicks layout(PanelState& state);
  void record(VkCommandBuffer commands) const;

private:
  UniqueHandle<VkDescriptorPool> descriptors_;

  void uploadFonts(const Device& device);
};

} // namespace isophote::viewer
