#include "support/probe.hpp"

#include "gpu/commands.hpp"
#include "support/gpu_device.hpp"

namespace isophote::test {
namespace {

constexpr uint32_t kWorkgroupSize = 64;

/// As in probe_main.glsl.
struct ProbePush {
  uint64_t inputs = 0;
  uint64_t outputs = 0;
  uint64_t extra = 0;
  uint32_t count = 0;
};
constexpr uint32_t kPushBytes = 28; // without C++'s trailing padding

} // namespace

void runProbeBytes(const gpu::KernelSource& source, std::span<const std::byte> inputs, std::span<std::byte> outputs,
                   uint32_t count, const ProbeEnvironment& environment) {
  const Device& device = environment.device != nullptr ? *environment.device : gpuDevice();
  const gpu::Buffer input(device, inputs.size(), gpu::Memory::Device, "probe.inputs");
  const gpu::Buffer output(device, outputs.size(), gpu::Memory::Device, "probe.outputs");
  gpu::writeBuffer(device, input, 0, inputs);

  std::vector<gpu::SpecConstant> constants{{0, kWorkgroupSize}};
  constants.insert(constants.end(), environment.constants.begin(), environment.constants.end());
  const gpu::TextureArray* textures = environment.textures;
  const gpu::Kernel kernel(device, source, constants, textures ? textures->layout() : VK_NULL_HANDLE, kPushBytes);

  const ProbePush push{input.address(), output.address(), environment.extra, count};
  gpu::CommandStream commands(device, 1, "probe");
  commands.begin();
  const uint32_t groups = (count + kWorkgroupSize - 1) / kWorkgroupSize;
  commands.dispatch(kernel, &push, kPushBytes, textures ? textures->set() : VK_NULL_HANDLE, groups);
  commands.submitAndWait();
  gpu::readBuffer(device, output, 0, outputs);
}

} // namespace isophote::test
