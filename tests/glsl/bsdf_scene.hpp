// What the BSDF functions read on the device: a scene that holds the albedo table and nothing else.
#pragma once

#include "gpu/buffer.hpp"
#include "shared/scene_view.h"
#include "support/gpu_device.hpp"
#include "upload/ggx_albedo.hpp"

namespace isophote::test {

class BsdfScene {
public:
  BsdfScene() : table_(gpu::uploadBuffer(gpuDevice(), ggxAlbedoTable(), "test.ggxAlbedo")) {
    view_ = gpu::uploadBuffer(gpuDevice(), std::vector<gpu::SceneView>{{.ggxAlbedo = table_.address()}}, "test.scene");
  }
  [[nodiscard]] uint64_t address() const { return view_.address(); }

private:
  gpu::Buffer table_;
  gpu::Buffer view_;
};

} // namespace isophote::test
