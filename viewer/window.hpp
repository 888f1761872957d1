// A GLFW window and what the user did in it.
#pragma once

#include <string>
#include <vector>

#include "isophote/device.hpp"

struct GLFWwindow;

namespace isophote::viewer {

/// What happened since the last frame. Drags are in window heights, right and down.
struct Input {
  double orbitX = 0, orbitY = 0;
  double panX = 0, panY = 0;
  double dolly = 0; ///< wheel steps towards the scene
  bool save = false;
  bool restart = false;
  bool togglePanel = false;
};

/// Left drag orbits, right drag and wheel come closer, middle drag or shift and left drag move sideways.
class Window {
public:
  /// @throws DeviceError where there is no display
  Window(int width, int height, const std::string& title);
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;
  ~Window();

  [[nodiscard]] GLFWwindow* handle() const { return window_; }
  [[nodiscard]] bool closing() const;
  void close();
  /// In pixels; 0 x 0 while minimized.
  [[nodiscard]] VkExtent2D framebufferSize() const;
  /// Handles pending events; waits for one where `wait`.
  void poll(bool wait);
  /// The input since the last call.
  [[nodiscard]] Input takeInput();

  /// @throws DeviceError
  [[nodiscard]] VkSurfaceKHR makeSurface(VkInstance instance) const;

private:
  GLFWwindow* window_ = nullptr;
  Input input_;
  double lastX_ = 0, lastY_ = 0;

  void onMove(double x, double y);
  void onKey(int key);
  void installCallbacks();
};

/// The instance extensions that surfaces need. Call while a Window exists.
[[nodiscard]] std::vector<const char*> surfaceExtensions();

} // namespace isophote::viewer
