#include "viewer/interactive.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "isophote/error.hpp"
#include "viewer/live_render.hpp"
#include "viewer/orbit_camera.hpp"
#include "viewer/panel.hpp"
#include "viewer/presenter.hpp"

namespace isophote::viewer {
namespace {

using Clock = std::chrono::steady_clock;

// With a submit this long, the display pass and the present after it, input is answered within a tenth of a second.
constexpr double kSubmitMilliseconds = 25;
constexpr std::chrono::seconds kErrorInterval{1};

bool moved(const Input& input) {
  return input.orbitX != 0 || input.orbitY != 0 || input.panX != 0 || input.panY != 0 || input.dolly != 0;
}

/// The window's session: what is shown, and what the user wants.
class Session {
public:
  Session(const Options& options, const Device& device, Window& window, const GpuScene& gpuScene, const Scene& scene,
          const Camera& camera)
      : options_(options), device_(device), window_(window), gpuScene_(gpuScene), presenter_(device, window),
        panel_(device, window, presenter_.renderPass(), presenter_.imageCount()), orbit_(camera, worldBounds(scene)) {
    state_.exposure = options.exposure;
    state_.toneMap = options.toneMap;
    state_.device = device.info().name;
    const std::filesystem::path name = std::filesystem::path(options.scene).stem();
    stem_ = options.output.empty() ? name.string() : options.output;
    makeRender();
  }

  void frame(bool keep) {
    if (differ(window_.framebufferSize(), presenter_.extent())) presenter_.resize();
    if (differ(presenter_.extent(), renderedFor_)) makeRender(); // present may have noticed first
    answer(window_.takeInput());
    if (render_->step()) saveWhatIsWanted();
    updateState();
    const PanelClicks clicks = panel_.layout(state_);
    wantExr_ = wantExr_ || clicks.saveExr;
    wantPng_ = wantPng_ || clicks.savePng;
    if (clicks.restart) restart();
    const bool current = presenter_.present({.film = render_->shown(),
                                             .exposureEv = state_.exposure,
                                             .toneMap = state_.toneMap,
                                             .overlay = [&](VkCommandBuffer commands) { panel_.record(commands); },
                                             .keep = keep});
    if (!current && window_.framebufferSize().width != 0) presenter_.resize();
  }

  void writeScreenshot() const { writePng(options_.screenshot, presenter_.kept(), 0, ToneMap::Linear); }

private:
  const Options& options_;
  const Device& device_;
  Window& window_;
  const GpuScene& gpuScene_;
  Presenter presenter_;
  Panel panel_;
  OrbitCamera orbit_;
  std::unique_ptr<LiveRender> render_;
  PanelState state_;
  Clock::time_point nextError_;
  std::string stem_;
  VkExtent2D renderedFor_{}; ///< the window's size when the render was made
  bool wantExr_ = false;
  bool wantPng_ = false;

  static bool differ(VkExtent2D a, VkExtent2D b) { return a.width != b.width || a.height != b.height; }

  void makeRender() {
    renderedFor_ = presenter_.extent();
    const uint32_t scale = options_.scale != 0 ? options_.scale : (device_.isCpu() ? 2 : 1);
    state_.width = std::max(presenter_.extent().width / scale, 1u);
    state_.height = std::max(presenter_.extent().height / scale, 1u);
    render_.reset(); // its memory first
    render_ = std::make_unique<LiveRender>(device_, gpuScene_, state_.width, state_.height,
                                           ExecutionSettings{.submitMilliseconds = kSubmitMilliseconds});
    restart();
  }

  void restart() {
    render_->start(orbit_.camera(static_cast<double>(presenter_.extent().width) / presenter_.extent().height));
    state_.error = {};
    nextError_ = Clock::now() + kErrorInterval;
  }

  void answer(const Input& input) {
    if (input.togglePanel) state_.visible = !state_.visible;
    if (input.save) wantExr_ = wantPng_ = true;
    if (moved(input)) {
      orbit_.orbit(input.orbitX, input.orbitY);
      orbit_.pan(input.panX, input.panY);
      orbit_.dolly(input.dolly);
    }
    if (moved(input) || input.restart) restart();
  }

  void updateState() {
    state_.samples = render_->samples();
    state_.raysPerSecond = render_->raysPerSecond();
    if (Clock::now() < nextError_) return;
    state_.error = render_->film().error();
    nextError_ = Clock::now() + kErrorInterval;
  }

  // Between batches, where the film is unbiased.
  void saveWhatIsWanted() {
    if (!wantExr_ && !wantPng_) return;
    try {
      const Image image = render_->film().resolve();
      if (wantExr_) writeExr(stem_ + ".exr", image);
      if (wantPng_) writePng(stem_ + ".png", image, state_.exposure, state_.toneMap);
      const std::string exr = wantExr_ ? stem_ + ".exr" : "";
      const std::string png = wantPng_ ? stem_ + ".png" : "";
      state_.message = fmt::format("saved {}{}{}", exr, wantExr_ && wantPng_ ? " and " : "", png);
    } catch (const OutputError& error) {
      state_.message = error.what();
    }
    wantExr_ = wantPng_ = false;
  }
};

} // namespace

void runWindow(const Options& options, const Device& device, Window& window, const GpuScene& gpuScene,
               const Scene& scene, const Camera& camera) {
  Session session(options, device, window, gpuScene, scene, camera);
  for (uint32_t frame = 1; !window.closing(); ++frame) {
    const bool minimized = window.framebufferSize().width == 0;
    window.poll(minimized);
    if (minimized) continue;
    const bool last = frame == options.frames;
    // A window closed by hand has no last frame to keep, so with --screenshot each one is.
    session.frame(!options.screenshot.empty() && (last || options.frames == 0));
    if (last) break;
  }
  if (!options.screenshot.empty()) session.writeScreenshot();
}

} // namespace isophote::viewer
