#include "viewer/window.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include <GLFW/glfw3.h>
#include <imgui.h>

#include "isophote/error.hpp"

namespace isophote::viewer {
namespace {

constexpr double kDollyStepsPerHeight = 20; // a drag over the window's height changes the distance by a factor of e^2

Window& self(GLFWwindow* window) { return *static_cast<Window*>(glfwGetWindowUserPointer(window)); }

std::string glfwProblem() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text != nullptr ? text : "unknown";
}

bool down(GLFWwindow* window, int button) { return glfwGetMouseButton(window, button) == GLFW_PRESS; }

bool shift(GLFWwindow* window) {
  return glfwGetKey(window, GLFW_KEY_LEFT_SHIFT) == GLFW_PRESS ||
         glfwGetKey(window, GLFW_KEY_RIGHT_SHIFT) == GLFW_PRESS;
}

} // namespace

Window::Window(int width, int height, const std::string& title) {
  if (glfwInit() == GLFW_FALSE) {
    throw DeviceError("no window can be opened (" + glfwProblem() + "); --headless-frames needs none");
  }
  glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
  window_ = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
  if (window_ == nullptr) {
    const std::string problem = glfwProblem();
    glfwTerminate();
    throw DeviceError("no window can be opened (" + problem + ")");
  }
  glfwSetWindowUserPointer(window_, this);
  glfwGetCursorPos(window_, &lastX_, &lastY_);
  installCallbacks();
}

Window::~Window() {
  glfwDestroyWindow(window_);
  glfwTerminate();
}

// Dear ImGui's own callbacks are installed later and call these first.
void Window::installCallbacks() {
  glfwSetCursorPosCallback(window_, [](GLFWwindow* window, double x, double y) { self(window).onMove(x, y); });
  glfwSetScrollCallback(window_, [](GLFWwindow* window, double, double y) {
    if (!ImGui::GetIO().WantCaptureMouse) self(window).input_.dolly += y;
  });
  glfwSetKeyCallback(window_, [](GLFWwindow* window, int key, int, int action, int) {
    if (action == GLFW_PRESS && !ImGui::GetIO().WantTextInput) self(window).onKey(key);
  });
}

void Window::onMove(double x, double y) {
  int width = 0;
  int height = 0;
  glfwGetWindowSize(window_, &width, &height);
  const double dx = (x - lastX_) / std::max(height, 1);
  const double dy = (y - lastY_) / std::max(height, 1);
  lastX_ = x;
  lastY_ = y;
  if (ImGui::GetIO().WantCaptureMouse) return;
  const bool left = down(window_, GLFW_MOUSE_BUTTON_LEFT);
  if (down(window_, GLFW_MOUSE_BUTTON_MIDDLE) || (left && shift(window_))) {
    input_.panX += dx;
    input_.panY += dy;
  } else if (left) {
    input_.orbitX += dx;
    input_.orbitY += dy;
  } else if (down(window_, GLFW_MOUSE_BUTTON_RIGHT)) {
    input_.dolly -= kDollyStepsPerHeight * dy;
  }
}

void Window::onKey(int key) {
  if (key == GLFW_KEY_S) input_.save = true;
  if (key == GLFW_KEY_R) input_.restart = true;
  if (key == GLFW_KEY_H) input_.togglePanel = true;
  if (key == GLFW_KEY_ESCAPE) close();
}

bool Window::closing() const { return glfwWindowShouldClose(window_) != 0; }

void Window::close() { glfwSetWindowShouldClose(window_, GLFW_TRUE); }

VkExtent2D Window::framebufferSize() const {
  int width = 0;
  int height = 0;
  glfwGetFramebufferSize(window_, &width, &height);
  return {static_cast<uint32_t>(width), static_cast<uint32_t>(height)};
}

void Window::poll(bool wait) {
  if (wait) {
    glfwWaitEvents();
  } else {
    glfwPollEvents();
  }
}

Input Window::takeInput() { return std::exchange(input_, {}); }

VkSurfaceKHR Window::makeSurface(VkInstance instance) const {
  VkSurfaceKHR surface = VK_NULL_HANDLE;
  if (glfwCreateWindowSurface(instance, window_, nullptr, &surface) != VK_SUCCESS) {
    throw DeviceError("the window has no Vulkan surface (" + glfwProblem() + ")");
  }
  return surface;
}

std::vector<const char*> surfaceExtensions() {
  uint32_t count = 0;
  const char** names = glfwGetRequiredInstanceExtensions(&count);
  if (names == nullptr) throw DeviceError("this Vulkan driver cannot present to a window (" + glfwProblem() + ")");
  const std::span<const char*> all(names, count);
  return {all.begin(), all.end()};
}

} // namespace isophote::viewer
