// Runs a GLSL function on many inputs: see support/probe_main.glsl for the other side.
#pragma once

#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include "gpu/buffer.hpp"
#include "gpu/kernel.hpp"
#include "gpu/texture_array.hpp"

namespace isophote::test {

/// What a probe reads besides its inputs.
struct ProbeEnvironment {
  uint64_t extra = 0;                           ///< pc.extra
  std::span<const gpu::SpecConstant> constants; ///< beside the workgroup size, constant 0
  const gpu::TextureArray* textures = nullptr;  ///< set 0
  const Device* device = nullptr;               ///< null: gpuDevice()
};

/// The untyped core of runProbe: `outputs` receives one result for each of `count` inputs, in order.
void runProbeBytes(const gpu::KernelSource& source, std::span<const std::byte> inputs, std::span<std::byte> outputs,
                   uint32_t count, const ProbeEnvironment& environment);

/// Calls the probe's function once for each input, on the shared test device.
///
/// In and Out must be declared in scalar layout, as structs between ISOPHOTE_SHARED_BEGIN and _END are.
/// @throws what Kernel, Buffer and CommandStream throw
template <class In, class Out>
[[nodiscard]] std::vector<Out> runProbe(const gpu::KernelSource& source, const std::vector<In>& inputs,
                                        const ProbeEnvironment& environment) {
  static_assert(std::is_trivially_copyable_v<In> && std::is_trivially_copyable_v<Out>);
  std::vector<Out> outputs(inputs.size());
  if (inputs.empty()) return outputs;
  runProbeBytes(source, std::as_bytes(std::span(inputs)), std::as_writable_bytes(std::span(outputs)),
                static_cast<uint32_t>(inputs.size()), environment);
  return outputs;
}

template <class In, class Out>
[[nodiscard]] std::vector<Out> runProbe(const gpu::KernelSource& source, const std::vector<In>& inputs,
                                        uint64_t extra = 0, std::span<const gpu::SpecConstant> constants = {}) {
  return runProbe<In, Out>(source, inputs, ProbeEnvironment{.extra = extra, .constants = constants});
}

} // namespace isophote::test
