// The viewer's window loop.
#pragma once

#include "isophote/gpu_scene.hpp"
#include "isophote/scene.hpp"
#include "viewer/options.hpp"
#include "viewer/window.hpp"

namespace isophote::viewer {

/// Shows the scene until the window is closed or the frames of `options` are over.
/// @throws DeviceError, OutputError (a save the user asked for in the window is reported there instead)
void runWindow(const Options& options, const Device& device, Window& window, const GpuScene& gpuScene,
               const Scene& scene, const Camera& camera);

} // namespace isophote::viewer
