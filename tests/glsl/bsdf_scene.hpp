// What the BSDF functions read on the device: a scene that holds the tables of albedo and loss and nothing else.
#pragma once

#include <map>

#include "gpu/buffer.hpp"
#include "shared/scene_view.h"
#include "support/gpu_device.hpp"
#include "upload/ggx_albedo.hpp"
#include "upload/glass_loss.hpp"

namespace isophote::test {

class BsdfScene {
public:
  /// @param iors indices of rough glass, one table each
  explicit BsdfScene(const std::vector<float>& iors = {})
      : table_(gpu::uploadBuffer(gpuDevice(), ggxAlbedoTable(), "test.ggxAlbedo")) {
    std::vector<glm::vec2> losses(1); // a buffer is never empty
    static std::map<float, std::vector<glm::vec2>> tables;
    for (const float ior : iors) {
      const auto [entry, isNew] = tables.try_emplace(ior);
      if (isNew) entry->second = glassLossTable({.ior = ior});
      first_[ior] = static_cast<uint32_t>(losses.size());
      losses.insert(losses.end(), entry->second.begin(), entry->second.end());
    }
    losses_ = gpu::uploadBuffer(gpuDevice(), losses, "test.glassLoss");
    view_ = gpu::uploadBuffer(
        gpuDevice(), std::vector<gpu::SceneView>{{.ggxAlbedo = table_.address(), .glassLoss = losses_.address()}},
        "test.scene");
  }
  /// Where the table of `ior` begins.
  [[nodiscard]] uint32_t glassLoss(float ior) const { return first_.at(ior); }
  [[nodiscard]] uint64_t address() const { return view_.address(); }

private:
  std::map<float, uint32_t> first_;
  gpu::Buffer table_;
  gpu::Buffer losses_;
  gpu::Buffer view_;
};

} // namespace isophote::test
