// What the BSDF functions read on the device: a scene that holds the tables of scattering and nothing else.
#pragma once

#include "gpu/buffer.hpp"
#include "shared/scene_view.h"
#include "support/gpu_device.hpp"
#include "upload/scattering_tables.hpp"

namespace isophote::test {

class BsdfScene {
public:
  explicit BsdfScene(const TableNeeds& needs = {.facets = true}, const EstimatorSettings& settings = {})
      : tables_(gpuDevice(), needs, settings) {
    gpu::SceneView view{};
    tables_.writeTo(view);
    view_ = gpu::uploadBuffer(gpuDevice(), std::vector{view}, "test.scene");
  }
  [[nodiscard]] uint64_t address() const { return view_.address(); }

private:
  ScatteringTables tables_;
  gpu::Buffer view_;
};

} // namespace isophote::test
