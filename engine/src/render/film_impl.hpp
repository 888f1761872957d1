// The Film's device side, for render/ alone.
#pragma once

#include <optional>

#include <glm/glm.hpp>

#include "gpu/buffer.hpp"
#include "gpu/commands.hpp"
#include "gpu/kernel.hpp"
#include "isophote/film.hpp"
#include "shared/film_types.h"

namespace isophote {

/// How the Film's integers become numbers; set by the first PathTracer that renders into it.
struct FilmScale {
  double radiancePerUnit = 0; ///< powers of two
  double lengthPerUnit = 0;
  glm::dvec3 worldOrigin{0};
  bool operator==(const FilmScale&) const = default;
};

struct Film::Impl {
  const Device* device = nullptr;
  FilmOptions options; ///< crop filled in
  uint32_t cropWidth = 0;
  uint32_t cropHeight = 0;
  gpu::Buffer replicates;
  gpu::Buffer aovs;
  gpu::Buffer clamped;            ///< null without FilmOptions::clampLedger
  gpu::Buffer beyond;             ///< null without FilmOptions::depthLedger
  std::optional<FilmScale> scale; ///< absent while the film holds no samples
  // Made when first asked for.
  mutable gpu::Kernel errorKernel;
  mutable gpu::Kernel displayKernel;
  mutable gpu::Buffer errorPartials;
  mutable std::optional<gpu::CommandStream> commands;

  [[nodiscard]] uint32_t pixelCount() const { return cropWidth * cropHeight; }
  [[nodiscard]] gpu::FilmArgs arguments(uint64_t target) const;
  void run(gpu::Kernel& kernel, const char* name, const gpu::FilmArgs& arguments, uint32_t invocations) const;
};

} // namespace isophote
